/// Properties of images and passes.
#include "traces/command_stream.h"

#include <algorithm>

#include "models/texture/block/block_format.h"

namespace quadrille::traces {

std::uint32_t level_width(const Image& image, std::uint32_t level) {
  return level < 32 ? std::max(1u, image.width >> level) : 1;
}
std::uint32_t level_height(const Image& image, std::uint32_t level) {
  return level < 32 ? std::max(1u, image.height >> level) : 1;
}

std::uint32_t level_depth(const Image& image, std::uint32_t level) {
  return level < 32 ? std::max(1u, image.depth >> level) : 1;
}

std::uint64_t level_bytes(const Image& image, std::uint32_t level) {
  return models::format_area_bytes(image.format, level_width(image, level), level_height(image, level)) *
         level_depth(image, level);
}

std::uint64_t texel_bytes(const Image& image) {
  std::uint64_t bytes = 0;
  for (std::uint32_t level = 0; level < image.levels; ++level) bytes += level_bytes(image, level);
  return bytes * image.layers;
}

std::uint32_t level_count(const CommandStream& stream, const TextureDescriptor& texture) {
  return texture.levels != 0 ? texture.levels : stream.images[texture.image].levels - texture.first_level;
}

std::size_t texture_count(const CommandStream& stream) {
  return static_cast<std::size_t>(
      std::ranges::count_if(stream.images, [](const Image& image) { return !image.is_attachment(); }));
}

BeginPass make_pass(CommandStream& stream, const PassTarget& target, const std::array<float, 4>& clear_color,
                    float clear_depth) {
  const auto add = [&](const char* name, Format format, ImageUsage usage) {
    Image image;
    image.name = name;
    image.format = format;
    image.width = target.width;
    image.height = target.height;
    image.usage = usage;
    stream.images.push_back(std::move(image));
    return static_cast<Index>(stream.images.size() - 1);
  };
  BeginPass pass;
  pass.colors.emplace_back();
  pass.colors[0].image = add("colour", target.color, kColorAttachment);
  pass.colors[0].clear = clear_color;
  if (target.depth != Format::kUndefined) pass.depth.image = add("depth", target.depth, kDepthAttachment);
  pass.depth.clear = clear_depth;
  return pass;
}

PassTarget target_of(const CommandStream& stream, const BeginPass& pass) {
  const AttachmentUse& first = pass.first();
  const Image& image = stream.images[first.image];
  return {level_width(image, first.level), level_height(image, first.level),
          pass.colors.empty() ? Format::kUndefined : image.format,
          pass.depth.image == kNone ? Format::kUndefined : stream.images[pass.depth.image].format};
}

PassTarget shown_target(const CommandStream& stream) {
  const BeginPass* last = nullptr;
  for (const Command& command : stream.commands) {
    if (const auto* begin = std::get_if<BeginPass>(&command)) last = begin;
  }
  return target_of(stream, *last);
}

void unpack(Image& image) {
  if (!image.packed) return;
  std::vector<std::byte> texels;
  texels.reserve(texel_bytes(image));
  (*image.packed)([&](std::uint32_t /*level*/, std::span<const std::byte> level) {
    texels.insert(texels.end(), level.begin(), level.end());
  });
  image.texels = std::move(texels);
  image.packed = nullptr;
}

Image decompressed(const Image& image) {
  if (!models::is_block_format(image.format)) return image;
  Image plain = image;
  plain.format = models::decoded_format(image.format);
  plain.texels.clear();
  std::span<const std::byte> blocks = image.texels;
  for (std::uint32_t level = 0; level < image.levels; ++level) {
    const std::uint32_t width = level_width(image, level), height = level_height(image, level);
    const std::uint64_t bytes = models::format_area_bytes(image.format, width, height);
    for (std::uint32_t slice = 0; slice < level_depth(image, level) * image.layers; ++slice) {
      const std::vector<std::byte> texels =
          models::decode_blocks(image.format, width, height, blocks.first(bytes));
      plain.texels.insert(plain.texels.end(), texels.begin(), texels.end());
      blocks = blocks.subspan(bytes);
    }
  }
  return plain;
}

}  // namespace quadrille::traces
