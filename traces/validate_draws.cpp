/// The command half of `validate`: pass nesting, bound state, and every byte that a draw would fetch, found
/// by scanning the indices it uses.
#include "traces/validate_draws.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "models/base/error.h"
#include "models/rop/blend.h"
#include "traces/attachment_texels.h"

namespace quadrille::traces {
namespace {

constexpr float kMaxViewportSide = 16384;
// [VK1.3 #limits-required: viewportBoundsRange]
constexpr float kViewportBounds = 32768;
// of a whole stream: a bound on the work that one file can ask for
constexpr std::uint64_t kMaxVertexReferences = std::uint64_t{1} << 32;

std::uint32_t index_bytes(IndexType type) {
  return type == IndexType::kUint8 ? 1 : type == IndexType::kUint16 ? 2 : 4;
}

/// Smallest and greatest index; the first exceeds the second if there is none. With `restarts`, that of all
/// ones is not counted.
template <class T>
std::pair<std::uint32_t, std::uint32_t> scan(const std::byte* data, std::uint32_t count, bool restarts) {
  constexpr T kSpecial = std::numeric_limits<T>::max();
  std::uint32_t low = 0xffffffffu, high = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, data + std::size_t{i} * sizeof(T), sizeof(T));
    if (restarts && value == kSpecial) continue;
    low = std::min<std::uint32_t>(low, value);
    high = std::max<std::uint32_t>(high, value);
  }
  return {low, high};
}

bool within(float value, float low, float high) { return value >= low && value <= high; }  // false on NaN

}  // namespace

void CommandWalk::run() {
  for_each_begun_part(stream_, [this](const ImagePart& part) { stored_.insert(part); });
  for (at_ = 0; at_ < stream_.commands.size(); ++at_) {
    std::visit([this](const auto& command) { visit(command); }, stream_.commands[at_]);
  }
  if (pass_ != nullptr) throw user_error("commands: the last render pass is not ended");
  queries_.finish();
  if (passes_ == 0) throw user_error("commands: there is no render pass");
  if (!last_->colors.empty() && last_->colors[0].resolve == kNone &&
      stream_.images[last_->colors[0].image].samples > 1)
    throw user_error("commands: the last render pass resolves the samples of its first colours nowhere");
  if (last_->colors.empty()) throw user_error("commands: the last render pass has no colours to show");
}

void CommandWalk::check_exists(std::uint32_t image, const char* what) const {
  if (image >= stream_.images.size())
    throw user_error("command {}: {}: image {} does not exist", at_, what, image);
}

/// Of a pass whose images exist.
void CommandWalk::check_attachment(const AttachmentUse& use, ImageUsage usage, const char* what) {
  const Image& image = stream_.images[use.image];
  if ((image.usage & usage) == 0)
    throw user_error("command {}: {}: image {} '{}' is not for that use", at_, what, use.image, image.name);
  check_part(use.part(), what);
  const std::uint32_t width = level_width(image, use.level), height = level_height(image, use.level);
  if (width != target_.width || height != target_.height)
    throw user_error("command {}: {}: image {} of {}x{} beside one of {}x{}", at_, what, use.image, width,
                     height, target_.width, target_.height);
  if (image.samples != samples_)
    throw user_error("command {}: {}: image {} of {} samples a pixel beside one of {}", at_, what, use.image,
                     image.samples, samples_);
  if (use.load == LoadOp::kLoad && !stored_.contains(use.part()))
    throw user_error("command {}: {}: image {} is loaded before a pass has stored it", at_, what, use.image);
}

/// Notes a level of a layer as one that the pass draws to.
void CommandWalk::check_part(const ImagePart& part, const char* what) {
  const Image& image = stream_.images[part.image];
  if (part.level >= image.levels || part.layer >= image.layers)
    throw user_error(
        "command {}: {}: level {} of layer {} of image {} '{}', which has {} levels and {} layers", at_, what,
        part.level, part.layer, part.image, image.name, image.levels, image.layers);
  if (!attached_.insert(part).second)
    throw user_error("command {}: {}: image {} is attached twice", at_, what, part.image);
}

void CommandWalk::check_resolve(const ColorAttachmentUse& color) {
  constexpr const char* kWhat = "resolve attachment";
  const Image &from = stream_.images[color.image], &to = stream_.images[color.resolve];
  if ((to.usage & kColorAttachment) == 0 || to.samples != 1 || from.samples == 1)
    throw user_error(
        "command {}: {}: several samples a pixel are resolved to a colour attachment of one; "
        "images {} and {} have {} and {}",
        at_, kWhat, color.image, color.resolve, from.samples, to.samples);
  check_part(color.resolve_part(), kWhat);
  if (level_width(to, color.resolve_level) != target_.width ||
      level_height(to, color.resolve_level) != target_.height || to.format != from.format)
    throw user_error("command {}: {}: images {} and {} differ in size or format", at_, kWhat, color.image,
                     color.resolve);
}

