/// Where a quad of the window lies: its tile, and its number there. Pixel i of quad q is pixel 4 q + i of the
/// tile (models/raster/tile.h).
#pragma once

#include <cstdint>

#include "models/raster/tile.h"

namespace quadrille::models {

struct QuadPlace {
  std::uint32_t tile_x = 0, tile_y = 0;
  int quad = 0;  ///< 0..15 within the tile, four a row
  [[nodiscard]] constexpr int first_pixel() const { return 4 * quad; }
};

/// `x`, `y`: the quad's upper left pixel, both even.
[[nodiscard]] constexpr QuadPlace place_of_quad(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kSize = kTileSize;
  return {x / kSize, y / kSize, tile_entry(static_cast<int>(x % kSize), static_cast<int>(y % kSize)) / 4};
}

}  // namespace quadrille::models
