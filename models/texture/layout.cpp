#include "models/texture/layout.h"

#include "models/base/error.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace quadrille::models {
namespace {

/// Bytes of a level as it comes: without what tiling adds.
std::uint64_t level_bytes(const TextureView& view, std::uint32_t level) {
  const TextureLayout& layout = view.layout;
  return format_area_bytes(view.format, static_cast<std::uint32_t>(layout.width[level]),
                           static_cast<std::uint32_t>(layout.height[level])) *
         static_cast<std::uint64_t>(layout.slices[level]);
}

/// Tiles rows of blocks.
void tile_blocks(const TextureLayout& layout, std::uint32_t level, std::size_t bytes, const std::byte* source,
                 std::byte* tiled) {
  const auto w = static_cast<std::uint32_t>(layout.width[level]),
             h = static_cast<std::uint32_t>(layout.height[level]),
             slices = static_cast<std::uint32_t>(layout.slices[level]);
  for (std::uint32_t slice = 0; slice < slices; ++slice)
    for (std::uint32_t y = 0; y < h; y += layout.blocks.height)
      for (std::uint32_t x = 0; x < w; x += layout.blocks.width, source += bytes)
        std::memcpy(
            tiled + bytes * (std::size_t{layout.texel_index(level, x, y, slice)} >> layout.blocks.place_bits),
            source, bytes);
}

/// Tiles rows of texels of a size that the compiler knows.
template <std::size_t bytes>
void tile_rows(const TextureLayout& layout, std::uint32_t level, const std::byte* source, std::byte* tiled) {
  constexpr std::size_t kRun = 4 * bytes;  // a row of four texels is contiguous
  const auto w = static_cast<std::uint32_t>(layout.width[level]),
             h = static_cast<std::uint32_t>(layout.height[level]),
             slices = static_cast<std::uint32_t>(layout.slices[level]);
  for (std::uint32_t line = 0; line < h * slices; ++line) {
    std::byte* const row = tiled + bytes * std::size_t{layout.texel_index(level, 0, line % h, line / h)};
    std::uint32_t x = 0;
    for (; x + 4 <= w; x += 4, source += kRun)
      std::memcpy(row + bytes * std::size_t{TextureLayout::x_part(x)}, source, kRun);
    const std::size_t rest = bytes * std::size_t{w - x};
    std::memcpy(row + bytes * std::size_t{TextureLayout::x_part(x)}, source, rest);
    source += rest;
  }
}

/// Texels one by one, in any order.
void place_texels(const TextureLayout& layout, std::uint32_t level, std::size_t bytes,
                  const std::byte* source, std::byte* placed) {
  const auto w = static_cast<std::uint32_t>(layout.width[level]),
             h = static_cast<std::uint32_t>(layout.height[level]),
             slices = static_cast<std::uint32_t>(layout.slices[level]);
  const int row_shift = layout.plane_row_shift();
  for (std::uint32_t slice = 0; slice < slices; ++slice)
    for (std::uint32_t y = 0; y < h; ++y)
      for (std::uint32_t x = 0; x < w; ++x, source += bytes) {
        const std::uint32_t index = layout.texel_index(level, x, y, slice);
        if (layout.tiling == Tiling::kWilliams)
          for (std::uint32_t c = 0; c < bytes; ++c) placed[plane_index(index, row_shift, c)] = source[c];
        else std::memcpy(placed + bytes * std::size_t{index}, source, bytes);
      }
}

constexpr std::uint32_t kTile = 32;  // texels or blocks along a side

std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 8) & 0x00ff00ff;
  v = (v | v << 4) & 0x0f0f0f0f;
  v = (v | v << 2) & 0x33333333;
  return (v | v << 1) & 0x55555555;
}

/// Does a texture of this format lie as Williams had it?
bool has_planes(Format format, const TextureExtent& extent) {
  const FormatInfo& info = format_info(format);
  for (const ComponentBits& component : info.component)
    if (component.bits != 8) return false;
  const std::uint32_t longer = std::max(extent.width, extent.height),
                      shorter = std::min(extent.width, extent.height);
  return info.bytes == 4 && longer <= 2 * shorter;
}

/// What `TextureLayout::pitch` is of a level of so many texels or blocks of so many bytes.
std::uint32_t pitch_of(Tiling tiling, std::uint32_t columns, std::uint32_t rows, std::uint32_t unit_bytes) {
  if (tiling == Tiling::kLinear) {
    const auto sector = static_cast<std::uint32_t>(kSectorBytes) / unit_bytes;
    return (columns + sector - 1) / sector * sector;
  }
  if (tiling == Tiling::kMorton)
    return static_cast<std::uint32_t>(std::bit_width(std::min(columns, rows) - 1));
  return (columns + kTile - 1) / kTile * (kTile * kTile);
}