void CommandWalk::check_transparency(const BeginPass& pass) const {
  const auto [mode, layers] = pass.transparency;
  if (mode != Transparency::kNone && pass.colors.size() != 1)
    throw user_error(
        "command {}: a pass with {} colour attachments keeps fragments of order-independent "
        "draws; it has to have one",
        at_, pass.colors.size());
  if (const int most = models::most_layers(mode); layers > most || (layers == 0 && most > 0))
    throw user_error("command {}: {} fragments a pixel are kept; {}..{} are possible", at_, layers,
                     std::min(1, most), most);
}

void CommandWalk::visit(const BeginPass& c) {
  if (pass_ != nullptr) throw user_error("command {}: a render pass begins inside another", at_);
  if (c.colors.size() > kMaxColorAttachments)
    throw user_error("command {}: {} colour attachments; at most {} are possible", at_, c.colors.size(),
                     kMaxColorAttachments);
  if (c.first_image() == kNone) throw user_error("command {}: a render pass without attachments", at_);
  for (const ColorAttachmentUse& color : c.colors) {
    check_exists(color.image, "colour attachment");
    if (color.resolve != kNone) check_exists(color.resolve, "resolve attachment");
  }
  if (c.depth.image != kNone) check_exists(c.depth.image, "depth attachment");
  target_ = target_of(stream_, c);
  samples_ = stream_.images[c.first_image()].samples;
  attached_.clear();
  for (const ColorAttachmentUse& color : c.colors) {
    check_attachment(color, kColorAttachment, "colour attachment");
    if (!std::ranges::all_of(color.clear, [](float v) { return std::isfinite(v); }))
      throw user_error("command {}: the clear colour is not finite", at_);
    const Format format = stream_.images[color.image].format;
    if (color.load == LoadOp::kClear && is_integer_format(format) &&
        !models::holds_integers(format, color.clear_integers))
      throw user_error("command {}: the clear value has integers that {} does not hold", at_,
                       models::format_info(format).name);
  }
  for (const ColorAttachmentUse& color : c.colors)
    if (color.resolve != kNone) check_resolve(color);
  if (c.depth.image != kNone) check_attachment(c.depth, kDepthAttachment, "depth attachment");
  if (!within(c.depth.clear, 0, 1))
    throw user_error("command {}: clear depth {} is outside 0..1", at_, c.depth.clear);
  check_transparency(c);
  drew_any_order_ = false;
  pass_ = last_ = &c;
  ++passes_;
}

void CommandWalk::visit(const EndPass&) {
  if (pass_ == nullptr) throw user_error("command {}: a render pass ends that has not begun", at_);
  queries_.end_pass(at_);
  const auto leave = [this](const AttachmentUse& use) {
    if (use.store == StoreOp::kStore) stored_.insert(use.part());
    else stored_.erase(use.part());
  };
  for (const ColorAttachmentUse& color : pass_->colors) {
    leave(color);
    if (color.resolve != kNone) stored_.insert(color.resolve_part());
  }
  if (pass_->depth.image != kNone) leave(pass_->depth);
  pass_ = nullptr;
}

void CommandWalk::visit(const BindPipeline& c) {
  if (c.pipeline >= stream_.pipelines.size())
    throw user_error("command {}: pipeline {} does not exist", at_, c.pipeline);
  pipeline_ = c.pipeline;
}

void CommandWalk::visit(const BindDescriptorSet& c) {
  if (c.set >= kMaxDescriptorSets)
    throw user_error("command {}: descriptor set number {} is outside 0..3", at_, c.set);
  if (c.descriptors >= stream_.descriptor_sets.size())
    throw user_error("command {}: descriptor set {} does not exist", at_, c.descriptors);
}

void CommandWalk::visit(const BindVertexBuffer& c) {
  if (c.binding >= kMaxVertexBindings)
    throw user_error("command {}: vertex binding {} is outside 0..15", at_, c.binding);
  if (c.buffer >= stream_.buffers.size())
    throw user_error("command {}: buffer {} does not exist", at_, c.buffer);
  const std::uint64_t size = stream_.buffers[c.buffer].data.size();
  if (c.offset > size)
    throw user_error("command {}: offset {} is beyond buffer {} of {} bytes", at_, c.offset, c.buffer, size);
  vertex_streams_[c.binding] = {c.buffer, c.offset};
}

