/// Textures in device memory: mip chains in one of four orders (`Tiling`), which a machine chooses. An
/// address is always a sum of a part of x and one of y.
///
/// Tiled, neighbours in both directions share cache lines and DRAM rows. Of 4 bytes a texel, a sector of 32
/// bytes is 4x2 texels and a line of 128 bytes 8x4 texels (2x2 sectors); larger and smaller texels lie in the
/// same order. A tile of 4 KiB is 32x32 texels (4x8 lines, row by row). The bits of a texel's index within it
/// are, from the least: x0 x1 y0 x2 y1 x3 x4 y2 y3 y4. Tiles are row by row.
///
/// Linear, rows lie one behind the other, each from a sector on. In Morton order the bits of x and y
/// alternate, x first, in squares whose side is the shorter one of the level, rounded up to a power of two;
/// squares lie along the longer side.
///
/// In Williams' layout [P: Williams 1983] the components lie apart. A square of 2N x 2N bytes, row by row,
/// has the red of the finest level of N x N at upper right, green at lower right and blue at lower left; at
/// upper left lie those of the next level, and so on. A fourth component, which Williams did not have, lies
/// behind the square, in the places of red. So a texel is four bytes of four lines. Only planes
/// of four components of 8 bits whose sides differ by at most a factor of two lie so; others are tiled.
///
/// An attachment that is sampled lies as it was drawn, in tiles of 8x8 pixels that are quad-major
/// (memory/surface.h): x0 y0 x1 x2 y1 y2. Of several samples a pixel the planes of a tile follow each other,
/// and the sample adds a part of its own.
///
/// A texture of compressed blocks lies as one whose texels were the blocks. Its texels are counted row by row
/// within a block, and a block has as many places as the next power of two: 16 for 4x4 texels, 64 for 6x6. So
/// an index is a block and a place in it.
#pragma once

#include "models/base/format.h"
#include "models/base/image_view.h"
#include "models/memory/device_memory.h"
#include "models/memory/surface.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille::models {

inline constexpr std::uint32_t kMaxTextureLevels = 15;  ///< up to 16384 x 16384
inline constexpr std::uint32_t kMaxTextureSize = 16384;

enum class Tiling : std::uint8_t { kTiled, kLinear, kMorton, kWilliams, kSurface };

/// Texels of the finest level; a volume has one layer, all else a depth of 1.
struct TextureExtent {
  std::uint32_t width = 1, height = 1, depth = 1, layers = 1;
};

/// Texels of a block, and log2 of the places that they have among all texels' indices.
struct BlockPlaces {
  std::uint32_t width = 1, height = 1;
  int place_bits = 0;
};
[[nodiscard]] inline BlockPlaces block_places(Format format) {
  const FormatInfo& info = format_info(format);
  const std::uint32_t width = info.block_width, height = info.block_height;
  return {width, height, static_cast<int>(std::bit_width(width * height - 1))};
}

/// Where the texels of a mip chain lie, in texels from its base; in Williams' layout, in bytes, and of a
/// texel's first component. Arrays by level, padded for vector loads. The slices of a volume's level, or the
/// layers of an array's, lie one behind the other.
struct TextureLayout {
  Tiling tiling = Tiling::kTiled;
  std::uint32_t levels = 1;
  std::array<std::int32_t, 16> width{}, height{};  ///< texels
  /// From one row of tiles, of texels or of blocks to the next; in Morton order, log2 of a square's side
  std::array<std::int32_t, 16> pitch{};
  std::array<std::int32_t, 16> first{};         ///< index of the level's first texel
  std::array<std::int32_t, 16> slices{};        ///< or layers
  std::array<std::int32_t, 16> slice_texels{};  ///< from a slice to the next
  std::uint64_t bytes = 0;                      ///< whole chain; a multiple of a line
  /// log2 of the texels from a tile of a surface to the next
  int tile_shift = 6;
  std::uint32_t samples = 1;  ///< a texel, of a surface
  int plane_shift = 6;        ///< log2 of the texels from a sample's plane of a tile to the next
  BlockPlaces blocks;         ///< 1x1 but of a format of blocks

  [[nodiscard]] constexpr bool in_blocks() const { return blocks.place_bits != 0; }
  /// log2 of the bytes of a row of Williams' square; else 0.
  [[nodiscard]] constexpr int plane_row_shift() const {
    return tiling == Tiling::kWilliams ? std::countr_zero(static_cast<std::uint32_t>(pitch[0])) : 0;
  }
  [[nodiscard]] static constexpr std::uint32_t x_part(std::uint32_t x) {
    return (x & 3) | (x & 4) << 1 | (x & 24) << 2 | (x >> 5) << 10;
  }
  [[nodiscard]] static constexpr std::uint32_t y_part_in_tile(std::uint32_t y) {
    return (y & 1) << 2 | (y & 2) << 3 | (y & 28) << 5;
  }
  [[nodiscard]] constexpr std::uint32_t surface_x_part(std::uint32_t x) const {
    return (x & 1) | (x & 6) << 1 | (x >> 3) << tile_shift;
  }
  [[nodiscard]] static constexpr std::uint32_t surface_y_part_in_tile(std::uint32_t y) {
    return (y & 1) << 1 | (y & 6) << 3;
  }
  [[nodiscard]] constexpr std::uint32_t sample_part(std::uint32_t sample) const {
    return sample << plane_shift;
  }
  /// Index of a texel within the chain; of several samples, of the first.
  [[nodiscard]] std::uint32_t texel_index(std::uint32_t level, std::uint32_t x, std::uint32_t y,
                                          std::uint32_t slice = 0) const;

