/// Several samples a pixel: coverage by the definition, exactly once in meshes, tiles and depths that hold
/// all.
#include "models/raster/samples.h"

#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "models/raster/interpolate.h"
#include "tests/models/raster/brute_force.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <memory>
#include <set>
#include <vector>

using namespace quadrille::models;

namespace {

constexpr int kSize = 64;

/// How often each sample of a square is covered, through set-up, walk and coverage.
class SampleCount {
 public:
  SampleCount(int samples, int bits) : grid_(sample_grid(samples, bits)) {
    count_.resize(static_cast<std::size_t>(kSize * kSize * samples));
  }
  void add(const std::array<WindowVertex, 3>& v) {
    TriangleSetup t;
    if (setup_in_square(v, kSize, grid_.subpixel_bits, t, grid_.count) != SetupOutcome::kKept) return;
    TileWalk walk(t, grid_);
    for (TileHit hit; walk.next(hit);) {
      for (int s = 0; s < grid_.count; ++s) {
        std::uint64_t mask = sample_coverage(t, hit.tile_x, hit.tile_y, grid_, s);
        if (hit.fully_covered) REQUIRE(~mask == 0);
        for (; mask != 0; mask &= mask - 1) {
          const int entry = std::countr_zero(mask);
          ++at(8 * hit.tile_x + entry_x(entry), 8 * hit.tile_y + entry_y(entry), s);
        }
      }
    }
  }
  [[nodiscard]] int& at(int x, int y, int sample) {
    return count_[static_cast<std::size_t>((y * kSize + x) * grid_.count + sample)];
  }
  [[nodiscard]] const SampleGrid& grid() const { return grid_; }

 private:
  SampleGrid grid_;
  std::vector<int> count_;
};

}  // namespace

TEST_CASE("samples: the standard positions, each in a row and a column of its own") {
  CHECK(sample_grid(1, 8).offset[0] == GridPoint{0, 0});
  CHECK(sample_grid(2, 4).offset[1] == GridPoint{-4, -4});
  CHECK(sample_grid(4, 8).offset[0] == GridPoint{-32, -96});
  for (const int samples : {2, 4, 8}) {
    const SampleGrid grid = sample_grid(samples, 4);
    std::set<std::int64_t> rows, columns;
    std::int64_t x = 0, y = 0;
    for (std::size_t s = 0; s < static_cast<std::size_t>(samples); ++s) {
      columns.insert(grid.offset[s].x);
      rows.insert(grid.offset[s].y);
      x += grid.offset[s].x, y += grid.offset[s].y;
    }
    CHECK(rows.size() == static_cast<std::size_t>(samples));
    CHECK(columns.size() == static_cast<std::size_t>(samples));
    CHECK((samples == 8 || (x == 0 && y == 0)));
    CHECK(grid.low.x >= -8);
    CHECK(grid.high.y <= 7);
  }
}

TEST_CASE("samples: what is covered is what the definition covers, at 2, 4 and 8 samples and 4 to 12 bits") {
  RandomSource random(11);
  for (int round = 0; round < 900; ++round) {
    const int bits = random.integer(4, 12), samples = 2 << round % 3;
    const auto v = awkward_triangle(random, kSize, bits);
    SampleCount count(samples, bits);
    count.add(v);
    for (int y = 0; y < kSize; y += random.integer(1, 3)) {
      for (int x = 0; x < kSize; ++x) {
        for (int s = 0; s < samples; ++s) {
          const bool inside = covers(v, x, y, bits, count.grid().offset[static_cast<std::size_t>(s)]);
          if (count.at(x, y, s) != (inside ? 1 : 0))
            FAIL("round " << round << " pixel " << x << "," << y << " sample " << s);
        }
      }
    }
  }
  SUCCEED();
}

