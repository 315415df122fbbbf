#include "models/raster/line_setup.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace quadrille::models {
namespace {

/// A window position on the grid whose pixels are `one` units wide.
struct Grid {
  int bits;
  std::int64_t one, half;
  explicit Grid(int subpixel_bits)
      : bits(subpixel_bits), one(std::int64_t{1} << subpixel_bits), half(one / 2) {}
  /// The pixel of a coordinate; a boundary belongs to the pixel before it.
  [[nodiscard]] std::int64_t pixel(std::int64_t at) const { return ((at + one - 1) >> bits) - 1; }
  [[nodiscard]] std::int64_t centre(std::int64_t pixel) const { return pixel * one + half; }
  /// Is it inside the diamond of its pixel? On the boundary: as moved up by a little, and to the left by
  /// more.
  [[nodiscard]] bool in_diamond(const GridPoint& p) const {
    const std::int64_t x = p.x - centre(pixel(p.x)), y = p.y - centre(pixel(p.y));
    const std::int64_t distance = std::abs(x) + std::abs(y);
    return distance < half || (distance == half && x > 0);
  }
};

/// First and last column (or row) of a Bresenham line, whose ends have these coordinates along it.
struct Steps {
  std::int64_t first = 0, last = -1;
};
Steps steps_of(const Grid& grid, const GridPoint& a, const GridPoint& b, std::int64_t a_at,
               std::int64_t b_at) {
  const std::int64_t pixel_a = grid.pixel(a_at), pixel_b = grid.pixel(b_at);
  const bool a_beyond = a_at > grid.centre(pixel_a), b_beyond = b_at > grid.centre(pixel_b);
  const bool forward = b_at > a_at;
  // The line leaves the first diamond if it begins in it, or before its middle; the last if it ends behind
  // its middle, and not in it.
  const bool first_left = grid.in_diamond(a) || a_beyond != forward;
  const bool last_left = !grid.in_diamond(b) && b_beyond == forward;
  const std::int64_t step = forward ? 1 : -1;
  const std::int64_t from = first_left ? pixel_a : pixel_a + step, to = last_left ? pixel_b : pixel_b - step;
  return forward ? Steps{from, to} : Steps{to, from};
}

struct Segment {
  GridPoint a, b;
  [[nodiscard]] std::int64_t dx() const { return b.x - a.x; }
  [[nodiscard]] std::int64_t dy() const { return b.y - a.y; }
  [[nodiscard]] bool steep() const { return std::abs(dx()) < std::abs(dy()); }
};

Segment segment_of(const std::array<LineEnd, 2>& ends) {
  return {{ends[0].vertex.x, ends[0].vertex.y}, {ends[1].vertex.x, ends[1].vertex.y}};
}

std::int64_t width_on_grid(const SetupState& state) {
  const double width = std::clamp(state.line_width, kMinLineWidth, kMaxLineWidth);
  return std::llrint(std::ldexp(width, state.subpixel_bits));
}

/// Edges and bounds of the band around a line that goes right, or down if it is steep.
void set_band(const Segment& s, const Steps& steps, const SetupState& state, TriangleSetup& out) {
  const std::int64_t width = width_on_grid(state), before = width / 2, after = width - before;
  const Grid grid(state.subpixel_bits);
  const auto pixels = [&](std::int64_t low, std::int64_t high) {  // and half a pixel, for the ends' columns
    return std::pair{first_pixel_from(low - before - grid.half, grid.bits),
                     first_pixel_from(high + after + grid.half, grid.bits)};
  };
  const auto first = static_cast<std::int32_t>(steps.first), end = static_cast<std::int32_t>(steps.last + 1);
  const auto band_edge = [](const GridPoint& a, const GridPoint& b, int bits) {
    return endless(make_edge(a, b, bits));
  };
  out.edge_count = 2;
  if (s.steep()) {
    out.edges[0] = band_edge({s.a.x + after, s.a.y}, {s.b.x + after, s.b.y}, grid.bits);
    out.edges[1] = band_edge({s.b.x - before, s.b.y}, {s.a.x - before, s.a.y}, grid.bits);
    const auto [left, right] = pixels(std::min(s.a.x, s.b.x), std::max(s.a.x, s.b.x));
    out.bounds = {left, first, right, end};
  } else {
    out.edges[0] = band_edge({s.a.x, s.a.y - before}, {s.b.x, s.b.y - before}, grid.bits);
    out.edges[1] = band_edge({s.b.x, s.b.y + after}, {s.a.x, s.a.y + after}, grid.bits);
    const auto [top, bottom] = pixels(std::min(s.a.y, s.b.y), std::max(s.a.y, s.b.y));
    out.bounds = {first, top, end, bottom};
  }
}

void cover_bresenham(Segment s, const SetupState& state, TriangleSetup& out) {
  const Grid grid(state.subpixel_bits);
  const bool steep = s.steep();
  const Steps steps = steep ? steps_of(grid, s.a, s.b, s.a.y, s.b.y) : steps_of(grid, s.a, s.b, s.a.x, s.b.x);
  if ((steep ? s.dy() : s.dx()) < 0) std::swap(s.a, s.b);
  out.whole_pixels = true;
  set_band(s, steps, state, out);
}

/// A line's direction and length, in pixels.
struct Direction {
  double x, y, length;
  Direction(const Segment& s, int subpixel_bits) {
    const double unit = std::ldexp(1.0, -subpixel_bits);
    x = static_cast<double>(s.dx()) * unit;
    y = static_cast<double>(s.dy()) * unit;
    length = std::sqrt(x * x + y * y);
    x /= length;
    y /= length;
  }
};

/// The corners run clockwise: from the left side of the line's begin to its right side.
void cover_rectangle(const Segment& s, const SetupState& state, TriangleSetup& out) {
  const bool smooth = state.line_mode == LineMode::kSmooth;
  const Direction d(s, state.subpixel_bits);
  const double one = std::ldexp(1.0, state.subpixel_bits);
  // A smooth line touches pixels whose centre is up to half a pixel beside it.
  const double half = static_cast<double>(width_on_grid(state)) * 0.5 + (smooth ? 0.5 * one : 0.0);
  const double longer = smooth ? 0.5 * one : 0.0;
  const auto snapped = [](double v) { return static_cast<std::int64_t>(std::llrint(v)); };
  const GridPoint side{snapped(-d.y * half), snapped(d.x * half)},
      ahead{snapped(d.x * longer), snapped(d.y * longer)};
  const std::array<GridPoint, 4> corner{GridPoint{s.a.x - ahead.x - side.x, s.a.y - ahead.y - side.y},
                                        GridPoint{s.b.x + ahead.x - side.x, s.b.y + ahead.y - side.y},
                                        GridPoint{s.b.x + ahead.x + side.x, s.b.y + ahead.y + side.y},
                                        GridPoint{s.a.x - ahead.x + side.x, s.a.y - ahead.y + side.y}};
  out.edge_count = 4;
  for (std::size_t i = 0; i < 4; ++i)
    out.edges[i] = make_edge(corner[i], corner[(i + 1) % 4], state.subpixel_bits);
  const auto [left, right] = std::minmax({corner[0].x, corner[1].x, corner[2].x, corner[3].x});
  const auto [top, bottom] = std::minmax({corner[0].y, corner[1].y, corner[2].y, corner[3].y});
  const int bits = state.subpixel_bits;
  const GridPoint &least = state.samples.low, &greatest = state.samples.high;
  out.bounds = {first_pixel_from(left - greatest.x, bits), first_pixel_from(top - greatest.y, bits),
                first_pixel_from(right + 1 - least.x, bits), first_pixel_from(bottom + 1 - least.y, bits)};
  out.whole_pixels = false;
}

/// Planes that grow from the first end to the second. [VK1.3 #line_noclip, #primsrast-lines-bresenham]
void fit_planes(const std::array<LineEnd, 2>& ends, const Segment& s, const SetupState& state,
                TriangleSetup& out) {
  const double unit = std::ldexp(1.0, -state.subpixel_bits);
  const double dx = static_cast<double>(s.dx()) * unit, dy = static_cast<double>(s.dy()) * unit;
  double per_x = dx / (dx * dx + dy * dy), per_y = dy / (dx * dx + dy * dy);
  if (state.line_mode == LineMode::kBresenham) {
    per_x = s.steep() ? 0.0 : 1.0 / dx;
    per_y = s.steep() ? 1.0 / dy : 0.0;
  }
  const auto fit = [&](double f0, double f1) { return Plane{f0, (f1 - f0) * per_x, (f1 - f0) * per_y}; };
  const auto& [a, b] = ends;
  const double a_inv_w = a.vertex.inv_w, b_inv_w = b.vertex.inv_w;
  out.ref_x = static_cast<double>(s.a.x) * unit;
  out.ref_y = static_cast<double>(s.a.y) * unit;
  out.z = fit(a.vertex.z, b.vertex.z);
  out.inv_w = fit(a_inv_w, b_inv_w);
  out.persp_1 = fit(static_cast<double>(a.weights.x) * a_inv_w, static_cast<double>(b.weights.x) * b_inv_w);
  out.persp_2 = fit(static_cast<double>(a.weights.y) * a_inv_w, static_cast<double>(b.weights.y) * b_inv_w);
  out.linear_1 = fit(a.weights.x, b.weights.x);
  out.linear_2 = fit(a.weights.y, b.weights.y);
  limit_depths(std::min(a.vertex.z, b.vertex.z), std::max(a.vertex.z, b.vertex.z), state, out);
}

}  // namespace

