#include "models/rop/tile_in_frame.h"

#include "models/raster/tile.h"
#include "models/rop/depth.h"

#include <array>
#include <limits>

namespace quadrille::models {

std::uint64_t pixels_within(int width, int height) {
  std::uint64_t mask = 0;
  for (int entry = 0; entry < kTilePixels; ++entry) {
    if (entry_x(entry) < width && entry_y(entry) < height) mask |= std::uint64_t{1} << entry;
  }
  return mask;
}

float tile_max_within(const float depths[64], std::uint64_t mask) {
  std::array<float, kTilePixels> inside;
  for (std::size_t i = 0; i < inside.size(); ++i)
    inside[i] = (mask >> i & 1) != 0 ? depths[i] : -std::numeric_limits<float>::infinity();
  return tile_max(inside.data());
}

}  // namespace quadrille::models
