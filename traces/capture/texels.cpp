#include "traces/capture/texels.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "models/base/error.h"
#include "models/texture/block/block_format.h"
#include "traces/capture/device.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

using models::Format;

using Bytes = std::vector<std::byte>;

/// From alpha in front of four-bit components to alpha behind them.
Bytes turned(std::span<const std::byte> texels) {
  Bytes all(texels.begin(), texels.end());
  for (std::size_t at = 0; at + 2 <= all.size(); at += 2) {
    std::uint16_t word = 0;
    std::memcpy(&word, &all[at], sizeof word);
    word = static_cast<std::uint16_t>(word << 4 | word >> 12);
    std::memcpy(&all[at], &word, sizeof word);
  }
  return all;
}

/// An alpha of one behind three bytes.
Bytes widened(std::span<const std::byte> texels) {
  Bytes all;
  all.reserve(texels.size() / 3 * 4);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    all.push_back(texels[i]);
    if (i % 3 == 2) all.push_back(std::byte{255});
  }
  return all;
}

/// Depths of 24 bits, whatever lies above them, as floats.
Bytes floats_of_depths(std::span<const std::byte> texels) {
  Bytes all(texels.begin(), texels.end());
  for (std::size_t at = 0; at + 4 <= all.size(); at += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, &all[at], sizeof word);
    constexpr std::uint32_t kMost = 0xffffff;
    const auto depth = static_cast<float>(static_cast<double>(word & kMost) / kMost);
    std::memcpy(&all[at], &depth, sizeof depth);
  }
  return all;
}

/// Formats of Vulkan that the machine has in another order or size.
struct OtherFormat {
  VkFormat format;
  std::size_t bytes;  ///< of a texel
  Format ours;
  Bytes (*as_ours)(std::span<const std::byte>);
};
constexpr OtherFormat kOthers[] = {
    {VK_FORMAT_A4R4G4B4_UNORM_PACK16, 2, Format::kR4G4B4A4Unorm, turned},
    {VK_FORMAT_A4B4G4R4_UNORM_PACK16, 2, Format::kB4G4R4A4Unorm, turned},
    {VK_FORMAT_X8_D24_UNORM_PACK32, 4, Format::kD32Float, floats_of_depths},
    {VK_FORMAT_D24_UNORM_S8_UINT, 4, Format::kD32Float, floats_of_depths},
    {VK_FORMAT_R8G8B8_UNORM, 3, Format::kR8G8B8A8Unorm, widened},
};
const OtherFormat* other_format(std::uint32_t format) {
  const auto* row = std::ranges::find_if(
      kOthers, [=](const OtherFormat& r) { return static_cast<std::uint32_t>(r.format) == format; });
  return row == std::end(kOthers) ? nullptr : row;
}

Format own_format(std::uint32_t format) {
  const OtherFormat* other = other_format(format);
  return other != nullptr ? other->ours : image_format(format);
}

/// Appends one level of a layer, or a slice of it.
void append_level(Bytes& all, const ViewObject& view, std::span<const std::byte> layer) {
  const OtherFormat* other = other_format(view.format);
  const Bytes texels = other != nullptr ? other->as_ours(layer) : Bytes(layer.begin(), layer.end());
  all.insert(all.end(), texels.begin(), texels.end());
}

std::size_t layer_bytes(std::uint32_t format, std::uint32_t width, std::uint32_t height) {
  if (const OtherFormat* other = other_format(format)) return other->bytes * width * height;
  return models::format_area_bytes(image_format(format), width, height);
}

}  // namespace

Format texture_format(const ViewObject& view) {
  const Format own = own_format(view.format);
  if (!models::format_info(own).may(models::kFileUse))
    throw user_error("a texture of {} is not supported", format_name(view.format));
  return own;
}

TexelBlock texel_block(std::uint32_t format) {
  if (const OtherFormat* other = other_format(format)) return {1, 1, other->bytes};
  const Format ours = image_format(format);
  if (ours == Format::kUndefined) throw user_error("a texture of {} is not supported", format_name(format));
  const models::FormatInfo& info = models::format_info(ours);
  return {info.block_width, info.block_height, info.bytes};
}

bool holds_part(const ImageObject& image, std::uint32_t level, std::uint32_t layer) {
  if (image.samples > 1 || level >= image.levels) return false;
  const std::size_t bytes =
      layer_bytes(image.format, std::max(1u, image.width >> level), std::max(1u, image.height >> level));
  return image.texels[level].size() >= bytes * (layer + std::size_t{1});
}

std::vector<std::byte> attachment_texels(const ImageObject& image) {
  Bytes all;
  bool any = false;
  for (std::uint32_t level = 0; level < image.levels; ++level) any = any || holds_part(image, level, 0);
  for (std::uint32_t level = 0; any && level < image.levels; ++level) {
    const std::uint64_t bytes =
        std::uint64_t{image.layers} *
        layer_bytes(image.format, std::max(1u, image.width >> level), std::max(1u, image.height >> level));
    if (bytes > kMaxObjectBytes)
      throw user_error("an image of {} bytes a level; at most {} are possible", bytes, kMaxObjectBytes);
    const std::size_t end = all.size() + bytes;
    const std::span known =
        std::span(image.texels[level]).first(std::min<std::size_t>(image.texels[level].size(), bytes));
    all.insert(all.end(), known.begin(), known.end());
    all.resize(end);
  }
  return all;
}

std::vector<std::byte> texture_texels(const ImageObject& image, const ViewObject& view, bool& missing) {
  const Format format = texture_format(view);
  Bytes all;
  for (std::uint32_t level = 0; level < image.levels; ++level) {
    const std::uint32_t width = std::max(1u, image.width >> level),
                        height = std::max(1u, image.height >> level),
                        depth = std::max(1u, image.depth >> level);
    const std::size_t bytes = layer_bytes(view.format, width, height);
    const Bytes& source = image.texels[level];
    const std::uint64_t needed =
        models::format_area_bytes(format, width, height) * std::uint64_t{depth} * view.layers;
    if (needed > kMaxObjectBytes)
      throw user_error("an image of {} bytes a level; at most {} are possible", needed, kMaxObjectBytes);
    for (std::uint32_t slice = 0; slice < depth * view.layers; ++slice) {
      const std::size_t begin = bytes * (std::size_t{view.layer} * depth + slice);
      if (source.size() < begin + bytes) {
        missing = true;
        all.resize(all.size() + models::format_area_bytes(format, width, height));
        continue;
      }
      append_level(all, view, std::span(source).subspan(begin, bytes));
    }
  }
  return all;
}

}  // namespace quadrille::capture
