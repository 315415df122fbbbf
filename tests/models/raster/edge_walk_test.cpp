/// Edge walking: the spans hold what the definition covers and what edge functions cover, to the sample; its
/// parts and rows are those of the triangle.
#include "models/raster/edge_walk.h"
#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "models/raster/line_setup.h"
#include "models/raster/point_setup.h"
#include "models/raster/span_tiles.h"
#include "tests/models/raster/brute_force.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

using namespace quadrille::models;

namespace {

constexpr int kSize = 64;

/// Coverage of a primitive's tiles that have any, by place.
using Tiles = std::map<std::pair<int, int>, TileCoverage>;

Tiles by_edges(const TriangleSetup& t, const SampleGrid& grid) {
  Tiles tiles;
  TileWalk walk(t, grid);
  for (TileHit hit; walk.next(hit);) {
    TileCoverage coverage{};
    bool any = false;
    for (int s = 0; s < grid.count; ++s) {
      coverage[static_cast<std::size_t>(s)] = sample_coverage(t, hit.tile_x, hit.tile_y, grid, s);
      any = any || coverage[static_cast<std::size_t>(s)] != 0;
    }
    if (any) tiles.emplace(std::pair{hit.tile_y, hit.tile_x}, coverage);
  }
  return tiles;
}

Tiles by_walk(const TriangleSetup& t, const SampleGrid& grid) {
  Tiles tiles;
  SpanTiles gathered(t.bounds, grid.count, t.whole_pixels);
  const auto take = [&] {
    for (SpanTiles::Tile tile; gathered.take(tile);) {
      TileCoverage& held = tiles[{tile.tile_y, tile.tile_x}];
      REQUIRE(held == TileCoverage{});  // no tile comes twice
      for (std::size_t s = 0; s < static_cast<std::size_t>(grid.count); ++s) held[s] = tile.coverage[s];
      REQUIRE(tile.full == std::ranges::all_of(std::span(held).first(static_cast<std::size_t>(grid.count)),
                                               [](std::uint64_t mask) { return ~mask == 0; }));
    }
  };
  EdgeWalk walk(t, grid);
  std::int32_t tile_y = 0;
  for (SampleRow row; walk.next(row);) {
    if (row.y >> 3 != tile_y) take();
    tile_y = row.y >> 3;
    gathered.add(row);
  }
  take();
  return tiles;
}

/// How often each sample of a square is covered by walks.
class WalkCount {
 public:
  WalkCount(int samples, int bits) : grid_(sample_grid(samples, bits)) {
    count_.resize(static_cast<std::size_t>(kSize * kSize * samples));
  }
  void add(const std::array<WindowVertex, 3>& v) {
    TriangleSetup t;
    if (setup_in_square(v, kSize, grid_.subpixel_bits, t, grid_.count) != SetupOutcome::kKept) return;
    EdgeWalk walk(t, grid_);
    for (SampleRow row; walk.next(row);)
      for (std::int32_t x = row.x0; x < row.x1; ++x) ++at(x, row.y, row.sample);
  }
  [[nodiscard]] int& at(int x, int y, int sample) {
    return count_[static_cast<std::size_t>((y * kSize + x) * grid_.count + sample)];
  }
  [[nodiscard]] const SampleGrid& grid() const { return grid_; }

 private:
  SampleGrid grid_;
  std::vector<int> count_;
};

SetupState state_of(int bits, int samples, const PixelRect& scissor) {
  SetupState state;
  state.scissor = scissor;
  state.subpixel_bits = bits;
  state.samples = sample_grid(samples, bits);
  return state;
}

PixelRect random_scissor(RandomSource& random) {
  return {random.integer(0, 30), random.integer(0, 30), random.integer(31, 64), random.integer(31, 64)};
}

struct Walked {
  int rows = 0, parts = 0;
  friend bool operator==(const Walked&, const Walked&) = default;
};
/// Rows and parts of a triangle with corners in half pixels.
Walked walked(std::array<std::pair<int, int>, 3> halves, const PixelRect& scissor = {0, 0, kSize, kSize},
              int samples = 1) {
  std::array<WindowVertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = {halves[i].first * 128, halves[i].second * 128, 0.5F, 1.0F};
  const SetupState state = state_of(8, samples, scissor);
  TriangleSetup t;
  if (setup_triangle(v, whole_triangle_weights(), state, t) != SetupOutcome::kKept) return {};
  Walked all;
  EdgeWalk walk(t, state.samples);
  for (SampleRow row; walk.next(row);) {
    ++all.rows;
    all.parts += row.begins_part ? 1 : 0;
  }
  return all;
}

}  // namespace

