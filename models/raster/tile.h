/// The 8x8-pixel tile: the unit that the rasteriser, Hi-Z, the depth and colour units and the surfaces in
/// memory share.
///
/// All 64-entry arrays and masks of a tile are *quad-major*: entry 4 * quad + pixel, where quad = 4 * (y / 2)
/// + x / 2 (0..15) and pixel = 2 * (y & 1) + (x & 1), x and y within the tile. The four pixels of a quad are
/// therefore adjacent, as they are in a fragment warp.
#pragma once

#include <algorithm>
#include <cstdint>

namespace quadrille::models {

inline constexpr int kTileSize = 8;  ///< pixels along an edge
inline constexpr int kTilePixels = 64;
inline constexpr int kTileQuads = 16;

/// Entry of the pixel (x, y) of a tile, x and y in 0..7.
[[nodiscard]] constexpr int tile_entry(int x, int y) {
  return 16 * (y / 2) + 4 * (x / 2) + 2 * (y & 1) + (x & 1);
}
/// Position within its tile (0..7) of an entry.
[[nodiscard]] constexpr int entry_x(int entry) { return 2 * ((entry >> 2) & 3) + (entry & 1); }
[[nodiscard]] constexpr int entry_y(int entry) { return 2 * (entry >> 4) + ((entry >> 1) & 1); }

/// The quads of a coverage mask that have a covered pixel: bit q = quad q.
[[nodiscard]] constexpr std::uint32_t quads_of(std::uint64_t coverage) {
  std::uint64_t any = (coverage | coverage >> 1 | coverage >> 2 | coverage >> 3) & 0x1111111111111111u;
  any = (any | any >> 3) & 0x0303030303030303u;
  any = (any | any >> 6) & 0x000f000f000f000fu;
  any = (any | any >> 12) & 0x000000ff000000ffu;
  return static_cast<std::uint32_t>((any | any >> 24) & 0xffffu);
}

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelRect {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};
[[nodiscard]] inline PixelRect intersect(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace quadrille::models