std::int32_t line_reach(const SetupState& state) {
  return static_cast<std::int32_t>(width_on_grid(state)) / 2 + (2 << state.subpixel_bits);
}

SetupOutcome setup_line(const std::array<LineEnd, 2>& ends, const SetupState& state, TriangleSetup& out) {
  const Segment s = segment_of(ends);
  if (s.dx() == 0 && s.dy() == 0) return SetupOutcome::kZeroArea;
  if (state.line_mode == LineMode::kBresenham) cover_bresenham(s, state, out);
  else cover_rectangle(s, state, out);
  if (out.bounds.empty()) return SetupOutcome::kNoSample;
  out.bounds = intersect(out.bounds, state.scissor);
  if (out.bounds.empty()) return SetupOutcome::kOffscreen;
  out.front_facing = true;
  fit_planes(ends, s, state, out);
  return SetupOutcome::kKept;
}

LineCoverage line_coverage(const std::array<LineEnd, 2>& ends, const SetupState& state) {
  const Segment s = segment_of(ends);
  const Direction d(s, state.subpixel_bits);
  LineCoverage c;
  c.half_length = 0.5 * d.length;
  c.half_width = 0.5 * std::ldexp(static_cast<double>(width_on_grid(state)), -state.subpixel_bits);
  c.along = {-c.half_length, d.x, d.y};
  c.across = {0, -d.y, d.x};
  return c;
}

float LineCoverage::at(double x, double y) const {
  const auto covered = [&](const Plane& plane, double half) {
    const double from_middle = std::abs((plane.value + plane.dx * x) + plane.dy * y);
    return std::clamp(half + 0.5 - from_middle, 0.0, std::min(1.0, 2.0 * half));
  };
  return static_cast<float>(covered(along, half_length) * covered(across, half_width));
}

}  // namespace quadrille::models
