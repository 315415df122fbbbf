#include "models/raster/interpolate.h"

#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "tests/models/raster/brute_force.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <memory>

using namespace quadrille::models;

namespace {

/// Barycentric weights of a pixel centre by areas, in long double.
struct Weights {
  long double b[3];
};
Weights weights_at(const std::array<WindowVertex, 3>& v, int x, int y) {
  const std::int64_t px = x * 256 + 128, py = y * 256 + 128;
  const auto area = static_cast<long double>(doubled_area(v[0], v[1], v[2].x, v[2].y));
  const auto part = [&](std::size_t i) {
    return static_cast<long double>(doubled_area(v[(i + 1) % 3], v[(i + 2) % 3], px, py)) / area;
  };
  return {{part(0), part(1), part(2)}};
}

}  // namespace

TEST_CASE("interpolate: covered pixels agree with long double") {
  RandomSource random(31);
  auto in = std::make_unique<FragmentInputs>();
  int pixels = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto v = awkward_triangle(random, 64, 8);
    TriangleSetup t;
    if (setup_in_square(v, 64, 8, t) != SetupOutcome::kKept) continue;
    TileWalk walk(t);
    for (TileHit hit; walk.next(hit);) {
      const std::uint64_t coverage = tile_coverage(t, hit.tile_x, hit.tile_y);
      for (std::uint32_t quads = quads_of(coverage); quads != 0; quads &= quads - 1) {
        const int quad = std::countr_zero(quads), slot = random.integer(0, 7);
        const int x0 = 8 * hit.tile_x + 2 * (quad % 4), y0 = 8 * hit.tile_y + 2 * (quad / 4);
        interpolate_quad(t, x0, y0, slot, *in);
        for (int pixel = 0; pixel < 4; ++pixel) {
          if ((coverage >> (4 * quad + pixel) & 1) == 0) continue;
          const auto lane = static_cast<std::size_t>(4 * slot + pixel);
          const int x = x0 + pixel % 2, y = y0 + pixel / 2;
          const Weights w = weights_at(v, x, y);
          long double inv_w = 0, z = 0;
          for (std::size_t i = 0; i < 3; ++i) {
            inv_w += w.b[i] * static_cast<long double>(v[i].inv_w);
            z += w.b[i] * static_cast<long double>(v[i].z);
          }
          const auto close = [&](float got, long double expected, long double tolerance) {
            if (!(std::abs(static_cast<long double>(got) - expected) <= tolerance)) {
              FAIL("round " << round << " pixel " << x << "," << y << ": " << got << " is not "
                            << static_cast<double>(expected));
            }
          };
          // Half a unit in the last place of a float near 1, and what a double loses on a triangle two
          // million pixels wide.
          close(in->x[lane], x + 0.5L, 0);
          close(in->y[lane], y + 0.5L, 0);
          close(in->z[lane], z, 1e-7L);
          close(in->inv_w[lane], inv_w, 2e-7L);
          close(in->persp_1[lane], w.b[1] * static_cast<long double>(v[1].inv_w) / inv_w, 1e-7L);
          close(in->persp_2[lane], w.b[2] * static_cast<long double>(v[2].inv_w) / inv_w, 1e-7L);
          close(in->linear_1[lane], w.b[1], 1e-7L);
          close(in->linear_2[lane], w.b[2], 1e-7L);
          CHECK(in->front_facing[lane] == (t.front_facing ? ~0u : 0u));
          ++pixels;
        }
      }
    }
  }
  CHECK(pixels > 100000);
}

TEST_CASE("interpolate: one depth function for tiles and quads and its bounds hold every covered depth") {
  RandomSource random(32);
  auto in = std::make_unique<FragmentInputs>();
  int tiles = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto v = awkward_triangle(random, 64, 8);
    TriangleSetup t;
    if (setup_in_square(v, 64, 8, t) != SetupOutcome::kKept) continue;
    TileWalk walk(t);
    for (TileHit hit; walk.next(hit); ++tiles) {
      float depths[64];
      tile_depths(t, hit.tile_x, hit.tile_y, depths);
      for (int quad = 0; quad < kTileQuads; ++quad) {
        interpolate_quad(t, 8 * hit.tile_x + 2 * (quad % 4), 8 * hit.tile_y + 2 * (quad / 4), quad % 8, *in);
        for (int pixel = 0; pixel < 4; ++pixel) {
          const float z = in->z[static_cast<std::size_t>(4 * (quad % 8) + pixel)];
          if (std::bit_cast<std::uint32_t>(z) != std::bit_cast<std::uint32_t>(depths[4 * quad + pixel]))
            FAIL("round " << round << " quad " << quad);
        }
      }
      const DepthBounds bounds = tile_depth_bounds(t, hit.tile_x, hit.tile_y);
      float least = 2, greatest = -1;
      for (std::uint64_t mask = tile_coverage(t, hit.tile_x, hit.tile_y); mask != 0; mask &= mask - 1) {
        least = std::min(least, depths[std::countr_zero(mask)]);
        greatest = std::max(greatest, depths[std::countr_zero(mask)]);
      }
      if (greatest < 0) continue;
      if (bounds.min > least || bounds.max < greatest)
        FAIL("round " << round << ": depths " << least << ".." << greatest << " leave the bounds");
      if (hit.fully_covered && (bounds.min != least || bounds.max != greatest))
        FAIL("round " << round << ": bounds of a full tile are not tight");
    }
  }
  CHECK(tiles > 10000);
}

TEST_CASE("interpolate: a flat triangle has one depth") {
  const std::array<WindowVertex, 3> v{WindowVertex{10, 20, 0.3f, 1}, WindowVertex{9000, 777, 0.3f, 0.5f},
                                      WindowVertex{400, 8000, 0.3f, 2}};
  TriangleSetup t;
  REQUIRE(setup_in_square(v, 64, 8, t) == SetupOutcome::kKept);
  float depths[64];
  tile_depths(t, 1, 2, depths);
  for (const float z : depths) CHECK(z == 0.3f);
}