TEST_CASE("edge_walk: covers what the definition covers, at 1, 2, 4 and 8 samples and 4 to 12 bits") {
  RandomSource random(21);
  int covered = 0;
  for (int round = 0; round < 1600; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4;
    const auto v = awkward_triangle(random, kSize, bits);
    WalkCount count(samples, bits);
    count.add(v);
    for (int y = 0; y < kSize; y += random.integer(1, 3)) {
      for (int x = 0; x < kSize; ++x) {
        for (int s = 0; s < samples; ++s) {
          const bool inside = covers(v, x, y, bits, count.grid().offset[static_cast<std::size_t>(s)]);
          covered += inside ? 1 : 0;
          if (count.at(x, y, s) != (inside ? 1 : 0))
            FAIL("round " << round << " pixel " << x << "," << y << " sample " << s);
        }
      }
    }
  }
  CHECK(covered > 100000);
}

TEST_CASE("edge_walk: tiles and masks are those of edge functions, whatever scissor cuts the triangle") {
  RandomSource random(22);
  std::size_t tiles = 0;
  for (int round = 0; round < 20000; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4;
    const SetupState state = state_of(bits, samples, random_scissor(random));
    TriangleSetup t;
    if (setup_triangle(awkward_triangle(random, kSize, bits), whole_triangle_weights(), state, t) !=
        SetupOutcome::kKept)
      continue;
    const Tiles walked = by_walk(t, state.samples);
    if (walked != by_edges(t, state.samples)) FAIL("round " << round);
    tiles += walked.size();
  }
  CHECK(tiles > 50000);
}

TEST_CASE("edge_walk: a span ends where the definition does, in targets as wide as any and far beyond") {
  RandomSource random(23);
  int spans = 0;
  for (int round = 0; round < 400; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4, wide = 16384;
    const SetupState state = state_of(bits, samples, {0, 0, wide, wide});
    const auto v = awkward_triangle(random, std::min(wide, 1 << (27 - bits)), bits);
    TriangleSetup t;
    if (setup_triangle(v, whole_triangle_weights(), state, t) != SetupOutcome::kKept) continue;
    EdgeWalk walk(t, state.samples);
    for (SampleRow row; walk.next(row);) {
      const GridPoint& offset = state.samples.offset[static_cast<std::size_t>(row.sample)];
      const auto in = [&](std::int32_t x) { return covers(v, x, row.y, bits, offset); };
      const bool right = row.empty() ? !in(row.x0) || row.x0 >= wide
                                     : in(row.x0) && in(row.x1 - 1) && (row.x0 == 0 || !in(row.x0 - 1)) &&
                                           (row.x1 == wide || !in(row.x1));
      if (!right) FAIL("round " << round << " row " << row.y << ": " << row.x0 << " to " << row.x1);
      spans += row.empty() ? 0 : 1;
    }
  }
  CHECK(spans > 100000);
}

TEST_CASE("edge_walk: triangles around a sample point cover every sample of their square once") {
  RandomSource random(24);
  for (int round = 0; round < 200; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4;
    const std::int32_t one = 1 << bits, end = kSize * one;
    const auto at = [](std::int32_t x, std::int32_t y) { return WindowVertex{x, y, 0.5F, 1.0F}; };
    WalkCount count(samples, bits);
    WindowVertex middle = at(random.integer(1, end - 1), random.integer(1, end - 1));
    if (round % 8 < 4) {
      const GridPoint& offset = count.grid().offset[static_cast<std::size_t>(random.integer(0, samples - 1))];
      middle.x = random.integer(1, kSize - 2) * one + one / 2 + static_cast<std::int32_t>(offset.x);
      middle.y = random.integer(1, kSize - 2) * one + one / 2 + static_cast<std::int32_t>(offset.y);
    }
    // A fan whose spokes also end on the square's sides, often at the height or the column of the middle.
    const std::vector<WindowVertex> ring{at(0, 0),     at(middle.x, 0),   at(end, 0), at(end, middle.y),
                                         at(end, end), at(middle.x, end), at(0, end), at(0, middle.y)};
    for (std::size_t i = 0; i < ring.size(); ++i) count.add({ring[i], ring[(i + 1) % ring.size()], middle});
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int s = 0; s < samples; ++s)
          if (count.at(x, y, s) != 1)
            FAIL("round " << round << " pixel " << x << "," << y << " sample " << s);
  }
  SUCCEED();
}

