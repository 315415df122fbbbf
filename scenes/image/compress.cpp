#include "scenes/image/compress.h"

#include <squish.h>

#include <algorithm>
#include <memory>

#include "models/base/error.h"
#include "scenes/image/astc_encoder.h"

namespace quadrille::scenes {
namespace {

using traces::Format;

Format block_format(Format format, TextureCompression compression) {
  const bool srgb = format == Format::kR8G8B8A8Srgb;
  if (compression == TextureCompression::kBc1) return srgb ? Format::kBc1RgbaSrgb : Format::kBc1RgbaUnorm;
  if (compression == TextureCompression::kBc3) return srgb ? Format::kBc3Srgb : Format::kBc3Unorm;
  // Formats of ASTC are in the same order, each twice.
  const int size = static_cast<int>(compression) - static_cast<int>(TextureCompression::kAstc4x4);
  return static_cast<Format>(static_cast<int>(srgb ? Format::kAstc4x4Srgb : Format::kAstc4x4Unorm) +
                             2 * size);
}

traces::UnpackTexels compressing(const std::shared_ptr<const traces::UnpackTexels>& packed,
                                 std::uint32_t width, std::uint32_t height, TextureCompression compression) {
  return [=](const traces::LevelSink& sink) {
    (*packed)([&](std::uint32_t level, std::span<const std::byte> rgba) {
      sink(level,
           compress_texels(rgba, std::max(1u, width >> level), std::max(1u, height >> level), compression));
    });
  };
}

void compress_all_levels(traces::Image& image, TextureCompression compression) {
  std::vector<std::byte> blocks;
  std::span<const std::byte> rgba = image.texels;
  for (std::uint32_t level = 0; level < image.levels; ++level) {
    const std::uint64_t bytes = traces::level_bytes(image, level);
    const std::vector<std::byte> made = compress_texels(rgba.first(bytes), traces::level_width(image, level),
                                                        traces::level_height(image, level), compression);
    blocks.insert(blocks.end(), made.begin(), made.end());
    rgba = rgba.subspan(bytes);
  }
  image.texels = std::move(blocks);
}

}  // namespace

std::vector<std::byte> compress_texels(std::span<const std::byte> rgba, std::uint32_t width,
                                       std::uint32_t height, TextureCompression compression) {
  QUADRILLE_CHECK(rgba.size() == std::size_t{4} * width * height, "{} bytes for {} x {} texels", rgba.size(),
                  width, height);
  const models::FormatInfo& info = models::format_info(block_format(Format::kR8G8B8A8Unorm, compression));
  if (compression >= TextureCompression::kAstc4x4)
    return encode_astc(rgba, width, height, info.block_width, info.block_height);
  const int flags = compression == TextureCompression::kBc1 ? squish::kDxt1 : squish::kDxt5;
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  std::vector<std::byte> blocks(static_cast<std::size_t>(squish::GetStorageRequirements(w, h, flags)));
  squish::CompressImage(reinterpret_cast<const squish::u8*>(rgba.data()), w, h, blocks.data(),
                        flags | squish::kColourClusterFit);
  return blocks;
}

std::size_t compress_textures(traces::CommandStream& stream, TextureCompression compression) {
  std::size_t count = 0;
  for (traces::Image& image : stream.images) {
    const bool rgba8 = image.format == Format::kR8G8B8A8Unorm || image.format == Format::kR8G8B8A8Srgb;
    const bool plane = image.kind == traces::ImageKind::k2D && image.layers == 1;
    if (image.is_attachment() || !rgba8 || !plane) continue;
    if (image.packed)
      image.packed = std::make_shared<const traces::UnpackTexels>(
          compressing(image.packed, image.width, image.height, compression));
    else compress_all_levels(image, compression);
    image.format = block_format(image.format, compression);
    ++count;
  }
  return count;
}

}  // namespace quadrille::scenes
