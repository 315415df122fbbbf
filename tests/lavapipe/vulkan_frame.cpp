/// Recording of a stream: attachments, passes, state and draws, and reading the attachments back.
#include "tests/lavapipe/vulkan_frame.h"

#include <algorithm>
#include <cstring>

#include "models/base/error.h"
#include "models/base/format.h"
#include "tests/lavapipe/vulkan_enums.h"
#include "traces/attachment_texels.h"

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
void transition(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = range;
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

/// Lavapipe resolves at the end of a pass to level 0 of layer 0, whatever the view says: not so a command.
bool resolves_after(const traces::ColorAttachmentUse& use) {
  return use.resolve != traces::kNone && (use.resolve_level > 0 || use.resolve_layer > 0);
}

bool may_be_cube(const traces::Image& image) {
  return image.kind == traces::ImageKind::k2D && image.width == image.height &&
         image.layers >= models::kCubeFaces && image.samples == 1;
}

VkImageUsageFlags usage_of(const traces::Image& image) {
  VkImageUsageFlags usage =
      image.is_attachment() ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (image.levels > 1 || image.layers > 1 || traces::begins_with_texels(image))
    usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
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
    image.image = device_.image(cleanup_, {.format = vk_format(source.format),
                                           .size = {source.width, source.height},
                                           .levels = source.levels,
                                           .layers = source.layers,
                                           .samples = source.samples,
                                           .usage = usage_of(source),
                                           .type = vk_image_type(source.kind),
                                           .depth = source.depth,
                                           .may_be_cube = may_be_cube(source)});
    if (!source.is_attachment()) upload_texels(source, image);
    images_.push_back(image);
    if (traces::begins_with_texels(source)) hold_texels(static_cast<traces::Index>(images_.size() - 1));
  }
}

VulkanFrame::Seen VulkanFrame::attached(const traces::ImagePart& part) const {
  const bool line = stream_.images[part.image].kind == traces::ImageKind::k1D;
  return {part, 1, line ? traces::ViewKind::k1D : traces::ViewKind::k2D};
}

VkImageView VulkanFrame::view_of(const Seen& seen) {
  VkImageView& view = views_[seen];
  const auto& [finest, levels, kind, layers, components] = seen;
  const Image& image = images_[finest.image];
  if (view == VK_NULL_HANDLE)
    view = device_.view(cleanup_, image.image, vk_format(stream_.images[finest.image].format),
                        vk_view_type(kind), {image.aspect, finest.level, levels, finest.layer, layers},
                        vk_components(components));
  return view;
}