/// The squares of Williams, a slice each.
void lay_out_planes(TextureLayout& layout) {
  const auto side = std::bit_ceil(static_cast<std::uint32_t>(std::max(layout.width[0], layout.height[0])));
  for (std::uint32_t level = 0; level < layout.levels; ++level) {
    layout.pitch[level] = static_cast<std::int32_t>(2 * side);
    layout.first[level] = static_cast<std::int32_t>(side >> level);
    layout.slice_texels[level] = static_cast<std::int32_t>(6 * side * side);
  }
  const std::uint64_t bytes = std::uint64_t{6} * side * side * static_cast<std::uint64_t>(layout.slices[0]);
  layout.bytes = (bytes + kLineBytes - 1) / kLineBytes * kLineBytes;
}

}  // namespace

namespace {

constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 31;

UserError too_many_texels(const TextureExtent& extent) {
  return user_error("texture of {} x {} x {} texels, {} layers: it takes 2^31 texels and more", extent.width,
                    extent.height, extent.depth, extent.layers);
}

/// `unit_bytes`: of a texel or of a block.
TextureLayout make_layout(const TextureExtent& extent, std::uint32_t levels, std::uint32_t unit_bytes,
                          Tiling tiling, const BlockPlaces& blocks = {}) {
  const auto [width, height, depth, layers] = extent;
  for (const std::uint32_t side : {width, height, depth, layers})
    if (side < 1 || side > kMaxTextureSize)
      throw user_error("texture of {} x {} x {} texels, {} layers: each must be 1 to {}", width, height,
                       depth, layers, kMaxTextureSize);
  const auto most = static_cast<std::uint32_t>(std::bit_width(std::max({width, height, depth})));
  if (levels < 1 || levels > most)
    throw user_error("texture of {} x {} texels with {} levels: it can have 1 to {}", width, height, levels,
                     most);

  TextureLayout layout;
  layout.levels = levels;
  layout.tiling = tiling;
  layout.blocks = blocks;
  const std::uint32_t line_texels =
      (static_cast<std::uint32_t>(kLineBytes) << blocks.place_bits) / unit_bytes;
  std::uint64_t next = 0;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const std::uint32_t w = std::max(width >> level, 1u), h = std::max(height >> level, 1u),
                        slices = std::max(depth >> level, 1u) * layers;
    layout.width[level] = static_cast<std::int32_t>(w);
    layout.height[level] = static_cast<std::int32_t>(h);
    layout.slices[level] = static_cast<std::int32_t>(slices);
    if (tiling == Tiling::kWilliams) continue;
    layout.pitch[level] = static_cast<std::int32_t>(pitch_of(
        tiling, (w + blocks.width - 1) / blocks.width, (h + blocks.height - 1) / blocks.height, unit_bytes));
    // A slice ends with the line of its last texel, which has the highest index of all.
    const std::uint32_t slice =
        layout.texel_index(level, w - 1, h - 1) / line_texels * line_texels + line_texels;
    layout.slice_texels[level] = static_cast<std::int32_t>(slice);
    layout.first[level] = static_cast<std::int32_t>(next);
    next += std::uint64_t{slice} * slices;
    if (next >= kMostTexels) throw too_many_texels(extent);
  }
  layout.bytes = std::uint64_t{unit_bytes} * next >> blocks.place_bits;
  if (tiling == Tiling::kWilliams) lay_out_planes(layout);
  if (tiling == Tiling::kWilliams && layout.bytes >= kMostTexels) throw too_many_texels(extent);
  return layout;
}

}  // namespace

TextureLayout make_texture_layout(const TextureExtent& extent, std::uint32_t levels,
                                  std::uint32_t texel_bytes) {
  return make_layout(extent, levels, texel_bytes, Tiling::kTiled);
}
TextureLayout make_texture_layout(Format format, const TextureExtent& extent, std::uint32_t levels,
                                  Tiling tiling) {
  const bool other = tiling == Tiling::kWilliams && !has_planes(format, extent);
  return make_layout(extent, levels, format_bytes(format), other ? Tiling::kTiled : tiling,
                     block_places(format));
}

std::uint32_t TextureLayout::unit_index(std::uint32_t level, std::uint32_t x, std::uint32_t y) const {
  const auto by = static_cast<std::uint32_t>(pitch[level]);
  switch (tiling) {
    case Tiling::kTiled: break;
    case Tiling::kLinear:
    case Tiling::kWilliams: return x + y * by;
    case Tiling::kMorton: {
      const std::uint32_t within = (1u << by) - 1;
      return (spread_bits(x & within) | spread_bits(y & within) << 1) + (((x >> by) + (y >> by)) << 2 * by);
    }
    case Tiling::kSurface: return surface_x_part(x) + surface_y_part_in_tile(y) + (y >> 3) * by;
  }
  return x_part(x) + y_part_in_tile(y & 31) + (y >> 5) * by;
}

std::uint32_t TextureLayout::texel_index(std::uint32_t level, std::uint32_t x, std::uint32_t y,
                                         std::uint32_t slice) const {
  const std::uint32_t start =
      static_cast<std::uint32_t>(first[level]) + slice * static_cast<std::uint32_t>(slice_texels[level]);
  if (!in_blocks()) return start + unit_index(level, x, y);
  return start + x % blocks.width + y % blocks.height * blocks.width +
         (unit_index(level, x / blocks.width, y / blocks.height) << blocks.place_bits);
}

