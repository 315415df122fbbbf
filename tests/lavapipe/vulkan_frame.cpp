/// Recording of a stream: attachments, passes, state and draws, and reading the attachments back.
#include "tests/lavapipe/vulkan_frame.h"

#include <algorithm>
#include <cstring>

#include "models/base/error.h"
#include "models/rop/blend.h"
#include "models/rop/depth_plane.h"
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

/// Makes what programs wrote to buffers visible to everything after.
void finish_writes(VkCommandBuffer commands) {
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1,
                       &barrier, 0, nullptr, 0, nullptr);
}

VkAttachmentLoadOp vk_load(traces::LoadOp op) {
  switch (op) {
    case traces::LoadOp::kClear: return VK_ATTACHMENT_LOAD_OP_CLEAR;
    case traces::LoadOp::kLoad: return VK_ATTACHMENT_LOAD_OP_LOAD;
    case traces::LoadOp::kDontCare: return VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  }
  return VK_ATTACHMENT_LOAD_OP_CLEAR;
}

/// What shows the colours, or what they are resolved to.
traces::Index shown(const traces::ColorAttachmentUse& color) {
  return color.resolve == traces::kNone ? color.image : color.resolve;
}

VkImageUsageFlags usage_of(const traces::Image& image) {
  VkImageUsageFlags usage =
      image.is_attachment() ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if ((image.usage & traces::kSampled) != 0) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  if ((image.usage & traces::kColorAttachment) != 0) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if ((image.usage & traces::kDepthAttachment) != 0) usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  return usage;
}

}  // namespace

VulkanFrame::VulkanFrame(const VulkanDevice& device, const traces::CommandStream& stream,
                         const PassQueries* queries)
    : device_(device), stream_(stream), queries_(queries), stream_queries_(device, stream) {
  upload_buffers();
  upload_images();
  create_samplers();
  create_descriptor_sets();
  record();
}

