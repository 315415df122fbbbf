/// Colour and depth surfaces in device memory: 4 bytes a pixel, 8x8-pixel tiles of 256 bytes, row by row; a
/// tile is quad-major (raster/tile.h).
///
/// A tile is two lines of 128 bytes (its upper and lower half); a sector of 32 bytes is two quads.
#pragma once

#include "models/memory/device_memory.h"
#include "models/raster/tile.h"

#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::models {

inline constexpr std::uint32_t kTileBytes = 256;

struct SurfaceLayout {
  std::uint64_t base = 0;               ///< address of tile (0, 0)
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::uint32_t tiles_x = 0, tiles_y = 0;
  [[nodiscard]] std::uint64_t bytes() const { return std::uint64_t{tiles_x} * tiles_y * kTileBytes; }
  [[nodiscard]] std::uint64_t tile_address(std::uint32_t tx, std::uint32_t ty) const {
    return base + (std::uint64_t{ty} * tiles_x + tx) * kTileBytes;
  }
  [[nodiscard]] std::uint64_t pixel_address(std::uint32_t x, std::uint32_t y) const {
    return tile_address(x / 8, y / 8) +
           4 * static_cast<std::uint64_t>(tile_entry(static_cast<int>(x % 8), static_cast<int>(y % 8)));
  }
};

/// Allocates a surface of width x height pixels (both at least 1).
[[nodiscard]] SurfaceLayout allocate_surface(DeviceMemory& memory, std::uint32_t width, std::uint32_t height);
/// Sets every pixel, the padding of edge tiles included, to one 32-bit value.
void fill_surface(DeviceMemory& memory, const SurfaceLayout& surface, std::uint32_t value);
/// The surface as rows of 32-bit pixels, top to bottom; the bits of a float for a depth surface.
[[nodiscard]] std::vector<std::uint32_t> detile(const DeviceMemory& memory, const SurfaceLayout& surface);
/// The surface as rows of RGBA bytes, top to bottom: 4 * width * height bytes.
[[nodiscard]] std::vector<std::uint8_t> detile_rgba8(const DeviceMemory& memory,
                                                     const SurfaceLayout& surface);
/// The reverse of `detile`: `pixels` holds width * height values.
void entile(DeviceMemory& memory, const SurfaceLayout& surface, std::span<const std::uint32_t> pixels);

}  // namespace quadrille::models
