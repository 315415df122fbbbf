#include "studies/experiments/triangle_work.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace quadrille::studies::experiments {
namespace {

constexpr std::int64_t kTile = 8;
constexpr std::int64_t kWarpQuads = 8;

/// Positive inside, for the triangle turned so that its area is positive; `owned`: a centre on the edge
/// belongs to it (left and top edges own theirs).
struct Edge {
  std::int64_t x = 0, y = 0, dx = 0, dy = 0;
  bool owned = false;
  [[nodiscard]] bool inside(std::int64_t px, std::int64_t py, const Sample& sample = {}) const {
    const std::int64_t value = dx * (py * kGrid + sample.y - y) - dy * (px * kGrid + sample.x - x);
    return value > 0 || (value == 0 && owned);
  }
};

struct Shape {
  std::array<Edge, 3> edges;
  [[nodiscard]] bool covers(std::int64_t px, std::int64_t py, const Sample& sample = {}) const {
    return std::ranges::all_of(edges, [&](const Edge& e) { return e.inside(px, py, sample); });
  }
  /// pixels whose centres lie in the bounding box: from, and up to
  std::int64_t left = 0, top = 0, right = 0, bottom = 0;
  /// rows of centres of the parts above and below the middle corner: the lower part begins, and ends, here
  std::int64_t middle = 0, end = 0;
};

std::int64_t first_centre(std::int64_t at) { return (at + kGrid / 2 - 1) / kGrid; }

/// The triangle, turned clockwise as seen on the screen. False for one without area.
bool shape_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle, Shape& shape) {
  std::array<const WindowCorner*, 3> c{&mesh.corners[triangle[0]], &mesh.corners[triangle[1]],
                                       &mesh.corners[triangle[2]]};
  const auto area = [&] {
    return std::int64_t{c[1]->x - c[0]->x} * (c[2]->y - c[0]->y) -
           std::int64_t{c[1]->y - c[0]->y} * (c[2]->x - c[0]->x);
  };
  if (area() == 0) return false;
  if (area() < 0) std::swap(c[1], c[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const WindowCorner &a = *c[i], &b = *c[(i + 1) % 3];
    const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
    shape.edges[i] = {a.x, a.y, dx, dy, dy < 0 || (dy == 0 && dx > 0)};
  }
  const auto [x0, x1] = std::minmax({c[0]->x, c[1]->x, c[2]->x});
  const auto [y0, y1] = std::minmax({c[0]->y, c[1]->y, c[2]->y});
  shape.left = std::max<std::int64_t>(0, first_centre(x0));
  shape.top = std::max<std::int64_t>(0, first_centre(y0));
  shape.right = std::min<std::int64_t>(mesh.width, first_centre(x1 + 1));
  shape.bottom = std::min<std::int64_t>(mesh.height, first_centre(y1 + 1));
  const auto row = [&](std::int64_t y) {
    return std::clamp<std::int64_t>(first_centre(y), shape.top, mesh.height);
  };
  shape.middle = row(std::int64_t{c[0]->y} + c[1]->y + c[2]->y - y0 - y1);
  shape.end = row(y1);
  return true;
}

/// Kept unless all 64 pixels are outside one edge: an edge function is greatest at a corner.
bool tile_kept(const Shape& shape, std::int64_t tx, std::int64_t ty) {
  const std::int64_t x0 = tx * kTile, y0 = ty * kTile, x1 = x0 + kTile - 1, y1 = y0 + kTile - 1;
  return std::ranges::all_of(shape.edges, [&](const Edge& e) {
    return e.inside(x0, y0) || e.inside(x1, y0) || e.inside(x0, y1) || e.inside(x1, y1);
  });
}

Coverage tile_coverage(const Shape& shape, std::int64_t tx, std::int64_t ty) {
  Coverage covered;
  std::array<bool, 16> quad{};
  for (std::int64_t y = std::max(shape.top, ty * kTile); y < std::min(shape.bottom, (ty + 1) * kTile); ++y) {
    for (std::int64_t x = std::max(shape.left, tx * kTile); x < std::min(shape.right, (tx + 1) * kTile);
         ++x) {
      if (!shape.covers(x, y)) continue;
      ++covered.pixels;
      quad[static_cast<std::size_t>(4 * (y % kTile / 2) + x % kTile / 2)] = true;
    }
  }
  covered.quads = static_cast<std::uint64_t>(std::ranges::count(quad, true));
  return covered;
}

/// Pixels of the quad with a covered sample.
std::uint64_t pixels_of_quad(const Shape& shape, std::span<const Sample> samples, std::int64_t x,
                             std::int64_t y) {
  std::uint64_t pixels = 0;
  for (int i = 0; i < 4; ++i)
    pixels +=
        std::ranges::any_of(samples, [&](const Sample& s) { return shape.covers(x + i % 2, y + i / 2, s); })
            ? 1
            : 0;
  return pixels;
}

/// Pixels of the triangle with a covered sample, a block of four quads at a time.
void count_blocks(const Shape& shape, std::span<const Sample> samples, Coverage& coverage) {
  // Samples off the centre may lie in pixels one beyond those of the centres.
  for (std::int64_t y = (shape.top - 1) & ~3; y <= shape.bottom; y += 4) {
    for (std::int64_t x = (shape.left - 1) & ~3; x <= shape.right; x += 4) {
      const std::uint64_t before = coverage.pixels;
      for (int i = 0; i < 4; ++i) {
        const std::uint64_t pixels = pixels_of_quad(shape, samples, x + 2 * (i % 2), y + 2 * (i / 2));
        coverage.pixels += pixels;
        coverage.quads += pixels > 0 ? 1 : 0;
      }
      coverage.blocks += coverage.pixels > before ? 1 : 0;
    }
  }
}

std::uint64_t parts(std::uint64_t whole, std::uint64_t part) { return (whole + part - 1) / part; }

void count_tile(const Shape& shape, std::int64_t tx, std::int64_t ty, const Rates& rates,
                TriangleWork& work) {
  const Coverage covered = tile_coverage(shape, tx, ty);
  ++work.tiles;
  work.fine_clk += std::max<std::uint64_t>(1, parts(covered.quads, rates.fine_quads));
  work.pack_clk += parts(covered.quads, rates.pack_quads);
  work.quads += covered.quads;
  work.fragments += covered.pixels;
}

void count_triangle(const Shape& shape, const Rates& rates, TriangleWork& work) {
  const std::int64_t first = shape.left / kTile, last = (shape.right - 1) / kTile;
  std::uint64_t kept = 0, tests = 0;
  for (std::int64_t ty = shape.top / kTile; ty <= (shape.bottom - 1) / kTile; ++ty) {
    std::int64_t from = last + 1, to = first - 1;
    for (std::int64_t tx = first; tx <= last; ++tx) {
      if (!tile_kept(shape, tx, ty)) continue;
      from = std::min(from, tx);
      to = tx;
      count_tile(shape, tx, ty, rates, work);
    }
    // A row is tested from one failing tile to the next, and those at the ends of the bounding box need no
    // test to stop.
    kept += from > to ? 0 : static_cast<std::uint64_t>(to - from + 1);
    tests += from > to
                 ? 1
                 : static_cast<std::uint64_t>(to - from + 1) + (from > first ? 1 : 0) + (to < last ? 1 : 0);
  }
  work.tile_tests += tests;
  work.coarse_clk += std::max({std::uint64_t{1}, kept, parts(tests, rates.tile_tests)});
}

/// When rows of tiles are walked and leave: one is walked while the one before leaves.
class WalkTimes {
 public:
  void row(double walk_clk, std::uint64_t tiles) {
    walk_clk_ += walk_clk;
    if (tiles > 0) leave(static_cast<double>(tiles));
  }
  /// What has no tile takes the place of one.
  void triangle_ends(bool had_tiles) {
    if (!had_tiles) left_ = std::max(left_, walked()) + 1;
    begun_ = walked();
    walk_clk_ = 0;
  }
  [[nodiscard]] double end() const { return std::max(left_, walked()); }

 private:
  [[nodiscard]] double walked() const { return begun_ + std::ceil(walk_clk_); }
  void leave(double tiles) {
    begun_ = std::max(walked(), left_);
    walk_clk_ = 0;
    left_ = begun_ + tiles;
  }
  double begun_ = 0, walk_clk_ = 0;  ///< of the walk
  double left_ = 0;                  ///< all tiles so far, by then
};

/// Pixels of a row that are covered: from, and up to.
struct Span {
  std::int64_t from = 0, to = 0;
};
Span span_of(const Shape& shape, std::int64_t y) {
  Span span{shape.left, shape.right};
  while (span.from < span.to && !shape.covers(span.from, y)) ++span.from;
  while (span.from < span.to && !shape.covers(span.to - 1, y)) --span.to;
  return span;
}

void count_walk(const Shape& shape, const Rates& rates, TriangleWork& work, WalkTimes& times) {
  const std::uint64_t before = work.walk_tiles;
  for (std::int64_t y = shape.top; y < shape.end;) {
    double clk = 0;
    std::vector<bool> touched(static_cast<std::size_t>((shape.right + kTile - 1) / kTile), false);
    for (const std::int64_t ty = y / kTile; y < shape.end && y / kTile == ty; ++y) {
      const bool begins = y == shape.top || y == shape.middle;
      const Span span = span_of(shape, y);
      std::uint64_t segments = 0;
      for (std::int64_t x = span.from; x < span.to; x = (x / kTile + 1) * kTile, ++segments)
        touched[static_cast<std::size_t>(x / kTile)] = true;
      work.walk_parts += begins ? 1 : 0;
      ++work.walk_rows;
      work.walk_spans += segments > 0 ? 1 : 0;
      work.walk_segments += segments;
      clk += (begins ? rates.walk_setup_clk : 0) +
             std::max(1.0 / rates.walk_rows, static_cast<double>(segments) / rates.walk_segments);
    }
    const auto tiles = static_cast<std::uint64_t>(std::ranges::count(touched, true));
    work.walk_tiles += tiles;
    times.row(clk, tiles);
  }
  times.triangle_ends(work.walk_tiles > before);
}

void count_batches(const TriangleMesh& mesh, const Rates& rates, TriangleWork& work) {
  std::vector<std::uint32_t> vertices;
  std::uint32_t triangles = 0;
  const auto leave = [&] {
    ++work.batches;
    work.vertices += vertices.size();
    vertices.clear();
    triangles = 0;
  };
  const auto is_new = [&](std::uint32_t v) { return std::ranges::find(vertices, v) == vertices.end(); };
  for (const auto& triangle : mesh.triangles) {
    const auto added = static_cast<std::size_t>(std::ranges::count_if(triangle, is_new));
    if (triangles == rates.batch_triangles || vertices.size() + added > rates.batch_vertices) leave();
    std::ranges::copy_if(triangle, std::back_inserter(vertices), is_new);
    ++triangles;
  }
  if (triangles > 0) leave();
}

}  // namespace

Coverage coverage_of(const TriangleMesh& mesh, std::span<const Sample> samples) {
  Coverage coverage;
  Shape shape;
  for (const auto& triangle : mesh.triangles) {
    if (shape_of(mesh, triangle, shape)) count_blocks(shape, samples, coverage);
  }
  return coverage;
}

TriangleWork work_of(const TriangleMesh& mesh, const Rates& rates) {
  TriangleWork work;
  work.triangles = mesh.triangles.size();
  count_batches(mesh, rates, work);
  Shape shape;
  WalkTimes times;
  for (const auto& triangle : mesh.triangles) {
    if (!shape_of(mesh, triangle, shape) || shape.left >= shape.right || shape.top >= shape.bottom) continue;
    count_triangle(shape, rates, work);
    count_walk(shape, rates, work, times);
  }
  work.walk_clk = times.end();
  work.pack_clk += rates.launch_clk * parts(work.quads, kWarpQuads);
  const std::uint64_t messages = work.triangles / std::max(1u, rates.triangle_slots / 8);
  work.coarse_clk += messages;
  work.fine_clk += messages;
  work.walk_clk += static_cast<double>(messages);
  return work;
}

}  // namespace quadrille::studies::experiments
