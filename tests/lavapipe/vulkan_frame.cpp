/// Recording of a stream: attachments, passes, state and draws, and reading the attachments back.
#include "tests/lavapipe/vulkan_frame.h"

#include <algorithm>
#include <cstring>

#include "models/base/error.h"
#include "tests/lavapipe/vulkan_enums.h"

namespace quadrille::lavapipe {
namespace {

template <class... Lambdas>
struct Overloaded : Lambdas... {
  using Lambdas::operator()...;
};
template <class... Lambdas>
Overloaded(Lambdas...) -> Overloaded<Lambdas...>;

/// Makes everything before visible to everything after and moves the image to `to`. A whole-pipeline barrier:
/// this is a ruler, not a race.
void transition(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                VkImageLayout to) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                       nullptr, 0, nullptr, 1, &barrier);
}

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, const VkClearValue& clear) {
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = view;
  info.imageLayout = layout;
  info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  info.clearValue = clear;
  return info;
}

}  // namespace

VulkanFrame::VulkanFrame(const VulkanDevice& device, const traces::CommandStream& stream,
                         const PassQueries* queries)
    : device_(device), stream_(stream), queries_(queries) {
  upload_buffers();
  upload_images();
  create_samplers();
  create_targets();
  create_descriptor_sets();
  record();
}

void VulkanFrame::upload_buffers() {
  for (const traces::Buffer& source : stream_.buffers)
    buffers_.push_back(device_.device_buffer(cleanup_, source.data,
                                             VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                                 VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT));
}