void VulkanFrame::upload_buffers() {
  for (const traces::Buffer& source : stream_.buffers)
    buffers_.push_back(
        device_.device_buffer(cleanup_, source.data,
                              VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                  VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
}

void VulkanFrame::upload_images() {
  for (const traces::Image& source : stream_.images) {
    Image image;
    if ((source.usage & traces::kDepthAttachment) != 0) image.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    image.all_aspects = image.aspect;
    if (models::has_stencil(source.format)) image.all_aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
    image.device = device_.image(cleanup_, vk_format(source.format), {source.width, source.height},
                                 source.levels, usage_of(source), image.aspect, source.samples);
    if (!source.is_attachment()) upload_texels(source, image.device);
    images_.push_back(image);
  }
}

void VulkanFrame::upload_texels(const traces::Image& source, const DeviceImage& image) {
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

void VulkanFrame::record() {
  commands_ = device_.begin_commands(cleanup_);
  if (queries_ != nullptr) queries_->reset(commands_);
  else stream_queries_.reset(commands_);
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
      [this](const traces::Draw& c) { draw(c); },
      [this](const traces::BeginQuery& c) {
        if (queries_ == nullptr) stream_queries_.begin(commands_, c);
      },
      [this](const traces::EndQuery& c) {
        if (queries_ == nullptr) stream_queries_.end(commands_, c);
      }};
  for (const traces::Command& command : stream_.commands) std::visit(record_one, command);
  for (const traces::ColorAttachmentUse& color : bound_.pass->colors)
    move(shown(color), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  if (bound_.pass->depth.image != traces::kNone)
    move(bound_.pass->depth.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  require(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

void VulkanFrame::move(traces::Index index, VkImageLayout layout) {
  Image& image = images_[index];
  transition(commands_, image.device.image, image.all_aspects, image.layout, layout);
  image.layout = layout;
}

VkRenderingAttachmentInfo VulkanFrame::attach(const traces::AttachmentUse& use, VkImageLayout layout,
                                              const VkClearValue& clear) {
  // What it held is forgotten, also what an earlier submission left.
  if (use.load != traces::LoadOp::kLoad) images_[use.image].layout = VK_IMAGE_LAYOUT_UNDEFINED;
  move(use.image, layout);
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = images_[use.image].device.view;
  info.imageLayout = layout;
  info.loadOp = vk_load(use.load);
  info.storeOp =
      use.store == traces::StoreOp::kStore ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
  info.clearValue = clear;
  return info;
}

void VulkanFrame::begin_pass(const traces::BeginPass& pass) {
  bound_.pass = &pass;
  const traces::PassTarget target = traces::target_of(stream_, pass);
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const traces::ColorAttachmentUse& use : pass.colors) {
    VkClearValue clear{};
    const bool integers = traces::is_integer_format(stream_.images[use.image].format);
    if (integers) std::copy(use.clear_integers.begin(), use.clear_integers.end(), clear.color.uint32);
    else std::copy(use.clear.begin(), use.clear.end(), clear.color.float32);
    colors.push_back(attach(use, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, clear));
    if (use.resolve == traces::kNone) continue;
    images_[use.resolve].layout = VK_IMAGE_LAYOUT_UNDEFINED;
    move(use.resolve, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    colors.back().resolveMode = integers ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_AVERAGE_BIT;
    colors.back().resolveImageView = images_[use.resolve].device.view;
    colors.back().resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  }
  VkRenderingAttachmentInfo depth{};
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea.extent = {target.width, target.height};
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  if (pass.depth.image != traces::kNone) {
    VkClearValue clear{};
    clear.depthStencil = {pass.depth.clear, pass.depth.clear_stencil};
    const bool stencil = models::has_stencil(stream_.images[pass.depth.image].format);
    depth = attach(
        pass.depth,
        stencil ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
        clear);
    info.pDepthAttachment = &depth;
    if (stencil) info.pStencilAttachment = &depth;
  }
  if (queries_ != nullptr) queries_->begin(commands_, passes_);
  vkCmdBeginRendering(commands_, &info);
}

void VulkanFrame::end_pass() {
  vkCmdEndRendering(commands_);
  finish_writes(commands_);
  if (queries_ != nullptr) queries_->end(commands_, passes_);
  ++passes_;
  const auto make_readable = [this](traces::Index image) {
    if ((stream_.images[image].usage & traces::kSampled) != 0)
      move(image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  };
  for (const traces::ColorAttachmentUse& use : bound_.pass->colors) {
    make_readable(use.image);
    if (use.resolve != traces::kNone) make_readable(use.resolve);
  }
  if (bound_.pass->depth.image != traces::kNone) make_readable(bound_.pass->depth.image);
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

std::vector<models::PixelCode> VulkanFrame::read_target(traces::Index index) const {
  const traces::Image& image = stream_.images[index];
  const std::size_t pixel_bytes = models::format_bytes(image.format);
  std::vector<models::PixelCode> codes(std::size_t{image.width} * image.height);
  Cleanup scratch;
  const HostBuffer copied = copy_image(scratch, index, pixel_bytes);
  for (std::size_t i = 0; i < codes.size(); ++i)
    std::memcpy(codes[i].word.data(), static_cast<const std::byte*>(copied.mapped) + pixel_bytes * i,
                pixel_bytes);
  return codes;
}

HostBuffer VulkanFrame::copy_image(Cleanup& cleanup, traces::Index index, std::size_t pixel_bytes) const {
  const traces::Image& source = stream_.images[index];
  const HostBuffer target =
      device_.buffer(cleanup, pixel_bytes * source.width * source.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const VkCommandBuffer commands = device_.begin_commands(cleanup);
  VkBufferImageCopy copy{};
  copy.imageExtent = {source.width, source.height, 1};
  copy.imageSubresource = {images_[index].aspect, 0, 0, 1};
  vkCmdCopyImageToBuffer(commands, images_[index].device.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         target.buffer, 1, &copy);
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
  const traces::Index depth = bound_.pass->depth.image;
  if (depth != traces::kNone && stream_.images[depth].samples == 1) {
    Cleanup scratch;
    result.depth.resize(result.color.size());
    read_depths(stream_.images[depth].format, copy_image(scratch, depth, 4), result.depth);
  }
  read_back_buffers(result);
  if (queries_ == nullptr) result.queries = stream_queries_.results();
  return result;
}

}  // namespace quadrille::lavapipe