TEST_CASE(
    "samples: those of a pixel are those of the tiles, and inputs there are those of a quad moved there") {
  RandomSource random(15);
  auto in = std::make_unique<FragmentInputs>();
  int moved = 0;
  for (int round = 0; round < 400; ++round) {
    const int bits = random.integer(4, 12), samples = 1 << round % 4;
    const SampleGrid grid = sample_grid(samples, bits);
    TriangleSetup t;
    if (setup_in_square(awkward_triangle(random, kSize, bits), kSize, bits, t, samples) !=
        SetupOutcome::kKept)
      continue;
    const int tile_x = random.integer(0, 7), tile_y = random.integer(0, 7);
    for (int s = 0; s < samples; ++s) {
      const std::uint64_t plane = sample_coverage(t, tile_x, tile_y, grid, s);
      for (int entry = 0; entry < kTilePixels; ++entry) {
        const int x = 8 * tile_x + entry_x(entry), y = 8 * tile_y + entry_y(entry);
        REQUIRE((covered_samples(t, x, y, grid) >> s & 1u) == (plane >> entry & 1u));
        if ((plane >> entry & 1u) == 0) continue;
        const PixelOffset at = grid.from_centre(s);
        interpolate_quad(t, x & ~1, y & ~1, 3, *in, at);
        const auto lane = static_cast<std::size_t>(12 + (x & 1) + 2 * (y & 1));
        const VertexWeights weights = weights_at(t, x + (0.5 + at.x), y + (0.5 + at.y));
        REQUIRE(weights.persp_1 == in->persp_1[lane]);
        REQUIRE(weights.persp_2 == in->persp_2[lane]);
        REQUIRE(weights.linear_1 == in->linear_1[lane]);
        REQUIRE(weights.linear_2 == in->linear_2[lane]);
        REQUIRE(in->x[lane] == static_cast<float>(x + (0.5 + at.x)));
        // A covered sample lies in the triangle: its weights are within, but for rounding.
        REQUIRE(std::min({weights.linear_1, weights.linear_2, 1 - weights.linear_1 - weights.linear_2}) >
                -1e-3f);
        moved += samples > 1 ? 1 : 0;
      }
    }
  }
  CHECK(moved > 1000);
}

TEST_CASE("samples: two triangles that share an edge cover each sample of their square once") {
  RandomSource random(12);
  for (int round = 0; round < 150; ++round) {
    const int bits = random.integer(4, 12), samples = 2 << round % 3;
    const std::int32_t one = 1 << bits, end = kSize * one;
    const auto at = [](std::int32_t x, std::int32_t y) { return WindowVertex{x, y, 0.5f, 1.0f}; };
    // The square, by the four triangles around a point in it; often the point is a sample.
    SampleCount count(samples, bits);
    WindowVertex middle = at(random.integer(1, end - 1), random.integer(1, end - 1));
    if (round % 2 == 0) {
      const GridPoint& offset = count.grid().offset[static_cast<std::size_t>(random.integer(0, samples - 1))];
      middle.x = random.integer(1, kSize - 2) * one + one / 2 + static_cast<std::int32_t>(offset.x);
      middle.y = random.integer(1, kSize - 2) * one + one / 2 + static_cast<std::int32_t>(offset.y);
    }
    const std::array<WindowVertex, 4> corner{at(0, 0), at(end, 0), at(end, end), at(0, end)};
    for (std::size_t i = 0; i < 4; ++i) count.add({corner[i], corner[(i + 1) % 4], middle});
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int s = 0; s < samples; ++s)
          if (count.at(x, y, s) != 1)
            FAIL("round " << round << " pixel " << x << "," << y << " sample " << s);
  }
  SUCCEED();
}

TEST_CASE("samples: the bounds of a tile's depths hold those of all its samples") {
  RandomSource random(13);
  for (int round = 0; round < 600; ++round) {
    const int samples = 2 << round % 3;
    const SampleGrid grid = sample_grid(samples, 8);
    TriangleSetup t;
    if (setup_in_square(awkward_triangle(random, kSize, 8), kSize, 8, t, samples) != SetupOutcome::kKept)
      continue;
    TileWalk walk(t, grid);
    for (TileHit hit; walk.next(hit);) {
      const DepthBounds bounds = tile_depth_bounds(t, hit.tile_x, hit.tile_y, grid);
      for (int s = 0; s < samples; ++s) {
        float depths[64];
        sample_depths(t, hit.tile_x, hit.tile_y, grid, s, depths);
        for (std::uint64_t mask = sample_coverage(t, hit.tile_x, hit.tile_y, grid, s); mask != 0;
             mask &= mask - 1) {
          const float z = depths[std::countr_zero(mask)];
          if (z < bounds.min || z > bounds.max) FAIL("round " << round << " sample " << s);
        }
      }
    }
  }
  SUCCEED();
}
