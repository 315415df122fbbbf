/// Attachments that begin with texels: copied there at the begin of every submission, since the last one has
/// left something else. Depths and stencil values are copied aspect by aspect. [VK1.3 #copies-images]
#include <cstring>

#include "models/rop/depth_plane.h"
#include "tests/lavapipe/vulkan_frame.h"
#include "traces/attachment_texels.h"

namespace quadrille::lavapipe {
namespace {

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 15) / 16 * 16; }  // a multiple of any texel

/// Pixels of a depth format as copies take one aspect: stencil values as bytes; depths as they are, but
/// without what lies beside them in the pixel.
std::vector<std::byte> aspect_of(traces::Format format, VkImageAspectFlagBits aspect,
                                 std::span<const std::byte> texels) {
  const std::size_t bytes = models::format_bytes(format);
  if (aspect == VK_IMAGE_ASPECT_COLOR_BIT || !models::has_stencil(format))
    return {texels.begin(), texels.end()};
  const models::ComponentBits& stencil = models::format_info(format).stencil;
  std::vector<std::byte> made;
  for (std::size_t at = 0; at < texels.size(); at += bytes) {
    if (aspect == VK_IMAGE_ASPECT_STENCIL_BIT) {
      made.push_back(texels[at + static_cast<std::size_t>(stencil.shift / 8)]);
    } else {
      made.insert(made.end(), texels.begin() + static_cast<std::ptrdiff_t>(at),
                  texels.begin() + static_cast<std::ptrdiff_t>(at + 4));
      if (format == traces::Format::kD24UnormS8Uint) made.back() = std::byte{0};
    }
  }
  return made;
}

}  // namespace

void VulkanFrame::hold_texels(traces::Index index) {
  const traces::Image& source = stream_.images[index];
  HeldTexels held;
  std::vector<std::byte> all;
  for (const VkImageAspectFlagBits aspect :
       {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
    if ((images_[index].all_aspects & aspect) == 0) continue;
    for (std::uint32_t level = 0; level < source.levels; ++level)
      for (std::uint32_t layer = 0; layer < source.layers; ++layer) {
        const std::vector<std::byte> part =
            aspect_of(source.format, aspect, traces::part_texels(source, level, layer));
        VkBufferImageCopy copy{};
        copy.bufferOffset = all.size();
        copy.imageSubresource = {static_cast<VkImageAspectFlags>(aspect), level, layer, 1};
        copy.imageExtent = {traces::level_width(source, level), traces::level_height(source, level), 1};
        held.copies.push_back(copy);
        all.insert(all.end(), part.begin(), part.end());
        all.resize(padded(all.size()));
      }
  }
  held.buffer = device_.device_buffer(cleanup_, all, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  held_[index] = std::move(held);
}

void VulkanFrame::bring_texels(traces::Index index, const HeldTexels& held) {
  const traces::Image& source = stream_.images[index];
  for (std::uint32_t level = 0; level < source.levels; ++level)
    for (std::uint32_t layer = 0; layer < source.layers; ++layer) {
      const traces::ImagePart part{index, level, layer};
      layouts_[part] = VK_IMAGE_LAYOUT_UNDEFINED;  // an earlier submission's content is forgotten
      move(part, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    }
  vkCmdCopyBufferToImage(commands_, held.buffer, images_[index].image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         static_cast<std::uint32_t>(held.copies.size()), held.copies.data());
  const bool sampled = (source.usage & traces::kSampled) != 0;
  for (std::uint32_t level = 0; sampled && level < source.levels; ++level)
    for (std::uint32_t layer = 0; layer < source.layers; ++layer)
      move({index, level, layer}, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

}  // namespace quadrille::lavapipe
