#include "models/raster/engine.h"

#include "models/raster/tile.h"

#include <algorithm>

namespace quadrille::models {
namespace {

/// Tiles of a box that are looked at one by one; a larger box touches every engine. [G: of 16 engines most]
constexpr std::int32_t kMostTiles = 64;

struct TileRange {
  std::int32_t first = 0, last = -1;
  [[nodiscard]] std::int32_t count() const { return last - first + 1; }
};

/// Tiles of `size` pixels that lie between two window positions.
TileRange tiles_between(std::int32_t low, std::int32_t high, int subpixel_bits, std::uint32_t size) {
  const int shift = subpixel_bits + 3;
  const auto last = static_cast<std::int32_t>((size - 1) / kTileSize);
  return {std::max(low >> shift, 0), std::min(high >> shift, last)};
}

}  // namespace

std::uint32_t engines_touched(const std::array<WindowVertex, 3>& triangle, std::int32_t reach,
                              int subpixel_bits, std::uint32_t width, std::uint32_t height,
                              const ScreenShare& share, std::uint32_t turn) {
  const std::uint32_t all = (1u << share.engines) - 1;
  if (share.engines == 1) return all;
  const auto [left, right] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
  const auto [top, bottom] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  const TileRange x = tiles_between(left - reach, right + reach, subpixel_bits, width),
                  y = tiles_between(top - reach, bottom + reach, subpixel_bits, height);
  if (x.count() <= 0 || y.count() <= 0) return 1u << turn % share.engines;
  if (std::int64_t{x.count()} * y.count() > kMostTiles) return all;
  std::uint32_t touched = 0;
  for (std::int32_t ty = y.first; ty <= y.last; ++ty) {
    for (std::int32_t tx = x.first; tx <= x.last && touched != all; ++tx)
      touched |= 1u << share.engine_of_tile(static_cast<std::uint32_t>(tx), static_cast<std::uint32_t>(ty));
  }
  return touched;
}

}  // namespace quadrille::models