void VulkanFrame::upload_images() {
  for (const traces::Image& source : stream_.images) {
    const DeviceImage image = device_.image(
        cleanup_, vk_format(source.format), {source.width, source.height}, source.levels,
        VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    images_.push_back(image);
    Cleanup upload;
    const HostBuffer staging = device_.buffer(upload, source.texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    std::memcpy(staging.mapped, source.texels.data(), source.texels.size());
    std::vector<VkBufferImageCopy> levels;
    VkDeviceSize offset = 0;
    for (std::uint32_t level = 0; level < source.levels; ++level) {
      VkBufferImageCopy copy{};
      copy.bufferOffset = offset;
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
      copy.imageExtent = {std::max(1u, source.width >> level), std::max(1u, source.height >> level), 1};
      offset += VkDeviceSize{4} * copy.imageExtent.width * copy.imageExtent.height;
      levels.push_back(copy);
    }
    const VkCommandBuffer commands = device_.begin_commands(upload);
    transition(commands, image.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, staging.buffer, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           static_cast<std::uint32_t>(levels.size()), levels.data());
    transition(commands, image.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    device_.submit(commands);
  }
}

void VulkanFrame::create_samplers() {
  for (const traces::Sampler& source : stream_.samplers) {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = vk_filter(source.mag);
    info.minFilter = vk_filter(source.min);
    info.mipmapMode = vk_mip_mode(source.mip);
    info.addressModeU = vk_wrap(source.wrap_u);
    info.addressModeV = vk_wrap(source.wrap_v);
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.mipLodBias = source.lod_bias;
    info.minLod = source.min_lod;
    info.maxLod = source.max_lod;
    VkSampler sampler = VK_NULL_HANDLE;
    require(vkCreateSampler(device_.handle(), &info, nullptr, &sampler), "vkCreateSampler");
    cleanup_.add([this, sampler] { vkDestroySampler(device_.handle(), sampler, nullptr); });
    samplers_.push_back(sampler);
  }
}

void VulkanFrame::create_targets() {
  for (const traces::RenderTarget& source : stream_.targets) {
    const VkExtent2D size{source.width, source.height};
    Target target;
    target.color = device_.image(cleanup_, vk_format(source.color), size, 1,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                 VK_IMAGE_ASPECT_COLOR_BIT);
    if (source.depth != traces::Format::kUndefined)
      target.depth =
          device_.image(cleanup_, vk_format(source.depth), size, 1,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        VK_IMAGE_ASPECT_DEPTH_BIT);
    targets_.push_back(target);
  }
}

void VulkanFrame::record() {
  commands_ = device_.begin_commands(cleanup_);
  if (queries_ != nullptr) queries_->reset(commands_);
  const auto commands = commands_;
  const auto& buffers = buffers_;
  const Overloaded record_one{
      [this](const traces::BeginPass& c) { begin_pass(c); },
      [this](const traces::EndPass&) { end_pass(); },
      [this](const traces::BindPipeline& c) { bound_.pipeline = c.pipeline; },
      [this](const traces::BindDescriptorSet& c) {
        if (bound_.sets.size() <= c.set) bound_.sets.resize(c.set + std::size_t{1}, traces::kNone);
        bound_.sets[c.set] = c.descriptors;
      },
      [&](const traces::BindVertexBuffer& c) {
        vkCmdBindVertexBuffers(commands, c.binding, 1, &buffers[c.buffer], &c.offset);
      },
      [&](const traces::BindIndexBuffer& c) {
        vkCmdBindIndexBuffer(commands, buffers[c.buffer], c.offset, vk_index_type(c.type));
      },
      [this](const traces::PushConstants& c) {
        bound_.push_constants.resize(std::max(bound_.push_constants.size(), c.offset + c.data.size()));
        std::copy(c.data.begin(), c.data.end(), bound_.push_constants.begin() + c.offset);
      },
      [commands](const traces::SetViewport& c) {
        const VkViewport viewport{c.x, c.y, c.width, c.height, c.min_depth, c.max_depth};
        vkCmdSetViewport(commands, 0, 1, &viewport);
      },
      [commands](const traces::SetScissor& c) {
        const VkRect2D scissor{{c.x, c.y}, {c.width, c.height}};
        vkCmdSetScissor(commands, 0, 1, &scissor);
      },
      [this](const traces::Draw& c) { draw(c); }};
  for (const traces::Command& command : stream_.commands) std::visit(record_one, command);
  require(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

void VulkanFrame::begin_pass(const traces::BeginPass& pass) {
  bound_.target = pass.target;
  const traces::RenderTarget& source = stream_.targets[pass.target];
  const Target& target = targets_[pass.target];
  VkClearValue clear_color{}, clear_depth{};
  std::copy(pass.clear_color.begin(), pass.clear_color.end(), clear_color.color.float32);
  clear_depth.depthStencil.depth = pass.clear_depth;
  transition(commands_, target.color.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  const VkRenderingAttachmentInfo color =
      attachment(target.color.view, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, clear_color);
  const VkRenderingAttachmentInfo depth =
      attachment(target.depth.view, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, clear_depth);
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea.extent = {source.width, source.height};
  info.layerCount = 1;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &color;
  if (target.depth.image != VK_NULL_HANDLE) {
    transition(commands_, target.depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
               VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    info.pDepthAttachment = &depth;
  }
  if (queries_ != nullptr) queries_->begin(commands_, passes_);
  vkCmdBeginRendering(commands_, &info);
}

void VulkanFrame::end_pass() {
  vkCmdEndRendering(commands_);
  if (queries_ != nullptr) queries_->end(commands_, passes_);
  ++passes_;
  const Target& target = targets_[bound_.target];
  transition(commands_, target.color.image, VK_IMAGE_ASPECT_COLOR_BIT,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  if (target.depth.image != VK_NULL_HANDLE)
    transition(commands_, target.depth.image, VK_IMAGE_ASPECT_DEPTH_BIT,
               VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

void VulkanFrame::draw(const traces::Draw& draw) {
  const PipelineObjects& objects = pipeline_for(bound_);
  vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, objects.pipeline);
  for (std::uint32_t set = 0; set < bound_.sets.size(); ++set) {
    if (bound_.sets[set] == traces::kNone) continue;
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, objects.layout, set, 1,
                            &descriptor_sets_[bound_.sets[set]], 0, nullptr);
  }
  if (!bound_.push_constants.empty())
    vkCmdPushConstants(commands_, objects.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                       0, static_cast<std::uint32_t>(bound_.push_constants.size()),
                       bound_.push_constants.data());
  if (draw.indexed)
    vkCmdDrawIndexed(commands_, draw.count, draw.instances, draw.first, draw.vertex_offset,
                     draw.first_instance);
  else vkCmdDraw(commands_, draw.count, draw.instances, draw.first, draw.first_instance);
}

Rendered VulkanFrame::read_back() const {
  const traces::RenderTarget& source = stream_.targets[bound_.target];
  const Target& target = targets_[bound_.target];
  const std::size_t pixels = std::size_t{source.width} * source.height;
  Cleanup scratch;
  const HostBuffer color = device_.buffer(scratch, 4 * pixels, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const HostBuffer depth = device_.buffer(scratch, 4 * pixels, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const bool has_depth = target.depth.image != VK_NULL_HANDLE;
  const VkCommandBuffer commands = device_.begin_commands(scratch);
  VkBufferImageCopy copy{};
  copy.imageExtent = {source.width, source.height, 1};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  vkCmdCopyImageToBuffer(commands, target.color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, color.buffer, 1,
                         &copy);
  copy.imageSubresource.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
  if (has_depth)
    vkCmdCopyImageToBuffer(commands, target.depth.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, depth.buffer,
                           1, &copy);
  require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  device_.submit(commands);

  Rendered result;
  result.width = source.width;
  result.height = source.height;
  result.color.resize(pixels);
  std::memcpy(result.color.data(), color.mapped, 4 * pixels);
  result.depth.resize(has_depth ? pixels : 0);
  if (has_depth) std::memcpy(result.depth.data(), depth.mapped, 4 * pixels);
  return result;
}

}  // namespace quadrille::lavapipe
