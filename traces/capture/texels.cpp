#include "traces/capture/texels.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "models/base/error.h"
#include "models/rop/blend.h"
#include "models/texture/block/block_format.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

using models::Format;
using models::FormatInfo;

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
  const auto* row = std::ranges::find(kOthers, static_cast<VkFormat>(format), &OtherFormat::format);
  return row == std::end(kOthers) ? nullptr : row;
}

/// Of the texels as they are, before the view exchanges components.
Format own_format(std::uint32_t format) {
  const OtherFormat* other = other_format(format);
  return other != nullptr ? other->ours : image_format(format);
}

/// Which component of a texel, or a number (VkComponentSwizzle), the view shows as component `c`.
std::uint32_t shown(const ViewObject& view, std::uint32_t c) {
  return view.swizzle[c] == VK_COMPONENT_SWIZZLE_IDENTITY ? VK_COMPONENT_SWIZZLE_R + c : view.swizzle[c];
}

/// Does the view show each component as it is? What the format lacks is 0, and 1 as alpha.
bool shows_all_as_they_are(const ViewObject& view, const FormatInfo& format) {
  for (std::uint32_t c = 0; c < 4; ++c) {
    const auto number =
        static_cast<std::uint32_t>(c == 3 ? VK_COMPONENT_SWIZZLE_ONE : VK_COMPONENT_SWIZZLE_ZERO);
    const std::uint32_t at = shown(view, c);
    if (at != VK_COMPONENT_SWIZZLE_R + c && (c < format.channels || at != number)) return false;
  }
  return true;
}

/// Are all components bytes, so that exchanging them loses nothing?
bool has_bytes(const FormatInfo& format) {
  if (format.numeric != models::Numeric::kUnorm && format.numeric != models::Numeric::kSrgb) return false;
  return std::ranges::all_of(std::span(format.component).first(format.channels),
                             [](const models::ComponentBits& c) { return c.bits == 8; });
}

/// Exchanged components are bytes where they were, and floats elsewhere.
Format exchanged_format(Format own) {
  const FormatInfo& texels = models::format_info(models::decoded_format(own));
  if (!has_bytes(texels)) return Format::kR32G32B32A32Float;
  return texels.numeric == models::Numeric::kSrgb ? Format::kR8G8B8A8Srgb : Format::kR8G8B8A8Unorm;
}

template <class Number>
std::array<Number, 4> exchanged(const std::array<Number, 4>& texel, Number one, const ViewObject& view) {
  std::array<Number, 4> out{};
  for (std::uint32_t c = 0; c < 4; ++c) {
    const std::uint32_t at = shown(view, c);
    if (at >= VK_COMPONENT_SWIZZLE_R && at <= VK_COMPONENT_SWIZZLE_A)
      out[c] = texel[at - VK_COMPONENT_SWIZZLE_R];
    else if (at == VK_COMPONENT_SWIZZLE_ONE) out[c] = one;
  }
  return out;
}

std::array<std::uint8_t, 4> bytes_of(const FormatInfo& format, const models::PixelCode& code) {
  std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
  for (std::size_t c = 0; c < format.channels; ++c)
    bytes[c] = static_cast<std::uint8_t>(code.word[0] >> format.component[c].shift);
  return bytes;
}

template <class T>
void append(std::vector<std::byte>& all, const std::array<T, 4>& texel) {
  const auto bytes = std::as_bytes(std::span(texel));
  all.insert(all.end(), bytes.begin(), bytes.end());
}

/// Texels of one level of a layer, whose components the view exchanges.
void append_exchanged(std::vector<std::byte>& all, Format format, std::span<const std::byte> texels,
                      const ViewObject& view) {
  const FormatInfo& info = models::format_info(format);
  for (; !texels.empty(); texels = texels.subspan(info.bytes)) {
    models::PixelCode code;
    std::memcpy(code.word.data(), texels.data(), info.bytes);
    if (has_bytes(info)) append(all, exchanged<std::uint8_t>(bytes_of(info, code), 255, view));
    else append(all, exchanged<float>(models::decode_color(format, code), 1, view));
  }
}

/// Appends one level of a layer, or a slice of it.
void append_level(Bytes& all, const ViewObject& view, std::uint32_t width, std::uint32_t height,
                  std::span<const std::byte> layer) {
  const OtherFormat* other = other_format(view.format);
  Bytes texels = other != nullptr ? other->as_ours(layer) : Bytes(layer.begin(), layer.end());
  const Format own = own_format(view.format);
  if (shows_all_as_they_are(view, models::format_info(own))) {
    all.insert(all.end(), texels.begin(), texels.end());
    return;
  }
  if (models::is_block_format(own)) texels = models::decode_blocks(own, width, height, texels);
  append_exchanged(all, models::decoded_format(own), texels, view);
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
  if (shows_all_as_they_are(view, models::format_info(own))) return own;
  if (models::number_kind(own) != models::NumberKind::kFloat)
    throw user_error("a view of {} that exchanges components is not supported", format_name(view.format));
  return exchanged_format(own);
}

TexelBlock texel_block(std::uint32_t format) {
  if (const OtherFormat* other = other_format(format)) return {1, other->bytes};
  const Format ours = image_format(format);
  if (ours == Format::kUndefined) throw user_error("a texture of {} is not supported", format_name(format));
  return {models::is_block_format(ours) ? models::kBlockSide : 1u, models::format_bytes(ours)};
}

bool has_texels(const ImageObject& image, const ViewObject& view) {
  const std::size_t bytes = layer_bytes(view.format, std::max(1u, image.width >> view.level),
                                        std::max(1u, image.height >> view.level));
  return image.texels[view.level].size() >= bytes * (view.layer + std::size_t{1});
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
    for (std::uint32_t slice = 0; slice < depth * view.layers; ++slice) {
      const std::size_t begin = bytes * (std::size_t{view.layer} * depth + slice);
      if (source.size() < begin + bytes) {
        missing = true;
        all.resize(all.size() + models::format_area_bytes(format, width, height));
        continue;
      }
      append_level(all, view, width, height, std::span(source).subspan(begin, bytes));
    }
  }
  return all;
}

}  // namespace quadrille::capture