void VulkanFrame::upload_texels(const traces::Image& source, const Image& image) {
  Cleanup upload;
  // Each level begins at a multiple of 16 bytes, which is one of any format's texels.
  const auto padded = [](std::uint64_t bytes) { return (bytes + 15) / 16 * 16; };
  std::uint64_t bytes = 0;
  for (std::uint32_t level = 0; level < source.levels; ++level)
    bytes += padded(traces::level_bytes(source, level) * source.layers);
  const HostBuffer staging = device_.buffer(upload, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  std::vector<VkBufferImageCopy> levels;
  VkDeviceSize offset = 0;
  const std::byte* texels = source.texels.data();
  for (std::uint32_t level = 0; level < source.levels; ++level) {
    const std::uint64_t size = traces::level_bytes(source, level) * source.layers;
    std::memcpy(static_cast<std::byte*>(staging.mapped) + offset, texels, size);
    VkBufferImageCopy copy{};
    copy.bufferOffset = offset;
    copy.imageSubresource = {image.aspect, level, 0, source.layers};
    copy.imageExtent = {traces::level_width(source, level), traces::level_height(source, level),
                        traces::level_depth(source, level)};
    levels.push_back(copy);
    texels += size;
    offset += padded(size);
  }
  const VkCommandBuffer commands = device_.begin_commands(upload);
  const VkImageSubresourceRange all{image.all_aspects, 0, VK_REMAINING_MIP_LEVELS, 0,
                                    VK_REMAINING_ARRAY_LAYERS};
  transition(commands, image.image, all, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  vkCmdCopyBufferToImage(commands, staging.buffer, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         static_cast<std::uint32_t>(levels.size()), levels.data());
  transition(commands, image.image, all, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  device_.submit(commands);
}

VkSampler VulkanFrame::sampler_of(const SamplerKey& key) {
  VkSampler& sampler = samplers_[key];
  if (sampler != VK_NULL_HANDLE) return sampler;
  const traces::Sampler& source = stream_.samplers[key.first];
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = vk_filter(source.mag);
  info.minFilter = vk_filter(source.min);
  info.mipmapMode = vk_mip_mode(source.mip);
  info.addressModeU = vk_wrap(source.wrap_u);
  info.addressModeV = vk_wrap(source.wrap_v);
  info.addressModeW = vk_wrap(source.wrap_w);
  info.compareEnable = source.compare != models::CompareOp::kNever ? VK_TRUE : VK_FALSE;
  info.compareOp = vk_compare(source.compare);
  info.anisotropyEnable = models::is_anisotropic(source) ? VK_TRUE : VK_FALSE;
  info.maxAnisotropy = source.max_anisotropy;
  info.borderColor = vk_border(source.border, key.second);
  VkSamplerCustomBorderColorCreateInfoEXT own{};
  own.sType = VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT;
  std::memcpy(&own.customBorderColor, source.border_bits.data(), sizeof own.customBorderColor);
  if (source.border == models::BorderColor::kOwn) {
    if (!device_.info().own_borders) throw user_error("{}: no borders of any colour", device_.info().name);
    info.pNext = &own;
  }
  info.mipLodBias = source.lod_bias;
  info.minLod = source.min_lod;
  info.maxLod = source.max_lod;
  require(vkCreateSampler(device_.handle(), &info, nullptr, &sampler), "vkCreateSampler");
  cleanup_.add([this, made = sampler] { vkDestroySampler(device_.handle(), made, nullptr); });
  return sampler;
}

void VulkanFrame::record() {
  commands_ = device_.begin_commands(cleanup_);
  for (const auto& [index, held] : held_) bring_texels(index, held);
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
        vkCmdSetViewport(commands, c.index, 1, &viewport);
      },
      [commands](const traces::SetScissor& c) {
        const VkRect2D scissor{{c.x, c.y}, {c.width, c.height}};
        vkCmdSetScissor(commands, c.index, 1, &scissor);
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
    move(bound_.pass->depth.part(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  require(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

void VulkanFrame::move(const traces::ImagePart& part, VkImageLayout layout) {
  const Image& image = images_[part.image];
  VkImageLayout& now = layouts_[part];  // VK_IMAGE_LAYOUT_UNDEFINED at first
  transition(commands_, image.image, {image.all_aspects, part.level, 1, part.layer, 1}, now, layout);
  now = layout;
}

VkRenderingAttachmentInfo VulkanFrame::attach(const traces::AttachmentUse& use, VkImageLayout layout,
                                              const VkClearValue& clear) {
  // What it held is forgotten, also what an earlier submission left.
  if (use.load != traces::LoadOp::kLoad) layouts_[use.part()] = VK_IMAGE_LAYOUT_UNDEFINED;
  move(use.part(), layout);
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = view_of(attached(use.part()));
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
    if (resolves_after(use)) colors.back().storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    if (use.resolve == traces::kNone || resolves_after(use)) continue;
    layouts_[use.resolve_part()] = VK_IMAGE_LAYOUT_UNDEFINED;
    move(use.resolve_part(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    colors.back().resolveMode = integers ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_AVERAGE_BIT;
    colors.back().resolveImageView = view_of(attached(use.resolve_part()));
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
  const auto make_readable = [this](const traces::ImagePart& part) {
    if ((stream_.images[part.image].usage & traces::kSampled) != 0)
      move(part, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  };
  for (const traces::ColorAttachmentUse& use : bound_.pass->colors) {
    if (resolves_after(use)) resolve(use);
    make_readable(use.part());
    if (use.resolve != traces::kNone) make_readable(use.resolve_part());
  }
  if (bound_.pass->depth.image != traces::kNone) make_readable(bound_.pass->depth.part());
}

void VulkanFrame::resolve(const traces::ColorAttachmentUse& use) {
  const traces::ImagePart to = use.resolve_part();
  const traces::Image& image = stream_.images[to.image];
  layouts_[to] = VK_IMAGE_LAYOUT_UNDEFINED;
  move(use.part(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  move(to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  VkImageResolve region{};
  region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, use.level, use.layer, 1};
  region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, to.level, to.layer, 1};
  region.extent = {traces::level_width(image, to.level), traces::level_height(image, to.level), 1};
  vkCmdResolveImage(commands_, images_[use.image].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                    images_[to.image].image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
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

}  // namespace quadrille::lavapipe