 private:
  /// Of a texel, or of a block, within a slice of the level.
  [[nodiscard]] std::uint32_t unit_index(std::uint32_t level, std::uint32_t x, std::uint32_t y) const;
};

/// Where a component of a texel lies in Williams' layout, whose first component is at `first`; rows have
/// 2^`row_shift` bytes. The side of the texel's level is the highest bit of its column.
[[nodiscard]] constexpr std::uint32_t plane_index(std::uint32_t first, int row_shift,
                                                  std::uint32_t component) {
  const std::uint32_t side = std::bit_floor(first & ((1u << row_shift) - 1));
  switch (component) {
    case 0: return first;
    case 1: return first + (side << row_shift);
    case 2: return first + (side << row_shift) - side;
    default: return first + (1u << 2 * row_shift);
  }
}

/// Lays out a chain of texels of 1, 2, 4, 8 or 16 bytes, or as `format` has them. Each level begins with a
/// line. Throws `UserError` for a size outside 1..16384, more levels than the size has, or 2^31 texels and
/// more.
[[nodiscard]] TextureLayout make_texture_layout(const TextureExtent& extent, std::uint32_t levels,
                                                std::uint32_t texel_bytes = 4);
[[nodiscard]] TextureLayout make_texture_layout(Format format, const TextureExtent& extent,
                                                std::uint32_t levels, Tiling tiling = Tiling::kTiled);
/// Of a plane.
[[nodiscard]] inline TextureLayout make_texture_layout(std::uint32_t width, std::uint32_t height,
                                                       std::uint32_t levels, std::uint32_t texel_bytes = 4) {
  return make_texture_layout(TextureExtent{width, height}, levels, texel_bytes);
}

/// A texture as a sampler sees it.
struct TextureView {
  std::uint64_t base = 0;  ///< address, aligned to a line
  Format format = Format::kR8G8B8A8Unorm;
  TextureLayout layout;
  ViewKind kind = ViewKind::k2D;
  ComponentMapping components = kSameComponents;
  /// Of a texel, or of the first byte that may hold a part of it.
  [[nodiscard]] std::uint64_t texel_address(std::uint32_t level, std::uint32_t x, std::uint32_t y) const {
    const std::uint64_t bytes = layout.tiling == Tiling::kWilliams ? 1 : format_bytes(format);
    return base + (bytes * layout.texel_index(level, x, y) >> layout.blocks.place_bits);
  }
};

/// An attachment as a sampler sees it: its levels, finest first, where they were drawn. They lie one behind
/// the other. Throws `UserError` for 2^31 texels and more, with all samples.
[[nodiscard]] TextureView view_of_surfaces(std::span<const SurfaceLayout> levels, Format format);
/// The same of several layers, one behind the other, each with so many levels. Neighbours are equally far
/// apart.
[[nodiscard]] TextureView view_of_surfaces(std::span<const SurfaceLayout> layers, std::uint32_t levels,
                                           Format format);
/// So many layers of a view, from one on.
[[nodiscard]] TextureView view_of_layers(const TextureView& view, std::uint32_t first, std::uint32_t count);
/// So many levels of a view, from one on.
[[nodiscard]] TextureView view_of_levels(const TextureView& view, std::uint32_t first, std::uint32_t count);

/// Allocates a texture of zeros; `tile_level` and `tile_texture` bring its texels.
[[nodiscard]] TextureView allocate_texture(DeviceMemory& memory, Format format, const TextureExtent& extent,
                                           std::uint32_t levels, Tiling tiling = Tiling::kTiled);
[[nodiscard]] inline TextureView allocate_texture(DeviceMemory& memory, Format format, std::uint32_t width,
                                                  std::uint32_t height, std::uint32_t levels) {
  return allocate_texture(memory, format, {width, height}, levels);
}
/// Tiles one level: rows top to bottom, slice by slice, tightly packed. Another number of texels than the
/// level has is an internal error.
void tile_level(DeviceMemory& memory, const TextureView& view, std::uint32_t level,
                std::span<const std::byte> texels);

/// Tiles all levels: finest first, each as `tile_level` takes it. Throws `UserError` when `texels` has
/// another size than the levels need.
void tile_texture(DeviceMemory& memory, const TextureView& view, std::span<const std::byte> texels);

}  // namespace quadrille::models