void CommandWalk::visit(const BindIndexBuffer& c) {
  if (c.buffer >= stream_.buffers.size())
    throw user_error("command {}: index buffer {} does not exist", at_, c.buffer);
  const std::uint64_t size = stream_.buffers[c.buffer].data.size();
  if (c.offset > size)
    throw user_error("command {}: offset {} is beyond index buffer {} of {} bytes", at_, c.offset, c.buffer,
                     size);
  if (c.offset % index_bytes(c.type) != 0)
    throw user_error("command {}: index offset {} is not a multiple of {} bytes", at_, c.offset,
                     index_bytes(c.type));
  indices_ = c;
}

void CommandWalk::visit(const PushConstants& c) {
  if (c.data.empty() || c.data.size() % 4 != 0 || c.offset % 4 != 0 ||
      c.data.size() > kMaxPushConstantBytes || c.offset > kMaxPushConstantBytes - c.data.size()) {
    throw user_error("command {}: push constants of bytes {}+{}; they are whole words within {} bytes", at_,
                     c.offset, c.data.size(), kMaxPushConstantBytes);
  }
}

void CommandWalk::visit(const SetViewport& c) {
  const bool place =
      within(c.x, -kViewportBounds, kViewportBounds) && within(c.y, -kViewportBounds, kViewportBounds);
  const bool size = c.width > 0 && c.width <= kMaxViewportSide && c.height != 0 &&
                    within(c.height, -kMaxViewportSide, kMaxViewportSide);
  if (!place || !size || !within(c.x + c.width, -kViewportBounds, kViewportBounds) ||
      !within(c.y + c.height, -kViewportBounds, kViewportBounds)) {
    throw user_error("command {}: viewport {},{} {}x{} is not within {} pixels, or empty", at_, c.x, c.y,
                     c.width, c.height, kMaxViewportSide);
  }
  if (!within(c.min_depth, 0, 1) || !within(c.max_depth, 0, 1))
    throw user_error("command {}: viewport depth {}..{} is outside 0..1", at_, c.min_depth, c.max_depth);
  check_index(c.index, "viewport");
  viewports_[c.index] = true;
}

void CommandWalk::check_index(std::uint32_t index, const char* what) const {
  if (index >= models::kMaxViewports)
    throw user_error("command {}: {} {} is set; there are {}", at_, what, index, models::kMaxViewports);
}

void CommandWalk::visit(const SetScissor& c) {
  if (c.x < 0 || c.y < 0) throw user_error("command {}: scissor corner {},{} is negative", at_, c.x, c.y);
  check_index(c.index, "scissor");
  scissors_[c.index] = c;
}

void CommandWalk::check_scissor(const SetScissor& scissor) const {
  const std::uint64_t right = static_cast<std::uint64_t>(scissor.x) + scissor.width;
  const std::uint64_t bottom = static_cast<std::uint64_t>(scissor.y) + scissor.height;
  if (right > target_.width || bottom > target_.height) {
    throw user_error("command {}: draw with scissor {},{} {}x{} outside the target of {}x{}", at_, scissor.x,
                     scissor.y, scissor.width, scissor.height, target_.width, target_.height);
  }
}

void CommandWalk::check_draw_state() const {
  if (pass_ == nullptr) throw user_error("command {}: draw outside a render pass", at_);
  if (pipeline_ == kNone) throw user_error("command {}: draw without a pipeline", at_);
  for (std::uint32_t i = 0; i < stream_.pipelines[pipeline_].viewports; ++i) {
    const std::string number = i == 0 ? std::string() : fmt::format(" {}", i);
    if (!viewports_[i]) throw user_error("command {}: draw without a viewport{}", at_, number);
    if (!scissors_[i]) throw user_error("command {}: draw without a scissor{}", at_, number);
    check_scissor(*scissors_[i]);
  }
  const DepthState& depth = stream_.pipelines[pipeline_].depth;
  if ((depth.test || depth.write) && pass_->depth.image == kNone) {
    throw user_error("command {}: draw with depth test or write into a target without depth", at_);
  }
  check_integers();
}

/// [VK1.3 #framebuffer-blending, #fragops-covg]
void CommandWalk::check_integers() const {
  const Pipeline& pipeline = stream_.pipelines[pipeline_];
  for (std::size_t i = 0; i < pass_->colors.size(); ++i) {
    const Format format = stream_.images[pass_->colors[i].image].format;
    if (models::format_info(format).may(models::kBlendUse)) continue;
    const std::string_view name = models::format_info(format).name;
    if (pipeline.blend[i].enable)
      throw user_error("command {}: draw blends colour attachment {}, but {} holds integers", at_, i, name);
    if (i == 0 && pipeline.alpha_to_coverage)
      throw user_error("command {}: draw with alpha to coverage, but colour attachment 0 holds integers ({})",
                       at_, name);
  }
}

