/// Colour and depth surfaces in device memory: 4 bytes a sample, 8x8-pixel tiles of 256 bytes a sample, row
/// by row; a tile is quad-major (raster/tile.h).
///
/// A plane is two lines of 128 bytes (its upper and lower half); a sector of 32 bytes is two quads.
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
  std::uint32_t samples = 1;  ///< a pixel; a tile of them is one after the other, a plane each
  /// Planes of all tiles.
  [[nodiscard]] std::size_t planes() const { return std::size_t{tiles_x} * tiles_y * samples; }
  [[nodiscard]] std::uint64_t bytes() const { return std::uint64_t{planes()} * kTileBytes; }
  /// Of a tile's plane among them.
  [[nodiscard]] std::size_t plane_number(std::uint32_t tx, std::uint32_t ty, std::uint32_t sample = 0) const {
    return (std::size_t{ty} * tiles_x + tx) * samples + sample;
  }
  [[nodiscard]] std::uint64_t tile_address(std::uint32_t tx, std::uint32_t ty,
                                           std::uint32_t sample = 0) const {
    return base + std::uint64_t{plane_number(tx, ty, sample)} * kTileBytes;
  }
  [[nodiscard]] std::uint64_t pixel_address(std::uint32_t x, std::uint32_t y) const {
    return tile_address(x / 8, y / 8) +
           4 * static_cast<std::uint64_t>(tile_entry(static_cast<int>(x % 8), static_cast<int>(y % 8)));
  }
};

/// Allocates a surface of width x height pixels (both at least 1) of 1, 2, 4 or 8 samples.
[[nodiscard]] SurfaceLayout allocate_surface(DeviceMemory& memory, std::uint32_t width, std::uint32_t height,
                                             std::uint32_t samples = 1);
/// Sets every sample, the padding of edge tiles included, to one 32-bit value.
void fill_surface(DeviceMemory& memory, const SurfaceLayout& surface, std::uint32_t value);
/// The first samples as rows of 32-bit pixels, top to bottom; the bits of a float for a depth surface.
[[nodiscard]] std::vector<std::uint32_t> detile(const DeviceMemory& memory, const SurfaceLayout& surface);
/// The surface as rows of RGBA bytes, top to bottom: 4 * width * height bytes.
[[nodiscard]] std::vector<std::uint8_t> detile_rgba8(const DeviceMemory& memory,
                                                     const SurfaceLayout& surface);
/// The reverse of `detile`: `pixels` holds width * height values.
void entile(DeviceMemory& memory, const SurfaceLayout& surface, std::span<const std::uint32_t> pixels);

}  // namespace quadrille::models