TEST_CASE("edge_walk: a strip of slivers covers every sample of its band once") {
  RandomSource random(25);
  for (int round = 0; round < 200; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4;
    const std::int32_t one = 1 << bits, end = kSize * one;
    std::vector<std::int32_t> upper{0, end}, lower{0, end};
    for (int i = 0; i < 40; ++i) {
      upper.push_back(random.integer(0, end));
      lower.push_back(random.integer(0, end));
    }
    std::ranges::sort(upper);
    std::ranges::sort(lower);
    const std::int32_t top = random.integer(0, 8 * one), bottom = end - random.integer(0, 8 * one);
    const bool turned = round % 2 == 1;  // a strip of columns
    const auto at = [&](std::int32_t along, std::int32_t across) {
      return turned ? WindowVertex{across, along, 0.5F, 1.0F} : WindowVertex{along, across, 0.5F, 1.0F};
    };
    WalkCount strip(samples, bits), band(samples, bits);
    for (std::size_t i = 0; i + 1 < upper.size(); ++i) {
      strip.add({at(upper[i], top), at(upper[i + 1], top), at(lower[i], bottom)});
      strip.add({at(upper[i + 1], top), at(lower[i + 1], bottom), at(lower[i], bottom)});
    }
    band.add({at(0, top), at(end, top), at(0, bottom)});
    band.add({at(end, top), at(end, bottom), at(0, bottom)});
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int s = 0; s < samples; ++s)
          if (strip.at(x, y, s) != band.at(x, y, s) || strip.at(x, y, s) > 1)
            FAIL("round " << round << " pixel " << x << "," << y << " sample " << s);
  }
  SUCCEED();
}

TEST_CASE("edge_walk: lines of every mode and width, and points, are those of edge functions") {
  RandomSource random(26);
  std::size_t tiles = 0;
  for (int round = 0; round < 12000; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4, one = 1 << bits;
    SetupState state = state_of(bits, samples, random_scissor(random));
    state.line_mode = std::array{LineMode::kBresenham, LineMode::kRectangular,
                                 LineMode::kSmooth}[static_cast<std::size_t>(round / 4 % 3)];
    state.line_width = random.integer(0, 1) == 0 ? 1.0F : random.real(1.0F, 9.0F);
    // one in four is level, one upright
    const auto at = [&] { return random.integer(-8 * one, (kSize + 8) * one); };
    const int kind = random.integer(0, 3);
    LineEnd a{{at(), at(), 0.25F, 1.0F}, {0, 0}}, b{{at(), at(), 0.75F, 0.5F}, {1, 0}};
    if (kind == 0) b.vertex.y = a.vertex.y;
    if (kind == 1) b.vertex.x = a.vertex.x;
    TriangleSetup t;
    if (setup_line({a, b}, state, t) == SetupOutcome::kKept) {
      const Tiles walked = by_walk(t, state.samples);
      if (walked != by_edges(t, state.samples)) FAIL("line of round " << round);
      tiles += walked.size();
    }
    const WindowPoint point{a.vertex, random.real(1.0F, 40.0F), false, {0, 0}};
    if (setup_point(point, state, t) != SetupOutcome::kKept) continue;
    const Tiles walked = by_walk(t, state.samples);
    if (walked != by_edges(t, state.samples)) FAIL("point of round " << round);
    tiles += walked.size();
  }
  CHECK(tiles > 50000);
}

TEST_CASE("edge_walk: a triangle has a part on either side of its middle corner, a level side leaves one") {
  CHECK(walked({{{10, 10}, {40, 30}, {20, 50}}}) == Walked{20, 2});
  CHECK(walked({{{10, 10}, {40, 10}, {20, 50}}}) == Walked{20, 1});  // level above
  CHECK(walked({{{10, 10}, {40, 50}, {20, 50}}}) == Walked{20, 1});  // level below
  CHECK(walked({{{10, 10}, {40, 11}, {20, 50}}}) == Walked{20, 1});  // no centre lies above the corner's row
  CHECK(walked({{{10, 11}, {40, 31}, {20, 51}}}) == Walked{20, 2});  // corners at the height of centres
  CHECK(walked({{{10, 10}, {40, 30}, {20, 50}}}, {0, 16, 64, 64}) ==
        Walked{9, 1});  // the upper part is cut off
  CHECK(walked({{{10, 10}, {40, 30}, {20, 50}}}, {0, 0, 64, 15}) == Walked{10, 1});
}

TEST_CASE("edge_walk: every sample has rows and parts of its own") {
  for (const int samples : {2, 4, 8})
    CHECK(walked({{{10, 10}, {40, 30}, {20, 50}}}, {0, 0, kSize, kSize}, samples) ==
          Walked{20 * samples, 2 * samples});
}

TEST_CASE("edge_walk: a Bresenham line is walked once for all samples of its pixels") {
  SetupState state = state_of(8, 4, {0, 0, kSize, kSize});
  TriangleSetup t;
  const LineEnd a{{10 * 256, 10 * 256, 0.5F, 1.0F}, {0, 0}}, b{{20 * 256, 30 * 256, 0.5F, 1.0F}, {1, 0}};
  REQUIRE(setup_line({a, b}, state, t) == SetupOutcome::kKept);
  CHECK(EdgeWalk(t, state.samples).samples() == 1);
  state.line_mode = LineMode::kRectangular;
  REQUIRE(setup_line({a, b}, state, t) == SetupOutcome::kKept);
  CHECK(EdgeWalk(t, state.samples).samples() == 4);
}
