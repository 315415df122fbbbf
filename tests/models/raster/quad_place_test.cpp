/// A quad's tile and number.
#include "models/raster/quad_place.h"

#include <catch2/catch.hpp>

using namespace quadrille::models;

TEST_CASE("quad_place: quads are numbered by row, four a row, within tiles of 8x8 pixels") {
  int expected = 0;
  for (std::uint32_t y = 0; y < 8; y += 2) {
    for (std::uint32_t x = 0; x < 8; x += 2) {
      const QuadPlace place = place_of_quad(24 + x, 40 + y);
      CHECK(place.tile_x == 3);
      CHECK(place.tile_y == 5);
      CHECK(place.quad == expected);
      CHECK(place.first_pixel() == 4 * expected);
      ++expected;
    }
  }
}
