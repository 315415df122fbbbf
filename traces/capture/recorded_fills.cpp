/// Clears and blits in the middle of a frame, as draws of a triangle over their area.
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"
#include "traces/capture/own_shaders.h"
#include "traces/capture/texels.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

/// Of a blit: its corners in either order.
struct Span {
  float begin = 0, size = 0;
};
/// Of one level of one layer.
ViewObject view_of_part(Handle handle, const ImageObject& image, std::uint32_t level, std::uint32_t layer) {
  if (level >= image.levels || layer >= image.layers)
    throw user_error("level {} of layer {} of an image that has {} and {}", level, layer, image.levels,
                     image.layers);
  ViewObject view;
  view.image = handle;
  view.type = image.type == VK_IMAGE_TYPE_1D ? VK_IMAGE_VIEW_TYPE_1D : VK_IMAGE_VIEW_TYPE_2D;
  view.format = image.format;
  view.aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  view.level = level;
  view.layer = layer;
  return view;
}

traces::Sampler copying_sampler(traces::Filter filter) {
  traces::Sampler sampler;
  sampler.mag = sampler.min = filter;
  sampler.mip = traces::Filter::kNearest;
  sampler.wrap_u = sampler.wrap_v = traces::Wrap::kClampToEdge;
  return sampler;
}

Span span_of(const Value& offsets, std::string_view axis) {
  const auto a = static_cast<float>(offsets.at(0)[axis].i32()),
             b = static_cast<float>(offsets.at(1)[axis].i32());
  return {a, b - a};
}

}  // namespace

void FrameRecorder::fill(traces::Pipeline pipeline, const Fill& what, const AreaConstants& constants,
                         const Area& area, const char* label) {
  if (area.width == 0 || area.height == 0) return;
  pipeline.name = label;
  pipeline.vertex_shader = tables_.own(OwnShader::kArea);
  pipeline.fragment_shader = tables_.own(what.shader, what.attachment);
  for (std::size_t i = 0; i < pipeline.blend.size(); ++i)
    if (!what.colors || i != what.attachment) pipeline.blend[i].write_mask = 0;
  emit_change(0, traces::BindPipeline{tables_.pipeline(pipeline)});
  RasterState window;
  window.viewports = {{static_cast<float>(area.x), static_cast<float>(area.y), static_cast<float>(area.width),
                       static_cast<float>(area.height), 0, 1, 0}};
  window.scissors = {{area.x, area.y, area.width, area.height, 0}};
  emit_window(window);
  traces::PushConstants push;
  push.data.resize(sizeof(constants));
  std::memcpy(push.data.data(), &constants, sizeof(constants));
  emit_change(0, push);
  traces::Draw draw;
  draw.count = 3;
  draw.label = label;
  tables_.stream.commands.emplace_back(std::move(draw));
  drew_ = true;
}

/// A part of a pass, or all of it behind a draw.
void FrameRecorder::clear_area(const Value& attachment, const Area& area) {
  const std::uint32_t aspect = attachment["aspectMask"].u32(), number = attachment["colorAttachment"].u32();
  const std::array<std::uint32_t, 4> bits = clear_bits(attachment["clearValue"]);
  if ((aspect & VK_IMAGE_ASPECT_COLOR_BIT) != 0) {
    if (number >= color_places_.size())
      throw user_error("of colour attachment {} of a pass that has {}", number, color_places_.size());
    if (color_places_[number] != traces::kNone) clear_color_area(color_places_[number], bits, area);
  }
  if ((aspect & (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT)) != 0)
    clear_depth_area(aspect, bits, area);
}

void FrameRecorder::clear_color_area(std::uint32_t attachment, const std::array<std::uint32_t, 4>& bits,
                                     const Area& area) {
  Fill what{OwnShader::kClear, attachment};
  const traces::Format format = tables_.stream.images[pass_.colors[attachment].image].format;
  if (traces::is_integer_format(format))
    what.shader = models::number_kind(format) == models::NumberKind::kUint ? OwnShader::kClearUnsigned
                                                                           : OwnShader::kClearSigned;
  AreaConstants constants;
  for (std::size_t c = 0; c < 4; ++c) constants.color[c] = std::bit_cast<float>(bits[c]);
  fill({}, what, constants, area, "clear");
}

