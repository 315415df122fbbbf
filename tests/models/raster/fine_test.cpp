#include "models/raster/fine.h"

#include "models/raster/coarse.h"
#include "tests/models/raster/brute_force.h"
#include "tests/models/raster/cover_count.h"

#include <catch2/catch.hpp>

#include <bit>
#include <utility>
#include <vector>

using namespace quadrille::models;

namespace {

constexpr int kSize = 64;

WindowVertex at(std::int32_t x, std::int32_t y) { return {x, y, 0.5f, 1.0f}; }

}  // namespace

TEST_CASE("fine: coverage equals the definition for triangles of every kind") {
  RandomSource random(1);
  int covered = 0;
  for (int round = 0; round < 6000; ++round) {
    const int bits = random.integer(4, 12);
    const auto v = awkward_triangle(random, kSize, bits);
    TriangleSetup t;
    const bool kept = setup_in_square(v, kSize, bits, t) == SetupOutcome::kKept;
    for (int tile = 0; tile < 64; tile += random.integer(1, 5)) {
      const int tx = tile % 8, ty = tile / 8;
      const std::uint64_t mask = kept ? tile_coverage(t, tx, ty) : 0;
      std::uint64_t expected = 0;
      for (int entry = 0; entry < kTilePixels; ++entry) {
        if (covers(v, 8 * tx + entry_x(entry), 8 * ty + entry_y(entry), bits))
          expected |= std::uint64_t{1} << entry;
      }
      if (mask != expected)
        FAIL("round " << round << " tile " << tile << " bits " << bits << ": " << mask << " is not "
                      << expected);
      covered += std::popcount(mask);
    }
  }
  CHECK(covered > 100000);
}

TEST_CASE("fine: coverage stays within a scissor that cuts tiles") {
  RandomSource random(2);
  for (int round = 0; round < 500; ++round) {
    const auto v = awkward_triangle(random, kSize, 8);
    SetupState state;
    state.scissor = {random.integer(0, 30), random.integer(0, 30), random.integer(31, 64),
                     random.integer(31, 64)};
    TriangleSetup t;
    if (setup_triangle(v, whole_triangle_weights(), state, t) != SetupOutcome::kKept) continue;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const bool inside = x >= state.scissor.x0 && x < state.scissor.x1 && y >= state.scissor.y0 &&
                            y < state.scissor.y1 && covers(v, x, y, 8);
        const bool got = (tile_coverage(t, x / 8, y / 8) >> tile_entry(x % 8, y % 8) & 1) != 0;
        if (got != inside) FAIL("round " << round << " pixel " << x << "," << y);
      }
    }
  }
  SUCCEED();
}

TEST_CASE("fine: a mesh covers each sample inside it exactly once") {
  RandomSource random(3);
  for (int round = 0; round < 60; ++round) {
    const int bits = random.integer(4, 12), cells = random.integer(2, 9), one = 1 << bits;
    // A grid over pixels 4..60 whose inner vertices are moved at random or onto samples; its outer ones stay
    // on pixel corners.
    std::vector<std::vector<WindowVertex>> grid(
        static_cast<std::size_t>(cells) + 1, std::vector<WindowVertex>(static_cast<std::size_t>(cells) + 1));
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        std::int32_t x = 4 * one + 56 * one * i / cells, y = 4 * one + 56 * one * j / cells;
        const int reach = 56 * one / cells / 5;
        if (i > 0 && i < cells) x += random.integer(-reach, reach);
        if (j > 0 && j < cells) y += random.integer(-reach, reach);
        if (random.integer(0, 2) == 0 && i > 0 && i < cells && j > 0 && j < cells) {
          x = x / one * one + one / 2;
          y = y / one * one + one / 2;
        }
        grid[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = at(x, y);
      }
    }
    CoverCount count(kSize, bits);
    for (std::size_t j = 0; j < static_cast<std::size_t>(cells); ++j) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i) {
        WindowVertex a = grid[j][i], b = grid[j][i + 1], c = grid[j + 1][i], d = grid[j + 1][i + 1];
        if (random.integer(0, 1) != 0) {
          count.add(a, b, c);
          count.add(d, b, c);
        } else {
          count.add(a, d, b);
          count.add(a, c, d);
        }
      }
    }
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const int expected = x >= 4 && x < 60 && y >= 4 && y < 60 ? 1 : 0;
        if (count.at(x, y) != expected)
          FAIL("round " << round << " pixel " << x << "," << y << " covered " << count.at(x, y) << " times");
      }
    }
  }
  SUCCEED();
}

TEST_CASE("fine: a fan around a sample point covers it once") {
  RandomSource random(4);
  for (int round = 0; round < 300; ++round) {
    const int spokes = random.integer(3, 24);
    // corners of a square walk, clockwise, so that the fan is exactly the square
    std::vector<std::pair<int, int>> ring;
    ring.reserve(static_cast<std::size_t>(spokes) + 4);
    for (int i = 0; i < spokes; ++i) ring.emplace_back(random.integer(0, 4 * 40 * 256 - 1), 0);
    ring.insert(ring.end(), {{0, 0}, {40 * 256, 0}, {80 * 256, 0}, {120 * 256, 0}});
    std::sort(ring.begin(), ring.end());
    const auto on_square = [](int walk) {
      const int side = walk / (40 * 256), along = walk % (40 * 256), low = 12 * 256, high = 52 * 256;
      if (side == 0) return at(low + along, low);
      if (side == 1) return at(high, low + along);
      if (side == 2) return at(high - along, high);
      return at(low, high - along);
    };
    const WindowVertex centre = at(random.integer(20, 40) * 256 + 128, random.integer(20, 40) * 256 + 128);
    CoverCount count(kSize, 8);
    for (std::size_t i = 0; i < ring.size(); ++i)
      count.add(centre, on_square(ring[i].first), on_square(ring[(i + 1) % ring.size()].first));
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const int expected = x >= 12 && x < 52 && y >= 12 && y < 52 ? 1 : 0;
        if (count.at(x, y) != expected)
          FAIL("round " << round << " pixel " << x << "," << y << " covered " << count.at(x, y) << " times");
      }
    }
  }
  SUCCEED();
}

TEST_CASE("fine: a quad-major entry and its position are inverse") {
  std::uint64_t seen = 0;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const int entry = tile_entry(x, y);
      seen |= std::uint64_t{1} << entry;
      CHECK(entry_x(entry) == x);
      CHECK(entry_y(entry) == y);
      CHECK(quads_of(std::uint64_t{1} << entry) == 1u << (4 * (y / 2) + x / 2));
    }
  }
  CHECK(seen == ~std::uint64_t{0});
  CHECK(quads_of(0x8000000000000011u) == 0x8003u);
}
