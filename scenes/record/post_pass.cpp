#include "scenes/record/post_pass.h"

#include <string_view>
#include <utility>
#include <vector>

#include "scenes/material/glsl.h"
#include "scenes/material/screen_triangle.h"

namespace quadrille::scenes {
namespace {

using traces::Index;

template <class T>
Index append(std::vector<T>& table, T object) {
  table.push_back(std::move(object));
  return static_cast<Index>(table.size() - 1);
}

/// Only reads pixels of the picture's own size, so there is nothing to repeat.
traces::Sampler sampler(traces::Filter filter) {
  traces::Sampler s;
  s.mag = s.min = filter;
  s.mip = traces::Filter::kNearest;
  s.wrap_u = s.wrap_v = traces::Wrap::kClampToEdge;
  return s;
}

traces::BeginPass& last_pass(traces::CommandStream& stream) {
  traces::BeginPass* last = nullptr;
  for (traces::Command& command : stream.commands) {
    if (auto* begin = std::get_if<traces::BeginPass>(&command)) last = begin;
  }
  return *last;
}

/// The pass's attachments as textures, at set 0.
Index add_textures(traces::CommandStream& stream, const traces::BeginPass& pass) {
  traces::DescriptorSet set;
  const auto add = [&](std::uint32_t binding, Index image, traces::Filter filter) {
    stream.images[image].usage |= traces::kSampled;
    set.textures.push_back({binding, image, append(stream.samplers, sampler(filter))});
  };
  add(0, pass.colors[0].image, traces::Filter::kLinear);
  if (pass.depth.image != traces::kNone) add(1, pass.depth.image, traces::Filter::kNearest);
  return append(stream.descriptor_sets, std::move(set));
}

Index add_pipeline(traces::CommandStream& stream, const std::string& fragment_shader) {
  using traces::ShaderStage;
  traces::Pipeline pipeline;
  pipeline.name = "post";
  pipeline.vertex_shader = append(
      stream.shaders,
      {"post.vert", ShaderStage::kVertex, compile_glsl(kScreenTriangle, ShaderStage::kVertex, "post.vert")});
  pipeline.fragment_shader =
      append(stream.shaders, {"post.frag", ShaderStage::kFragment,
                              compile_glsl(fragment_shader, ShaderStage::kFragment, "post.frag")});
  return append(stream.pipelines, std::move(pipeline));
}

}  // namespace

void add_post_pass(traces::CommandStream& stream, const std::string& fragment_shader) {
  const traces::BeginPass first = last_pass(stream);
  const traces::PassTarget target = traces::target_of(stream, first);
  const Index set = add_textures(stream, first), pipeline = add_pipeline(stream, fragment_shader);
  traces::BeginPass pass =
      traces::make_pass(stream, {target.width, target.height, target.color, traces::Format::kUndefined});
  // Every pixel is drawn.
  pass.colors[0].load = traces::LoadOp::kDontCare;
  traces::Draw draw;
  draw.count = 3;
  draw.label = "post";
  stream.commands.insert(
      stream.commands.end(),
      {pass,
       traces::SetViewport{0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0, 1},
       traces::SetScissor{0, 0, target.width, target.height}, traces::BindPipeline{pipeline},
       traces::BindDescriptorSet{0, set}, draw, traces::EndPass{}});
}

}  // namespace quadrille::scenes
