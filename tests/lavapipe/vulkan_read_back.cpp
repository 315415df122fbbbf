/// Reading back what a frame drew: the attachments of its last pass, and the buffers that programs wrote.
#include <cstring>

#include "models/base/error.h"
#include "models/rop/blend.h"
#include "models/rop/depth_plane.h"
#include "tests/lavapipe/vulkan_frame.h"

namespace quadrille::lavapipe {

namespace {

/// The depth aspect as copies give it: floats, 16 bits, or 24 bits in the low part of 32. [VK1.3
/// #copies-images]
void read_depths(traces::Format format, const HostBuffer& copied, std::vector<float>& depths) {
  const auto* const bytes = static_cast<const std::byte*>(copied.mapped);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    std::uint32_t code = 0;
    if (format == traces::Format::kD16Unorm) std::memcpy(&code, bytes + 2 * i, 2);
    else std::memcpy(&code, bytes + 4 * i, 4);
    if (format == traces::Format::kD24UnormS8Uint) code &= 0xffffffu;
    depths[i] = models::decode_depth(format, {{code}});
  }
}

}  // namespace

void VulkanFrame::read_back_buffers(Rendered& result) const {
  for (const traces::DescriptorSet& set : stream_.descriptor_sets) {
    for (const traces::StorageBinding& bound : set.buffers) {
      const std::size_t bytes = stream_.buffers[bound.buffer].data.size();
      Cleanup scratch;
      const HostBuffer copy = device_.buffer(scratch, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
      const VkCommandBuffer commands = device_.begin_commands(scratch);
      const VkBufferCopy region{0, 0, bytes};
      vkCmdCopyBuffer(commands, buffers_[bound.buffer], copy.buffer, 1, &region);
      require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
      device_.submit(commands);
      std::vector<std::byte>& data = result.buffers[bound.buffer];
      data.resize(bytes);
      std::memcpy(data.data(), copy.mapped, bytes);
    }
  }
}

std::vector<models::PixelCode> VulkanFrame::read_target(const traces::ImagePart& part) const {
  const traces::Image& image = stream_.images[part.image];
  const std::size_t pixel_bytes = models::format_bytes(image.format);
  std::vector<models::PixelCode> codes(std::size_t{traces::level_width(image, part.level)} *
                                       traces::level_height(image, part.level));
  Cleanup scratch;
  const HostBuffer copied = copy_image(scratch, part, pixel_bytes);
  for (std::size_t i = 0; i < codes.size(); ++i)
    std::memcpy(codes[i].word.data(), static_cast<const std::byte*>(copied.mapped) + pixel_bytes * i,
                pixel_bytes);
  return codes;
}

HostBuffer VulkanFrame::copy_image(Cleanup& cleanup, const traces::ImagePart& part,
                                   std::size_t pixel_bytes) const {
  const traces::Image& source = stream_.images[part.image];
  const Image& image = images_[part.image];
  VkBufferImageCopy copy{};
  copy.imageExtent = {traces::level_width(source, part.level), traces::level_height(source, part.level), 1};
  copy.imageSubresource = {image.aspect, part.level, part.layer, 1};
  const HostBuffer target =
      device_.buffer(cleanup, pixel_bytes * copy.imageExtent.width * copy.imageExtent.height,
                     VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const VkCommandBuffer commands = device_.begin_commands(cleanup);
  vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.buffer, 1,
                         &copy);
  require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  device_.submit(commands);
  return target;
}

Rendered VulkanFrame::read_back() const {
  const traces::PassTarget source = traces::target_of(stream_, *bound_.pass);
  Rendered result;
  result.width = source.width;
  result.height = source.height;
  for (const traces::ColorAttachmentUse& color : bound_.pass->colors)
    result.targets.push_back(read_target(shown(color)));
  result.color.reserve(result.targets.at(0).size());
  for (const models::PixelCode& code : result.targets[0])
    result.color.push_back(models::to_rgba8(source.color, code));
  // Depths of several samples cannot be copied.
  const traces::ImagePart depth = bound_.pass->depth.part();
  if (depth.image != traces::kNone && stream_.images[depth.image].samples == 1) {
    Cleanup scratch;
    result.depth.resize(result.color.size());
    read_depths(stream_.images[depth.image].format, copy_image(scratch, depth, 4), result.depth);
  }
  read_back_buffers(result);
  if (queries_ == nullptr) result.queries = stream_queries_.results();
  return result;
}

}  // namespace quadrille::lavapipe