void CommandWalk::check_draw_order() {
  const Pipeline& pipeline = stream_.pipelines[pipeline_];
  if (pipeline.order_independent) {
    if (pass_->transparency.mode == Transparency::kNone)
      throw user_error("command {}: order-independent draw in a pass that keeps no fragments", at_);
    drew_any_order_ = true;
    return;
  }
  const bool writes = pipeline.depth.write || pipeline.blend[0].write_mask != 0;
  if (drew_any_order_ && writes)
    throw user_error("command {}: draw that writes depths or colours behind an order-independent one", at_);
}

void CommandWalk::count_vertices(const Draw& draw) {
  // Both factors are below 2^32, so the product fits.
  const std::uint64_t vertices = std::uint64_t{draw.count} * draw.instances;
  if (vertices > kMaxVertexReferences - vertices_)
    throw user_error("command {}: the stream draws more than {} vertices", at_, kMaxVertexReferences);
  vertices_ += vertices;
}

std::pair<std::uint32_t, std::uint32_t> CommandWalk::index_range(const Draw& draw) {
  if (indices_.buffer == kNone) throw user_error("command {}: indexed draw without an index buffer", at_);
  const std::vector<std::byte>& data = stream_.buffers[indices_.buffer].data;
  const std::uint64_t size = index_bytes(indices_.type);
  const std::uint64_t begin = indices_.offset + draw.first * size;
  const std::uint64_t bytes = draw.count * size;
  if (begin > data.size() || bytes > data.size() - begin) {
    throw user_error("command {}: indices {}+{} reach beyond index buffer {} of {} bytes", at_, draw.first,
                     draw.count, indices_.buffer, data.size());
  }
  const bool restarts = stream_.pipelines[pipeline_].primitive_restart;
  const auto [entry, added] =
      index_ranges_.try_emplace({indices_.buffer, begin, indices_.type, draw.count, restarts});
  if (added) {
    const std::byte* source = data.data() + begin;
    switch (indices_.type) {
      case IndexType::kUint8: entry->second = scan<std::uint8_t>(source, draw.count, restarts); break;
      case IndexType::kUint16: entry->second = scan<std::uint16_t>(source, draw.count, restarts); break;
      case IndexType::kUint32: entry->second = scan<std::uint32_t>(source, draw.count, restarts); break;
    }
  }
  return entry->second;
}

std::optional<CommandWalk::VertexRange> CommandWalk::vertex_range(const Draw& draw) {
  if (!draw.indexed) {
    const std::uint64_t last = std::uint64_t{draw.first} + draw.count - 1;
    if (last > 0xffffffffu) throw user_error("command {}: vertex number {} does not fit 32 bits", at_, last);
    return VertexRange{draw.first, last};
  }
  const auto [low, high] = index_range(draw);
  if (low > high) return std::nullopt;
  const std::int64_t first = std::int64_t{low} + draw.vertex_offset,
                     last = std::int64_t{high} + draw.vertex_offset;
  if (first < 0 || last > 0xffffffff)
    throw user_error("command {}: vertices {}..{} (index plus offset) do not fit 32 bits", at_, first, last);
  return VertexRange{static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last)};
}

void CommandWalk::check_attribute(const Pipeline& pipeline, const VertexAttribute& attribute,
                                  VertexRange vertices, VertexRange instances) const {
  const auto binding = std::ranges::find(pipeline.bindings, attribute.binding, &VertexBinding::binding);
  const VertexStream& source = vertex_streams_[attribute.binding];
  if (source.buffer == kNone)
    throw user_error("command {}: draw without a vertex buffer at binding {}", at_, attribute.binding);
  const std::uint64_t last = binding->per_instance ? instances.last : vertices.last;
  const std::uint64_t size = stream_.buffers[source.buffer].data.size();
  const std::uint64_t end =
      source.offset + last * binding->stride + attribute.offset + format_bytes(attribute.format);
  if (end > size) {
    throw user_error("command {}: {} {} at location {} ends at byte {} of buffer {}, which has {}", at_,
                     binding->per_instance ? "instance" : "vertex", last, attribute.location, end,
                     source.buffer, size);
  }
}

void CommandWalk::visit(const Draw& c) {
  check_draw_state();
  check_draw_order();
  if (c.count == 0 || c.instances == 0) return;
  count_vertices(c);
  const std::optional<VertexRange> vertices = vertex_range(c);
  if (!vertices) return;
  const VertexRange instances{c.first_instance, std::uint64_t{c.first_instance} + c.instances - 1};
  if (instances.last > 0xffffffffu)
    throw user_error("command {}: instance number {} does not fit 32 bits", at_, instances.last);
  const Pipeline& pipeline = stream_.pipelines[pipeline_];
  for (const VertexAttribute& attribute : pipeline.attributes)
    check_attribute(pipeline, attribute, *vertices, instances);
}

}  // namespace quadrille::traces
