/// Small command streams written by hand, whose pictures follow from closed forms.
#include "tests/lavapipe/hand_made_stream.h"

#include <cstring>

#include "scenes/material/glsl.h"

namespace quadrille::lavapipe {
namespace {

template <class T>
traces::Buffer buffer_of(std::string name, std::span<const T> values) {
  traces::Buffer buffer{std::move(name), std::vector<std::byte>(values.size_bytes())};
  std::memcpy(buffer.data.data(), values.data(), values.size_bytes());
  return buffer;
}

template <class T>
traces::Index append(std::vector<T>& table, T object) {
  table.push_back(std::move(object));
  return static_cast<traces::Index>(table.size() - 1);
}

}  // namespace

std::string_view pass_through_vertex_shader() {
  return R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 value;
layout(location = 0) out vec2 v_value;
void main() {
  gl_Position = position;
  v_value = value;
})";
}

HandMadeStream::HandMadeStream(std::uint32_t width, std::uint32_t height, traces::Format color,
                               traces::Format depth) {
  stream_.name = "hand-made";
  pass_ = traces::make_pass(stream_, {width, height, color, depth}, {0, 0, 0, 0});
  stream_.descriptor_sets.emplace_back();
  traces::Pipeline pipeline;
  pipeline.bindings = {{0, sizeof(Corner), false}};
  pipeline.attributes = {{0, 0, traces::Format::kR32G32B32A32Float, 0},
                         {1, 0, traces::Format::kR32G32Float, sizeof(Corner::position)}};
  stream_.pipelines.push_back(pipeline);
  state_ = {traces::SetViewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1},
            traces::SetScissor{0, 0, width, height}};
}

HandMadeStream& HandMadeStream::shaders(std::string_view vertex, std::string_view fragment) {
  using traces::ShaderStage;
  pipeline().vertex_shader = append(
      stream_.shaders,
      {"vertex", ShaderStage::kVertex, scenes::compile_glsl(vertex, ShaderStage::kVertex, "hand-made.vert")});
  pipeline().fragment_shader =
      append(stream_.shaders, {"fragment", ShaderStage::kFragment,
                               scenes::compile_glsl(fragment, ShaderStage::kFragment, "hand-made.frag")});
  return *this;
}

HandMadeStream& HandMadeStream::corners(std::span<const Corner> corners) {
  state_.emplace_back(traces::BindVertexBuffer{0, append(stream_.buffers, buffer_of("corners", corners)), 0});
  return *this;
}

HandMadeStream& HandMadeStream::texture(std::uint32_t binding, traces::Image image,
                                        const traces::Sampler& sampler) {
  stream_.descriptor_sets[0].textures.push_back(
      {binding, append(stream_.images, std::move(image)), append(stream_.samplers, sampler)});
  return *this;
}

HandMadeStream& HandMadeStream::uniforms(std::uint32_t binding, std::span<const float> values) {
  const traces::Index buffer = append(stream_.buffers, buffer_of("uniforms", values));
  stream_.descriptor_sets[0].uniforms.push_back(
      {binding, buffer, 0, static_cast<std::uint32_t>(values.size_bytes())});
  return *this;
}

HandMadeStream& HandMadeStream::push_constants(std::span<const float> values) {
  state_.emplace_back(traces::PushConstants{0, buffer_of("", values).data});
  return *this;
}

HandMadeStream& HandMadeStream::draw(std::uint32_t count, std::uint32_t first, std::uint32_t instances) {
  traces::Draw draw;
  draw.count = count;
  draw.first = first;
  draw.instances = instances;
  draws_.emplace_back(draw);
  return *this;
}

HandMadeStream& HandMadeStream::draw_indexed(std::span<const std::uint8_t> indices) {
  draws_.emplace_back(traces::BindIndexBuffer{append(stream_.buffers, buffer_of("indices", indices)), 0,
                                              traces::IndexType::kUint8});
  traces::Draw draw;
  draw.indexed = true;
  draw.count = static_cast<std::uint32_t>(indices.size());
  draws_.emplace_back(draw);
  return *this;
}

traces::CommandStream HandMadeStream::finish() const {
  traces::CommandStream stream = stream_;
  stream.commands.emplace_back(pass_);
  stream.commands.emplace_back(traces::BindPipeline{0});
  stream.commands.emplace_back(traces::BindDescriptorSet{0, 0});
  stream.commands.insert(stream.commands.end(), state_.begin(), state_.end());
  stream.commands.insert(stream.commands.end(), draws_.begin(), draws_.end());
  stream.commands.emplace_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

}  // namespace quadrille::lavapipe
