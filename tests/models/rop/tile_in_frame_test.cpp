#include "models/rop/tile_in_frame.h"

#include "models/raster/tile.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace quadrille::models;

TEST_CASE(
    "tile_in_frame: the greatest depth of a tile at the frame's edge is that of its pixels in the frame") {
  float depths[64];
  for (int i = 0; i < 64; ++i) depths[i] = entry_x(i) < 3 && entry_y(i) < 5 ? 0.25f : 1.0f;
  depths[tile_entry(2, 4)] = 0.5f;
  CHECK(tile_max_within(depths, pixels_within(8, 8)) == 1.0f);
  CHECK(tile_max_within(depths, pixels_within(3, 5)) == 0.5f);
  CHECK(tile_max_within(depths, pixels_within(3, 4)) == 0.25f);
  CHECK(pixels_within(800, 9) == ~std::uint64_t{0});
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  depths[tile_entry(7, 7)] = kNan;
  CHECK(tile_max_within(depths, pixels_within(3, 5)) == 0.5f);
  depths[tile_entry(0, 0)] = kNan;
  CHECK(tile_max_within(depths, pixels_within(3, 5)) == std::numeric_limits<float>::infinity());
}
