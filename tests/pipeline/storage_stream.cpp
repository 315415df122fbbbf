#include "tests/pipeline/storage_stream.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

struct Vertex {
  float position[4], color[4];
};

std::string vertex_source(const StorageShape& shape) {
  return fmt::format(R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
{}
void main() {{ gl_Position = position; v_color = color; uint vertex = uint(gl_VertexIndex);
{}
}})",
                     shape.vertex_declarations, shape.vertex_body);
}

std::string fragment_source(const std::string& declarations, const std::string& body) {
  return fmt::format(R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
{}
void main() {{ o = v_color;
{}
}})",
                     declarations, body);
}

constexpr const char* kWholePicture = R"(#version 450
layout(location = 0) out vec4 v_color;
void main() {
  vec2 at = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  v_color = vec4(at, 0.0, 1.0);
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
})";

class Maker {
 public:
  Maker(std::uint64_t seed, const StorageShape& shape) : shape_(shape), random_(seed) {}

  traces::CommandStream make() {
    stream_.name = "storage";
    stream_.buffers.push_back({"words", std::vector<std::byte>(std::size_t{4} * shape_.words)});
    stream_.descriptor_sets = {{{}, {}, {{0, 0, 0, 4 * shape_.words}}}};
    traces::Pipeline p = pipeline(vertex_source(shape_), shape_.fragment_body);
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
    p.depth = {shape_.depth_test, shape_.depth_test && shape_.depth_write, traces::CompareOp::kLess};
    pass(p, triangles());
    if (!shape_.second_body.empty()) pass(pipeline(kWholePicture, shape_.second_body), traces::kNone);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  Index shader(const std::string& source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"storage", stage, scenes::compile_glsl(source, stage, "storage")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  traces::Pipeline pipeline(const std::string& vertex, const std::string& body) {
    traces::Pipeline p;
    p.vertex_shader = shader(vertex, traces::ShaderStage::kVertex);
    p.fragment_shader =
        shader(fragment_source(shape_.fragment_declarations, body), traces::ShaderStage::kFragment);
    return p;
  }

  Index triangles() {
    std::vector<Vertex> vertices;
    vertices.reserve(static_cast<std::size_t>(3 * shape_.triangles));
    for (int i = 0; i < 3 * shape_.triangles; ++i)
      vertices.push_back(
          {{random_.real(-1.2f, 1.2f), random_.real(-1.2f, 1.2f), random_.real(0, 1), 1},
           {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), random_.real(0.2f, 1)}});
    std::vector<std::byte> bytes(vertices.size() * sizeof(Vertex));
    std::memcpy(bytes.data(), vertices.data(), bytes.size());
    stream_.buffers.push_back({"triangles", std::move(bytes)});
    return static_cast<Index>(stream_.buffers.size() - 1);
  }

  /// Draws the triangles of a buffer, or one over the whole picture.
  void pass(const traces::Pipeline& p, Index buffer) {
    auto& c = stream_.commands;
    stream_.pipelines.push_back(p);
    c.emplace_back(traces::make_pass(stream_, {shape_.width, shape_.height}));
    c.emplace_back(
        traces::SetViewport{0, 0, static_cast<float>(shape_.width), static_cast<float>(shape_.height), 0, 1});
    c.emplace_back(traces::SetScissor{0, 0, shape_.width, shape_.height});
    c.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    c.emplace_back(traces::BindDescriptorSet{0, 0});
    traces::Draw draw;
    draw.count = 3;
    if (buffer != traces::kNone) {
      c.emplace_back(traces::BindVertexBuffer{0, buffer, 0});
      draw.count = static_cast<std::uint32_t>(3 * shape_.triangles);
    }
    c.emplace_back(draw);
    c.emplace_back(traces::EndPass{});
  }

  const StorageShape& shape_;
  RandomSource random_;
  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream storage_stream(std::uint64_t seed, const StorageShape& shape) {
  return Maker(seed, shape).make();
}

void add_storage_draw(traces::CommandStream& stream) {
  constexpr std::uint32_t kWords = 4096;
  constexpr const char* kFragment = R"(#version 450
layout(location = 0) out vec4 o;
layout(std430, set = 0, binding = 9) buffer B { uint count; uint read[1023]; uint written[]; } b;
void main() {
  uint at = uint(gl_FragCoord.y) * 40u + uint(gl_FragCoord.x);
  atomicAdd(b.count, 1u);
  b.written[at] = b.read[at % 1023u] + at;
  o = vec4(0.5);
})";
  const auto draw =
      std::find_if(stream.commands.rbegin(), stream.commands.rend(),
                   [](const traces::Command& c) { return std::holds_alternative<traces::Draw>(c); });
  const auto set = static_cast<Index>(stream.descriptor_sets.size());
  stream.descriptor_sets.push_back(stream.descriptor_sets.at(0));
  stream.descriptor_sets.back().buffers = {{9, static_cast<Index>(stream.buffers.size()), 0, 4 * kWords}};
  stream.buffers.push_back({"words", std::vector<std::byte>(std::size_t{4} * kWords)});
  stream.pipelines.push_back(stream.pipelines.back());
  stream.pipelines.back().fragment_shader = static_cast<Index>(stream.shaders.size());
  stream.shaders.push_back({"storage", traces::ShaderStage::kFragment,
                            scenes::compile_glsl(kFragment, traces::ShaderStage::kFragment, "storage")});
  const traces::Command again = *draw;
  stream.commands.insert(draw.base(), {traces::BindPipeline{static_cast<Index>(stream.pipelines.size() - 1)},
                                       traces::BindDescriptorSet{0, set}, again});
  traces::validate(stream);
}

StorageShape kept_by_pixel() {
  StorageShape shape;
  shape.fragment_declarations = R"(layout(std430, set = 0, binding = 0) buffer B {
  uint count[64]; ivec4 bounds; uint last[]; } b;)";
  shape.fragment_body = R"(
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (v_color.a < 0.4) discard;
  b.last[at.y * 88 + at.x] = uint(gl_PrimitiveID) + 1u;
  atomicAdd(b.count[gl_PrimitiveID], 1u);
  atomicMin(b.bounds.x, at.x - 1000); atomicMin(b.bounds.y, at.y - 1000);
  atomicMax(b.bounds.z, at.x); atomicMax(b.bounds.w, at.y);)";
  shape.second_body = R"(
  ivec2 at = ivec2(gl_FragCoord.xy);
  uint last = b.last[at.y * 88 + at.x];
  float share = last == 0u ? 0.0 : float(b.count[last - 1u]) / 900.0;
  bool edge = at.x == b.bounds.x + 1000 || at.y == b.bounds.y + 1000 || at.x == b.bounds.z || at.y == b.bounds.w;
  o = edge ? vec4(1) : vec4(float(last % 8u) / 8.0, share, float(last / 8u) / 4.0, 1.0);)";
  return shape;
}

}  // namespace quadrille::pipeline::test
