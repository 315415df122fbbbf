/// Colour and depth surfaces in device memory: tiles of 8x8 pixels, row by row; a tile is quad-major
/// (raster/tile.h), and of several samples a pixel one plane follows the other.
///
/// Pixels of 4 bytes make a plane two lines of 128 bytes (its upper and lower half), and a sector of 32 bytes
/// is two quads. A plane begins on a line of its own, so that of pixels of one byte half of it is unused.
#pragma once

#include "models/base/format.h"
#include "models/memory/device_memory.h"
#include "models/raster/tile.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::models {

struct SurfaceLayout {
  std::uint64_t base = 0;               ///< address of tile (0, 0)
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::uint32_t tiles_x = 0, tiles_y = 0;
  std::uint32_t samples = 1;      ///< a pixel; a tile of them is one after the other, a plane each
  std::uint32_t pixel_bytes = 4;  ///< 1, 2, 4, 8 or 16
  /// Of a tile's pixels of one sample.
  [[nodiscard]] std::uint32_t plane_bytes() const { return kTilePixels * pixel_bytes; }
  /// From a plane to the next.
  [[nodiscard]] std::uint32_t plane_stride() const { return std::max(plane_bytes(), kLineBytes); }
  [[nodiscard]] std::uint32_t plane_lines() const { return plane_stride() / kLineBytes; }
  [[nodiscard]] std::uint32_t plane_sectors() const { return plane_bytes() / kSectorBytes; }
  /// Of a line that hold pixels, as bits 0..3.
  [[nodiscard]] std::uint8_t line_sectors() const { return plane_sectors() < 4 ? 0x3 : 0xf; }
  /// Planes of all tiles.
  [[nodiscard]] std::size_t planes() const { return std::size_t{tiles_x} * tiles_y * samples; }
  /// What it takes of memory.
  [[nodiscard]] std::uint64_t bytes() const { return std::uint64_t{planes()} * plane_stride(); }
  /// What reading all of it moves.
  [[nodiscard]] std::uint64_t pixel_bytes_of_all() const { return std::uint64_t{planes()} * plane_bytes(); }
  /// Of a tile's plane among them.
  [[nodiscard]] std::size_t plane_number(std::uint32_t tx, std::uint32_t ty, std::uint32_t sample = 0) const {
    return (std::size_t{ty} * tiles_x + tx) * samples + sample;
  }
  [[nodiscard]] std::uint64_t tile_address(std::uint32_t tx, std::uint32_t ty,
                                           std::uint32_t sample = 0) const {
    return base + std::uint64_t{plane_number(tx, ty, sample)} * plane_stride();
  }
  [[nodiscard]] std::uint64_t pixel_address(std::uint32_t x, std::uint32_t y) const {
    return tile_address(x / 8, y / 8) + pixel_bytes * static_cast<std::uint64_t>(tile_entry(
                                                          static_cast<int>(x % 8), static_cast<int>(y % 8)));
  }
};

inline constexpr std::uint64_t kSurfaceAlignment = 256;  ///< bytes

/// Lays out a surface of width x height pixels (both at least 1) of 1, 2, 4 or 8 samples, from address 0 on.
[[nodiscard]] SurfaceLayout surface_layout(std::uint32_t width, std::uint32_t height,
                                           std::uint32_t samples = 1, std::uint32_t pixel_bytes = 4);
/// The same, and allocates it.
[[nodiscard]] SurfaceLayout allocate_surface(DeviceMemory& memory, std::uint32_t width, std::uint32_t height,
                                             std::uint32_t samples = 1, std::uint32_t pixel_bytes = 4);
/// Sets pixels that lie one behind the other to one value.
void fill_pixels(std::span<std::byte> pixels, std::uint32_t pixel_bytes, const PixelCode& value);
/// Sets every sample, the padding of edge tiles included, to one value.
void fill_surface(DeviceMemory& memory, const SurfaceLayout& surface, const PixelCode& value);
/// The first samples, row by row, top to bottom.
[[nodiscard]] std::vector<PixelCode> detile_codes(const DeviceMemory& memory, const SurfaceLayout& surface);
/// The same of pixels of up to 4 bytes; the bits of a float for a depth surface.
[[nodiscard]] std::vector<std::uint32_t> detile(const DeviceMemory& memory, const SurfaceLayout& surface);
/// A surface of 4 bytes a pixel as rows of RGBA bytes, top to bottom: 4 * width * height bytes.
[[nodiscard]] std::vector<std::uint8_t> detile_rgba8(const DeviceMemory& memory,
                                                     const SurfaceLayout& surface);
/// The reverse of `detile`: `pixels` holds width * height values.
void entile(DeviceMemory& memory, const SurfaceLayout& surface, std::span<const std::uint32_t> pixels);

}  // namespace quadrille::models
