#include "tests/pipeline/coverage_stream.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <cstring>

namespace quadrille::pipeline::test {
namespace {

using traces::Index;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec3 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
void main() { gl_Position = vec4(position, 1.0); v_color = color; })";

struct Vertex {
  std::array<float, 3> position;
  std::array<float, 4> color;
};

Index add_shader(traces::CommandStream& stream, const std::string& source, traces::ShaderStage stage) {
  stream.shaders.push_back({"coverage", stage, scenes::compile_glsl(source, stage, "coverage")});
  return static_cast<Index>(stream.shaders.size() - 1);
}

Index add_vertices(traces::CommandStream& stream, const std::vector<ColoredTriangle>& triangles) {
  std::vector<Vertex> vertices;
  vertices.reserve(3 * triangles.size());
  for (const ColoredTriangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) vertices.push_back({t.corner[i], t.color[i]});
  std::vector<std::byte> bytes(vertices.size() * sizeof(Vertex));
  std::memcpy(bytes.data(), vertices.data(), bytes.size());
  stream.buffers.push_back({"triangles", std::move(bytes)});
  return static_cast<Index>(stream.buffers.size() - 1);
}

void add_draw(traces::CommandStream& stream, const CoverageDraw& draw) {
  traces::Pipeline p;
  p.name = "coverage";
  p.vertex_shader = 0;
  p.fragment_shader = add_shader(stream, "#version 450\n" + draw.fragment, traces::ShaderStage::kFragment);
  p.bindings = {{0, sizeof(Vertex), false}};
  p.attributes = {{0, 0, traces::Format::kR32G32B32Float, 0},
                  {1, 0, traces::Format::kR32G32B32A32Float, sizeof(Vertex::position)}};
  p.depth = {draw.depth, draw.depth, traces::CompareOp::kLess};
  p.sample_shading = draw.sample_shading;
  p.alpha_to_coverage = draw.alpha_to_coverage;
  p.sample_mask = draw.sample_mask;
  stream.pipelines.push_back(std::move(p));
  stream.commands.emplace_back(traces::BindPipeline{static_cast<Index>(stream.pipelines.size() - 1)});
  stream.commands.emplace_back(traces::BindVertexBuffer{0, add_vertices(stream, draw.triangles), 0});
  traces::Draw command;
  command.count = static_cast<std::uint32_t>(3 * draw.triangles.size());
  stream.commands.emplace_back(std::move(command));
}

/// For the vertex shaders of `random_stream`.
constexpr std::array<const char*, 8> kFragments{
    // Centroid, of both kinds.
    R"(layout(location = 0) centroid in vec4 v_color; layout(location = 1) noperspective centroid in vec2 v_uv;
layout(location = 0) out vec4 o;
void main() { o = vec4(v_color.rg, fract(v_uv.x), v_color.a); })",
    // By sample, as an input says.
    R"(layout(location = 0) sample in vec4 v_color; layout(location = 1) centroid in vec2 v_uv;
layout(location = 0) out vec4 o; layout(set = 0, binding = 0) uniform sampler2D t;
void main() { o = texture(t, v_uv) * v_color; })",
    // By sample, as built-ins say.
    R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { o = vec4(v_color.r, gl_SamplePosition.x, float(gl_SampleID) / 7.0, fract(gl_FragCoord.y)); })",
    // What is covered.
    R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { o = vec4(float(gl_SampleMaskIn[0]) / 255.0, v_color.gba); })",
    // Takes samples away.
    R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { gl_SampleMask[0] = int(v_color.g * 255.0) ^ gl_SampleMaskIn[0]; o = v_color; })",
    // The same, with a depth of its own, where not all of it is discarded.
    R"(layout(location = 0) in vec4 v_color; layout(location = 1) in vec2 v_uv; layout(location = 0) out vec4 o;
void main() {
  if (v_color.b < 0.2) discard;
  gl_SampleMask[0] = int(v_color.g * 255.0);
  gl_FragDepth = clamp(gl_FragCoord.z * 0.8 + 0.2 * fract(v_uv.x), 0.0, 1.0);
  o = v_color;
})",
    // The same, after its depth has been tested.
    R"(layout(early_fragment_tests) in;
layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { gl_SampleMask[0] = int(v_color.r * 255.0); o = v_color.gbra; })",
    // By sample, with derivatives, and discards some.
    R"(layout(location = 0) sample in vec4 v_color; layout(location = 1) sample in vec2 v_uv; layout(location = 0) out vec4 o;
void main() { if (fract(v_uv.y * 3.0) < 0.3) discard; o = vec4(abs(dFdx(v_uv)), v_color.ra); })"};

}  // namespace

ColoredTriangle whole_picture(float depth) {
  return {{{{-1, -1, depth}, {3, -1, depth}, {-1, 3, depth}}}, {{{0, 0, 0, 1}, {2, 0, 0, 1}, {0, 2, 0, 1}}}};
}

traces::CommandStream coverage_stream(const std::vector<CoverageDraw>& draws, std::uint32_t samples,
                                      std::uint32_t width, std::uint32_t height) {
  traces::CommandStream stream;
  stream.name = "coverage";
  (void)add_shader(stream, kVertex, traces::ShaderStage::kVertex);
  stream.commands.emplace_back(
      traces::make_pass(stream, {width, height, traces::Format::kR8G8B8A8Unorm}, {0, 0, 0, 0}));
  stream.commands.emplace_back(
      traces::SetViewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1});
  stream.commands.emplace_back(traces::SetScissor{0, 0, width, height});
  for (const CoverageDraw& draw : draws) add_draw(stream, draw);
  stream.commands.emplace_back(traces::EndPass{});
  traces::use_samples(stream, samples);
  traces::validate(stream);
  return stream;
}

void add_sample_states(traces::CommandStream& random_stream, std::uint64_t seed) {
  RandomSource random(seed + 77);
  const auto first = static_cast<int>(random_stream.shaders.size());
  for (const char* fragment : kFragments)
    (void)add_shader(random_stream, std::string("#version 450\n") + fragment, traces::ShaderStage::kFragment);
  for (traces::Pipeline& p : random_stream.pipelines) {
    if (random.integer(0, 2) != 0)
      p.fragment_shader =
          static_cast<Index>(first + random.integer(0, static_cast<int>(kFragments.size()) - 1));
    p.sample_shading = random.integer(0, 3) == 0;
    p.alpha_to_coverage = random.integer(0, 2) == 0;
    if (random.integer(0, 3) == 0) p.sample_mask = static_cast<std::uint32_t>(random.integer(0, 255));
  }
  traces::validate(random_stream);
}

}  // namespace quadrille::pipeline::test