TextureView view_of_surfaces(std::span<const SurfaceLayout> levels, Format format) {
  return view_of_surfaces(levels, static_cast<std::uint32_t>(levels.size()), format);
}

TextureView view_of_surfaces(std::span<const SurfaceLayout> layers, std::uint32_t levels, Format format) {
  const SurfaceLayout &finest = layers.front(), &last = layers.back();
  TextureView view{finest.base, format, {}};
  TextureLayout& layout = view.layout;
  layout.tiling = Tiling::kSurface;
  layout.levels = levels;
  const std::uint32_t plane_texels = finest.plane_stride() / finest.pixel_bytes,
                      tile_texels = plane_texels * finest.samples;
  layout.tile_shift = std::countr_zero(tile_texels);
  layout.samples = finest.samples;
  layout.plane_shift = std::countr_zero(plane_texels);
  const std::size_t count = layers.size() / levels;
  const std::uint64_t apart = count > 1 ? layers[levels].base - finest.base : 0;
  layout.bytes = last.base + last.bytes() - finest.base;
  if (layout.bytes / finest.pixel_bytes >= std::uint64_t{1} << 31)
    throw user_error("attachment of {} x {} pixels, {} samples, {} layers: it takes 2^31 texels and more",
                     finest.width, finest.height, finest.samples, count);
  for (std::size_t layer = 0; layer < count; ++layer)
    QUADRILLE_CHECK(layers[layer * levels].base == finest.base + layer * apart, "layer {} lies elsewhere",
                    layer);
  for (std::size_t level = 0; level < levels; ++level) {
    const SurfaceLayout& surface = layers[level];
    layout.width[level] = static_cast<std::int32_t>(surface.width);
    layout.height[level] = static_cast<std::int32_t>(surface.height);
    layout.pitch[level] = static_cast<std::int32_t>(surface.tiles_x * tile_texels);
    layout.first[level] = static_cast<std::int32_t>((surface.base - finest.base) / surface.pixel_bytes);
    layout.slices[level] = static_cast<std::int32_t>(count);
    layout.slice_texels[level] = static_cast<std::int32_t>(apart / surface.pixel_bytes);
  }
  return view;
}

TextureView view_of_layers(const TextureView& view, std::uint32_t first, std::uint32_t count) {
  TextureView part = view;
  for (std::uint32_t level = 0; level < view.layout.levels; ++level) {
    part.layout.first[level] += static_cast<std::int32_t>(first) * view.layout.slice_texels[level];
    part.layout.slices[level] = static_cast<std::int32_t>(count);
  }
  return part;
}

TextureView view_of_levels(const TextureView& view, std::uint32_t first, std::uint32_t count) {
  TextureView part = view;
  TextureLayout& layout = part.layout;
  layout.levels = count;
  for (auto* const by_level :
       {&layout.width, &layout.height, &layout.pitch, &layout.first, &layout.slices, &layout.slice_texels})
    std::rotate(by_level->begin(), by_level->begin() + first, by_level->end());
  return part;
}

TextureView allocate_texture(DeviceMemory& memory, Format format, const TextureExtent& extent,
                             std::uint32_t levels, Tiling tiling) {
  TextureView view{0, format, make_texture_layout(format, extent, levels, tiling)};
  view.base = memory.allocate(view.layout.bytes);
  return view;
}

void tile_level(DeviceMemory& memory, const TextureView& view, std::uint32_t level,
                std::span<const std::byte> texels) {
  const TextureLayout& layout = view.layout;
  QUADRILLE_CHECK(level < layout.levels && texels.size() == level_bytes(view, level),
                  "level {} of {} with {} bytes", level, layout.levels, texels.size());
  std::byte* const tiled = memory.write(view.base, layout.bytes).data();
  const std::size_t bytes = format_bytes(view.format);
  if (layout.in_blocks()) return tile_blocks(layout, level, bytes, texels.data(), tiled);
  if (layout.tiling != Tiling::kTiled) return place_texels(layout, level, bytes, texels.data(), tiled);
  switch (bytes) {
    case 1: return tile_rows<1>(layout, level, texels.data(), tiled);
    case 2: return tile_rows<2>(layout, level, texels.data(), tiled);
    case 4: return tile_rows<4>(layout, level, texels.data(), tiled);
    case 8: return tile_rows<8>(layout, level, texels.data(), tiled);
    default: return tile_rows<16>(layout, level, texels.data(), tiled);
  }
}

void tile_texture(DeviceMemory& memory, const TextureView& view, std::span<const std::byte> texels) {
  const TextureLayout& layout = view.layout;
  std::uint64_t expected = 0;
  for (std::uint32_t level = 0; level < layout.levels; ++level) expected += level_bytes(view, level);
  if (texels.size() != expected) {
    throw user_error("texture of {} x {} texels with {} levels: {} bytes of texels, {} are needed",
                     layout.width[0], layout.height[0], layout.levels, texels.size(), expected);
  }
  for (std::uint32_t level = 0; level < layout.levels; ++level) {
    const std::uint64_t size = level_bytes(view, level);
    tile_level(memory, view, level, texels.first(size));
    texels = texels.subspan(size);
  }
}

}  // namespace quadrille::models