void FrameRecorder::clear_depth_area(std::uint32_t aspect, const std::array<std::uint32_t, 4>& bits,
                                     const Area& area) {
  if (pass_.depth.image == traces::kNone) return;
  traces::Pipeline pipeline;
  AreaConstants constants;
  if ((aspect & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
    pipeline.depth = {true, true, traces::CompareOp::kAlways};
    constants.depth = std::bit_cast<float>(bits[0]);
  }
  const bool has_stencil = models::has_stencil(tables_.stream.images[pass_.depth.image].format);
  if (has_stencil && (aspect & VK_IMAGE_ASPECT_STENCIL_BIT) != 0) {
    pipeline.stencil.test = true;
    pipeline.stencil.front.pass = traces::StencilOp::kReplace;
    pipeline.stencil.front.depth_fail = traces::StencilOp::kReplace;
    pipeline.stencil.front.reference = static_cast<std::uint8_t>(bits[1]);
    pipeline.stencil.back = pipeline.stencil.front;
  }
  fill(pipeline, {OwnShader::kClear, 0, false}, constants, area, "clear");
}

/// A pass by itself, that samples the source and draws to the destination.
void FrameRecorder::blit(const Value& call) {
  if (in_pass_) throw user_error("within a pass");
  const Handle source = call["srcImage"].u64(), target = call["dstImage"].u64();
  for (std::size_t i = 0; i < call["pRegions"].size(); ++i)
    blit_region(source, target, call["pRegions"].at(i), call["filter"].u32());
}

void FrameRecorder::blit_region(Handle source, Handle target, const Value& region, std::uint32_t filter) {
  const Value &from = region["srcSubresource"], &to = region["dstSubresource"];
  const ImageObject &source_image = object(device_.images, source, "image"),
                    &target_image = object(device_.images, target, "image");
  const bool volumes = source_image.type == VK_IMAGE_TYPE_3D || !may_attach(target_image);
  if (volumes && !tables_.stored(source) && !tables_.stored(target))
    return device_.blit_image(source, target, region, filter);
  const Span x = span_of(region["srcOffsets"], "x"), y = span_of(region["srcOffsets"], "y");
  const Span to_x = span_of(region["dstOffsets"], "x"), to_y = span_of(region["dstOffsets"], "y");
  if (!(to_x.size > 0) || !(to_y.size > 0)) throw user_error("to an area with its corners turned");
  DrawnCopy copy;
  copy.depths = are_depths(from, to);
  if (copy.depths && source_image.format != target_image.format)
    throw user_error("between formats of depths");
  copy.source = {source, from["mipLevel"].u32(), from["baseArrayLayer"].u32()};
  copy.target = {target, to["mipLevel"].u32(), to["baseArrayLayer"].u32()};
  copy.from = {x.begin, y.begin, x.size, y.size};
  copy.to = {static_cast<std::int32_t>(to_x.begin), static_cast<std::int32_t>(to_y.begin),
             static_cast<std::uint32_t>(to_x.size), static_cast<std::uint32_t>(to_y.size)};
  copy.filter = filter == VK_FILTER_LINEAR ? traces::Filter::kLinear : traces::Filter::kNearest;
  draw_layers(copy, to["layerCount"].u32(), "blit");
}

void FrameRecorder::draw_layers(DrawnCopy copy, std::uint32_t layers, const char* label) {
  if (layers > object(device_.images, copy.target.image, "image").layers)
    throw user_error("of {} layers", layers);
  for (std::uint32_t layer = 0; layer < layers; ++layer, ++copy.source.layer, ++copy.target.layer)
    draw_copy(copy, label);
}

void FrameRecorder::draw_copy(const DrawnCopy& copy, const char* label) {
  const ImageObject& image = object(device_.images, copy.source.image, "image");
  if (image.samples > 1) throw user_error("of several samples a pixel");
  if (copy.source == copy.target) throw user_error("within a level of an image");
  const ViewObject view = view_of_part(copy.source.image, image, copy.source.level, copy.source.layer);
  const auto width = static_cast<float>(std::max(1u, image.width >> view.level));
  const auto height = static_cast<float>(std::max(1u, image.height >> view.level));
  AreaConstants constants;
  constants.source = {copy.from[0] / width, copy.from[1] / height, copy.from[2] / width,
                      copy.from[3] / height};
  traces::TextureDescriptor texture = tables_.texture(view);
  texture.sampler = tables_.sampler(copying_sampler(copy.filter));
  draw_texture(texture, constants, copy, label);
}

/// A pass with one draw. What it covers whole is not loaded, but for stencil values beside depths.
void FrameRecorder::draw_texture(const traces::TextureDescriptor& texture, const AreaConstants& constants,
                                 const DrawnCopy& copy, const char* label) {
  begin_blit(copy.target, copy.depths);
  auto& begin = std::get<traces::BeginPass>(tables_.stream.commands[begin_at_]);
  traces::AttachmentUse& use =
      copy.depths ? static_cast<traces::AttachmentUse&>(begin.depth) : begin.colors[0];
  const bool whole =
      copy.to.x == 0 && copy.to.y == 0 && copy.to.width == pass_width_ && copy.to.height == pass_height_;
  if (whole && !models::has_stencil(tables_.stream.images[use.image].format))
    use.load = traces::LoadOp::kDontCare;
  traces::DescriptorSet set;
  set.textures.push_back(texture);
  emit_change(0, traces::BindDescriptorSet{0, tables_.descriptors(set)});
  traces::Pipeline pipeline;
  Fill what{texture.view == traces::ViewKind::k1D ? OwnShader::kCopyLine : OwnShader::kCopy};
  if (copy.depths) {
    pipeline.depth = {true, true, traces::CompareOp::kAlways};
    what = {OwnShader::kCopyDepth, 0, false};
  }
  fill(pipeline, what, constants, copy.to, label);
  end_pass();
}

/// A pass for each level and layer, that clears it and draws nothing.
void FrameRecorder::clear_image(const Value& call) {
  if (in_pass_) throw user_error("within a pass");
  const Handle target = call["image"].u64();
  std::array<std::uint32_t, 4> bits{};
  for (std::size_t c = 0; c < bits.size() && c < call["pColor"].size(); ++c) bits[c] = call["pColor"].u32(c);
  const ImageObject& image = object(device_.images, target, "image");
  for (std::size_t i = 0; i < call["pRanges"].size(); ++i) {
    const Value& range = call["pRanges"].at(i);
    const auto end = [](std::uint32_t first, std::uint32_t count, std::uint32_t all) {
      return count > all || first > all - count ? all : first + count;
    };
    const std::uint32_t first_level = range["baseMipLevel"].u32(),
                        first_layer = range["baseArrayLayer"].u32();
    for (std::uint32_t l = first_level; l < end(first_level, range["levelCount"].u32(), image.levels); ++l)
      for (std::uint32_t a = first_layer; a < end(first_layer, range["layerCount"].u32(), image.layers);
           ++a) {
        begin_blit({target, l, a}, false);
        auto& begin = std::get<traces::BeginPass>(tables_.stream.commands[begin_at_]);
        set_clear(begin.colors[0], bits,
                  traces::is_integer_format(tables_.stream.images[begin.colors[0].image].format));
        end_pass();
      }
  }
}

traces::Index FrameRecorder::attachment_of(const StoredPart& part, bool depths) {
  const traces::Index index = tables_.attachment(part.image);
  const traces::Image& image = tables_.stream.images[index];
  const bool has_depths = (image.usage & traces::kDepthAttachment) != 0;
  if (has_depths != depths) throw user_error("to an image of {}", has_depths ? "depths" : "colours");
  if (part.level >= image.levels || part.layer >= image.layers)
    throw user_error("level {} of layer {} of an image that has {} and {}", part.level, part.layer,
                     image.levels, image.layers);
  return index;
}

void FrameRecorder::begin_blit(const StoredPart& target, bool depths) {
  const traces::Index index = attachment_of(target, depths);
  const traces::Image& image = tables_.stream.images[index];
  pass_ = {};
  pass_stores_.clear();
  pass_lacks_.clear();
  traces::AttachmentUse& use =
      depths ? static_cast<traces::AttachmentUse&>(pass_.depth) : pass_.colors.emplace_back();
  use.image = index;
  use.level = target.level;
  use.layer = target.layer;
  const traces::LoadOp unknown = depths ? traces::LoadOp::kClear : traces::LoadOp::kDontCare;
  use.load = tables_.holds(target.image, target.level, target.layer) ? traces::LoadOp::kLoad : unknown;
  pass_stores_.push_back(target);
  pass_width_ = traces::level_width(image, target.level);
  pass_height_ = traces::level_height(image, target.level);
  last_shown_ = depths ? 0 : target.image;
  in_pass_ = true;
  begin_at_ = tables_.stream.commands.size();
  tables_.stream.commands.emplace_back(pass_);
  forget_windows();
}

}  // namespace quadrille::capture
