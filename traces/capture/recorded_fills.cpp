/// Clears and blits in the middle of a frame, as draws of a triangle over their area.
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"
#include "traces/capture/own_shaders.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

/// Of a blit: its corners in either order.
struct Span {
  float begin = 0, size = 0;
};
Span span_of(const Value& offsets, std::string_view axis) {
  const auto a = static_cast<float>(offsets.at(0)[axis].i32()),
             b = static_cast<float>(offsets.at(1)[axis].i32());
  return {a, b - a};
}

}  // namespace

void FrameRecorder::fill(traces::Pipeline pipeline, OwnShader fragment, const AreaConstants& constants,
                         const Area& area, const char* label) {
  pipeline.name = label;
  pipeline.vertex_shader = tables_.own(OwnShader::kArea);
  pipeline.fragment_shader = tables_.own(fragment);
  for (std::size_t i = 1; i < pipeline.blend.size(); ++i) pipeline.blend[i].write_mask = 0;
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
void FrameRecorder::clear_area(const Value& attachment, const Value& rect) {
  const std::uint32_t aspect = attachment["aspectMask"].u32();
  const std::array<std::uint32_t, 4> bits = clear_bits(attachment["clearValue"]);
  traces::Pipeline pipeline;
  AreaConstants constants;
  pipeline.blend[0].write_mask = 0;
  if ((aspect & VK_IMAGE_ASPECT_COLOR_BIT) != 0) {
    if (attachment["colorAttachment"].u32() != 0 || pass_.colors.empty() ||
        traces::is_integer_format(tables_.stream.images[pass_.colors[0].image].format))
      throw user_error("of colour attachment {}, or of integers, behind a draw",
                       attachment["colorAttachment"].u32());
    pipeline.blend[0].write_mask = 0xf;
    for (std::size_t c = 0; c < 4; ++c) constants.color[c] = std::bit_cast<float>(bits[c]);
  }
  if (pass_.depth.image != traces::kNone) {
    if ((aspect & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
      pipeline.depth = {true, true, traces::CompareOp::kAlways};
      constants.depth = std::bit_cast<float>(bits[0]);
    }
    if ((aspect & VK_IMAGE_ASPECT_STENCIL_BIT) != 0) {
      pipeline.stencil.test = true;
      pipeline.stencil.front.pass = traces::StencilOp::kReplace;
      pipeline.stencil.front.depth_fail = traces::StencilOp::kReplace;
      pipeline.stencil.front.reference = static_cast<std::uint8_t>(bits[1]);
      pipeline.stencil.back = pipeline.stencil.front;
    }
  }
  const Area area{rect["offset"]["x"].i32(), rect["offset"]["y"].i32(), rect["extent"]["width"].u32(),
                  rect["extent"]["height"].u32()};
  if (area.width == 0 || area.height == 0) return;
  fill(pipeline, OwnShader::kClear, constants, area, "clear");
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
  if (from["aspectMask"].u32() != VK_IMAGE_ASPECT_COLOR_BIT || to["layerCount"].u32() != 1)
    throw user_error("of depths, or of several layers");
  const ImageObject& image = object(device_.images, source, "image");
  ViewObject view;
  view.image = source;
  view.type = VK_IMAGE_VIEW_TYPE_2D;
  view.format = image.format;
  view.aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  view.level = from["mipLevel"].u32();
  view.layer = from["baseArrayLayer"].u32();
  if (view.level >= image.levels || view.layer >= image.layers)
    throw user_error("level {} of layer {} of an image that has {} and {}", view.level, view.layer,
                     image.levels, image.layers);
  traces::DescriptorSet set;
  set.textures.push_back(tables_.texture(view));
  traces::Sampler sampler;
  sampler.mag = sampler.min = filter == VK_FILTER_LINEAR ? traces::Filter::kLinear : traces::Filter::kNearest;
  sampler.mip = traces::Filter::kNearest;
  sampler.wrap_u = sampler.wrap_v = traces::Wrap::kClampToEdge;
  set.textures[0].sampler = tables_.sampler(sampler);

  begin_blit(target, to["mipLevel"].u32(), to["baseArrayLayer"].u32());
  const Span x = span_of(region["srcOffsets"], "x"), y = span_of(region["srcOffsets"], "y");
  const Span to_x = span_of(region["dstOffsets"], "x"), to_y = span_of(region["dstOffsets"], "y");
  if (!(to_x.size > 0) || !(to_y.size > 0)) throw user_error("to an area with its corners turned");
  const auto width = static_cast<float>(std::max(1u, image.width >> view.level));
  const auto height = static_cast<float>(std::max(1u, image.height >> view.level));
  AreaConstants constants;
  constants.source = {x.begin / width, y.begin / height, x.size / width, y.size / height};
  emit_change(0, traces::BindDescriptorSet{0, tables_.descriptors(set)});
  fill({}, OwnShader::kCopy, constants,
       {static_cast<std::int32_t>(to_x.begin), static_cast<std::int32_t>(to_y.begin),
        static_cast<std::uint32_t>(to_x.size), static_cast<std::uint32_t>(to_y.size)},
       "blit");
  end_pass();
}

void FrameRecorder::begin_blit(Handle target, std::uint32_t level, std::uint32_t layer) {
  pass_ = {};
  pass_stores_.clear();
  traces::ColorAttachmentUse& use = pass_.colors.emplace_back();
  use.image = tables_.attachment(target);
  const traces::Image& image = tables_.stream.images[use.image];
  if ((image.usage & traces::kColorAttachment) == 0) throw user_error("to an image of depths");
  if (level >= image.levels || layer >= image.layers)
    throw user_error("level {} of layer {} of an image that has {} and {}", level, layer, image.levels,
                     image.layers);
  use.level = level;
  use.layer = layer;
  use.load = tables_.stored_part(target, level, layer) ? traces::LoadOp::kLoad : traces::LoadOp::kDontCare;
  pass_stores_.push_back({target, level, layer});
  pass_width_ = traces::level_width(image, level);
  pass_height_ = traces::level_height(image, level);
  last_shown_ = target;
  in_pass_ = true;
  begin_at_ = tables_.stream.commands.size();
  tables_.stream.commands.emplace_back(pass_);
}

}  // namespace quadrille::capture
