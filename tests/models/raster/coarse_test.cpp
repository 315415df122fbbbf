#include "models/raster/coarse.h"

#include "models/raster/fine.h"
#include "tests/models/raster/brute_force.h"

#include <catch2/catch.hpp>

#include <vector>

using namespace quadrille::models;

namespace {

/// By the definition: within the bounding box's tiles, and for each edge some pixel of the tile inside it.
bool touched(const TriangleSetup& t, int tx, int ty) {
  if (tx < t.bounds.x0 >> 3 || tx > (t.bounds.x1 - 1) >> 3 || ty < t.bounds.y0 >> 3 ||
      ty > (t.bounds.y1 - 1) >> 3)
    return false;
  for (const EdgeFunction& edge : t.edges) {
    bool inside = false;
    for (int entry = 0; entry < kTilePixels; ++entry)
      inside = inside || edge.at(8 * tx + entry_x(entry), 8 * ty + entry_y(entry)) >= 0;
    if (!inside) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("coarse: visits exactly the touched tiles in row order and knows the full ones") {
  RandomSource random(11);
  constexpr int kSize = 80;  // 10 x 10 tiles
  int visited = 0, full = 0;
  for (int round = 0; round < 3000; ++round) {
    const int bits = random.integer(4, 12);
    TriangleSetup t;
    if (setup_in_square(awkward_triangle(random, kSize, bits), kSize, bits, t) != SetupOutcome::kKept)
      continue;
    TileWalk walk(t);
    std::uint64_t charged = 0;
    bool more = true;
    TileHit hit;
    more = walk.next(hit);
    for (int ty = 0; ty < 10; ++ty) {
      for (int tx = 0; tx < 10; ++tx) {
        const std::uint64_t coverage = tile_coverage(t, tx, ty);
        if (!touched(t, tx, ty)) {
          if (coverage != 0)
            FAIL("round " << round << ": tile " << tx << "," << ty << " is covered but not touched");
          continue;
        }
        if (!more || hit.tile_x != tx || hit.tile_y != ty)
          FAIL("round " << round << ": tile " << tx << "," << ty << " was not visited in its turn");
        if (hit.fully_covered != (coverage == ~std::uint64_t{0}))
          FAIL("round " << round << ": tile " << tx << "," << ty << " full or not");
        ++visited;
        full += hit.fully_covered ? 1 : 0;
        ++charged;
        more = walk.next(hit);
      }
    }
    if (more) FAIL("round " << round << ": an extra tile " << hit.tile_x << "," << hit.tile_y);
    const auto rows = static_cast<std::uint64_t>(((t.bounds.y1 - 1) >> 3) - (t.bounds.y0 >> 3) + 1);
    if (walk.tests() < charged || walk.tests() > charged + 2 * rows)
      FAIL("round " << round << ": " << walk.tests() << " tests for " << charged);
  }
  CHECK(visited > 10000);
  CHECK(full > 1000);
}

TEST_CASE("coarse: a rectangle half costs its tiles and one failing test a row end") {
  // The lower left half of pixels 0..64 x 0..64: row r of tiles keeps tiles 0..r; its right end stops short
  // of the bounding box but in the last row.
  const std::array<WindowVertex, 3> v{WindowVertex{0, 0, 0, 1}, WindowVertex{64 * 256, 64 * 256, 0, 1},
                                      WindowVertex{0, 64 * 256, 0, 1}};
  TriangleSetup t;
  REQUIRE(setup_in_square(v, 64, 8, t) == SetupOutcome::kKept);
  TileWalk walk(t);
  int tiles = 0, full = 0;
  for (TileHit hit; walk.next(hit);) {
    ++tiles;
    full += hit.fully_covered ? 1 : 0;
  }
  CHECK(tiles == 36);
  CHECK(full == 28);
  CHECK(walk.tests() == 36 + 7);
}

TEST_CASE("coarse: a triangle a million pixels wide takes no longer than its tiles") {
  const std::int32_t far = 500000 * 256;
  const std::array<WindowVertex, 3> v{WindowVertex{-far, -far, 0, 1}, WindowVertex{far, 0, 0, 1},
                                      WindowVertex{-far, far, 0, 1}};
  SetupState state;
  state.scissor = {0, 0, 1920, 1080};
  TriangleSetup t;
  REQUIRE(setup_triangle(v, whole_triangle_weights(), state, t) == SetupOutcome::kKept);
  TileWalk walk(t);
  std::uint64_t tiles = 0;
  for (TileHit hit; walk.next(hit);) ++tiles;
  CHECK(tiles == 240 * 135);
  CHECK(walk.tests() == tiles);
}

TEST_CASE("coarse: an empty walk ends at once") {
  TileWalk none;
  TileHit hit;
  CHECK_FALSE(none.next(hit));
  CHECK_FALSE(TileWalk(TriangleSetup{}).next(hit));
}
