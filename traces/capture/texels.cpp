#include "traces/capture/texels.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include "models/base/error.h"
#include "traces/capture/block_texels.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

using Texel = std::array<std::uint8_t, 4>;

/// A component of a texel in one word.
struct Bits {
  std::uint8_t shift = 0, count = 0;
};
/// A format of up to 32 bits a texel whose components are UNORM.
struct PackedFormat {
  VkFormat format;
  std::uint8_t bytes;
  std::array<Bits, 4> components;  ///< one of no bits reads as 0, or 1 if it is alpha
  bool srgb = false;
};
constexpr PackedFormat kPacked[] = {
    {VK_FORMAT_R8_UNORM, 1, {{{0, 8}, {}, {}, {}}}},
    {VK_FORMAT_R8G8_UNORM, 2, {{{0, 8}, {8, 8}, {}, {}}}},
    {VK_FORMAT_R8G8B8_UNORM, 3, {{{0, 8}, {8, 8}, {16, 8}, {}}}},
    {VK_FORMAT_R8G8B8A8_UNORM, 4, {{{0, 8}, {8, 8}, {16, 8}, {24, 8}}}},
    {VK_FORMAT_B8G8R8A8_UNORM, 4, {{{16, 8}, {8, 8}, {0, 8}, {24, 8}}}},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, 4, {{{0, 8}, {8, 8}, {16, 8}, {24, 8}}}},
    {VK_FORMAT_R8G8B8A8_SRGB, 4, {{{0, 8}, {8, 8}, {16, 8}, {24, 8}}}, true},
    {VK_FORMAT_B8G8R8A8_SRGB, 4, {{{16, 8}, {8, 8}, {0, 8}, {24, 8}}}, true},
    {VK_FORMAT_R4G4B4A4_UNORM_PACK16, 2, {{{12, 4}, {8, 4}, {4, 4}, {0, 4}}}},
    {VK_FORMAT_B4G4R4A4_UNORM_PACK16, 2, {{{4, 4}, {8, 4}, {12, 4}, {0, 4}}}},
    {VK_FORMAT_A4R4G4B4_UNORM_PACK16, 2, {{{8, 4}, {4, 4}, {0, 4}, {12, 4}}}},
    {VK_FORMAT_A4B4G4R4_UNORM_PACK16, 2, {{{0, 4}, {4, 4}, {8, 4}, {12, 4}}}},
    {VK_FORMAT_R5G6B5_UNORM_PACK16, 2, {{{11, 5}, {5, 6}, {0, 5}, {}}}},
    {VK_FORMAT_B5G6R5_UNORM_PACK16, 2, {{{0, 5}, {5, 6}, {11, 5}, {}}}},
    {VK_FORMAT_R5G5B5A1_UNORM_PACK16, 2, {{{11, 5}, {6, 5}, {1, 5}, {0, 1}}}},
    {VK_FORMAT_A1R5G5B5_UNORM_PACK16, 2, {{{10, 5}, {5, 5}, {0, 5}, {15, 1}}}},
};

const PackedFormat* packed_format(std::uint32_t format) {
  const auto* row = std::ranges::find(kPacked, static_cast<VkFormat>(format), &PackedFormat::format);
  return row == std::end(kPacked) ? nullptr : row;
}

/// A UNORM number of so many bits as the nearest one of eight.
std::uint8_t to_eight(std::uint32_t code, std::uint32_t bits) {
  const std::uint32_t most = (1u << bits) - 1;
  return static_cast<std::uint8_t>((code * 255 + most / 2) / most);
}

Texel unpack(const PackedFormat& format, const std::byte* source) {
  std::uint32_t word = 0;
  std::memcpy(&word, source, format.bytes);
  Texel texel{0, 0, 0, 255};
  for (std::size_t c = 0; c < 4; ++c) {
    const Bits bits = format.components[c];
    if (bits.count > 0) texel[c] = to_eight(word >> bits.shift & ((1u << bits.count) - 1), bits.count);
  }
  return texel;
}

Texel swizzled(const Texel& texel, const std::array<std::uint32_t, 4>& swizzle) {
  Texel out{};
  for (std::size_t c = 0; c < 4; ++c) {
    const std::uint32_t from = swizzle[c];
    if (from == VK_COMPONENT_SWIZZLE_IDENTITY) out[c] = texel[c];
    else if (from >= VK_COMPONENT_SWIZZLE_R && from <= VK_COMPONENT_SWIZZLE_A)
      out[c] = texel[from - VK_COMPONENT_SWIZZLE_R];
    else out[c] = from == VK_COMPONENT_SWIZZLE_ONE ? 255 : 0;
  }
  return out;
}

struct Extent {
  std::uint32_t width, height;
};
Extent level_extent(const ImageObject& image, std::uint32_t level) {
  return {std::max(1u, image.width >> level), std::max(1u, image.height >> level)};
}

/// One layer of a level, row by row.
std::vector<Texel> plain_texels(const PackedFormat& format, Extent extent,
                                std::span<const std::byte> source) {
  std::vector<Texel> texels(std::size_t{extent.width} * extent.height);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = unpack(format, source.data() + i * format.bytes);
  return texels;
}

std::size_t layer_bytes(std::uint32_t format, Extent extent) {
  if (const PackedFormat* packed = packed_format(format))
    return std::size_t{extent.width} * extent.height * packed->bytes;
  return block_bytes(format) * ((extent.width + 3) / 4) * ((extent.height + 3) / 4);
}

}  // namespace

traces::Format expanded_format(const ViewObject& view) {
  const PackedFormat* packed = packed_format(view.format);
  if (packed == nullptr && block_bytes(view.format) == 0)
    throw user_error("a texture of {} is not supported", format_name(view.format));
  const bool srgb = packed != nullptr ? packed->srgb : is_srgb_block(view.format);
  return srgb ? traces::Format::kR8G8B8A8Srgb : traces::Format::kR8G8B8A8Unorm;
}

std::vector<std::byte> expanded_texels(const ImageObject& image, const ViewObject& view, bool& missing) {
  std::vector<std::byte> all;
  for (std::uint32_t level = 0; level < image.levels; ++level) {
    const Extent extent = level_extent(image, level);
    const std::size_t bytes = layer_bytes(view.format, extent), begin = bytes * view.layer;
    const std::vector<std::byte>& source = image.texels[level];
    if (source.size() < begin + bytes) {
      missing = true;
      all.resize(all.size() + std::size_t{4} * extent.width * extent.height);
      continue;
    }
    const std::span<const std::byte> layer = std::span(source).subspan(begin, bytes);
    const PackedFormat* packed = packed_format(view.format);
    const std::vector<Texel> texels = packed != nullptr
                                          ? plain_texels(*packed, extent, layer)
                                          : block_texels(view.format, extent.width, extent.height, layer);
    for (const Texel& texel : texels) {
      const Texel out = swizzled(texel, view.swizzle);
      for (const std::uint8_t c : out) all.push_back(std::byte{c});
    }
  }
  return all;
}

}  // namespace quadrille::capture
