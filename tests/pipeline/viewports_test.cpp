/// Several viewports and scissors a draw, in whole frames.
#include "tests/pipeline/viewports_stream.h"

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "scenes/material/glsl.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <cstring>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

/// A fan of four triangles over the whole clip space, each of which takes the viewport that the number of its
/// first vertex says. `numbers` are of the vertices: the hub, then around it.
traces::CommandStream fan_stream(const std::array<int, 6>& numbers, std::uint32_t viewports) {
  traces::CommandStream s;
  s.name = "fan";
  constexpr const char* kVertex = R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) in vec3 at;
void main() { gl_Position = vec4(at.xy, 0.5, 1.0); gl_ViewportIndex = int(at.z); })";
  constexpr const char* kFragment = R"(#version 450
layout(location = 0) out vec4 o;
void main() { o = vec4(1.0); })";
  s.shaders = {
      {"v", traces::ShaderStage::kVertex, scenes::compile_glsl(kVertex, traces::ShaderStage::kVertex, "fan")},
      {"f", traces::ShaderStage::kFragment,
       scenes::compile_glsl(kFragment, traces::ShaderStage::kFragment, "fan")}};
  constexpr std::array<std::array<float, 2>, 6> kPlaces{
      {{0, 0}, {-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  std::vector<float> vertices;
  for (std::size_t i = 0; i < kPlaces.size(); ++i)
    vertices.insert(vertices.end(), {kPlaces[i][0], kPlaces[i][1], static_cast<float>(numbers[i])});
  s.buffers = {{"vertices", std::vector<std::byte>(4 * vertices.size())}};
  std::memcpy(s.buffers[0].data.data(), vertices.data(), s.buffers[0].data.size());
  traces::Pipeline p;
  p.vertex_shader = 0;
  p.fragment_shader = 1;
  p.bindings = {{0, 12, false}};
  p.attributes = {{0, 0, traces::Format::kR32G32B32Float, 0}};
  p.topology = traces::Topology::kTriangleFan;
  p.viewports = viewports;
  s.pipelines = {p};
  s.commands.emplace_back(traces::make_pass(s, {32, 8, traces::Format::kR8G8B8A8Unorm, {}}));
  for (std::uint32_t i = 0; i < 4; ++i) {
    s.commands.emplace_back(traces::SetViewport{8.0f * static_cast<float>(i), 0, 8, 8, 0, 1, i});
    s.commands.emplace_back(traces::SetScissor{0, 0, 32, 8, i});
  }
  s.commands.emplace_back(traces::BindPipeline{0});
  s.commands.emplace_back(traces::BindVertexBuffer{0, 0, 0});
  traces::Draw draw;
  draw.count = 6;
  s.commands.emplace_back(draw);
  s.commands.emplace_back(traces::EndPass{});
  traces::validate(s);
  return s;
}

/// Pixels drawn in each of the four viewports.
std::array<int, 4> drawn(const traces::CommandStream& stream) {
  const pipeline::RenderedFrame frame = pipeline::render_functional_frame(stream, {});
  std::array<int, 4> count{};
  for (std::size_t i = 0; i < frame.image.color.size(); ++i)
    if ((frame.image.color[i] & 0xffu) != 0) ++count[i % 32 / 8];
  return count;
}

}  // namespace

TEST_CASE("viewports: random machines draw the functional run's pixels, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    INFO("stream and machine " << seed);
    CHECK(machine_faults(viewports_stream(seed, seed % 3 == 0 ? 4 : 1), seed) == "");
  }
}

TEST_CASE("viewports: the machine's picture is the reference's in given mode") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto pictures = studies::render_with_reference(viewports_stream(seed, seed % 3 == 0 ? 4 : 1), {});
    const auto difference =
        models::reference::compare_images({kViewportsSide, kViewportsSide, pictures.machine.color},
                                          {kViewportsSide, kViewportsSide, pictures.reference.color});
    INFO("seed " << seed << ": " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
  }
}

TEST_CASE("viewports: a fan's triangle takes the viewport of its first vertex, which is not the hub") {
  // Each triangle covers a quarter of its viewport of 64 pixels: 16, or the pixels on its diagonals too.
  const std::array<int, 4> each = drawn(fan_stream({3, 0, 1, 2, 3, 0}, 4));
  for (const int pixels : each) CHECK((pixels >= 12 && pixels <= 20));
  CHECK(each[0] + each[1] + each[2] + each[3] == 64);
  CHECK(drawn(fan_stream({0, 2, 2, 2, 2, 0}, 4)) == std::array{0, 0, 64, 0});
}

TEST_CASE("viewports: a number beyond those of the pipeline takes the first, and so does a negative one") {
  CHECK(drawn(fan_stream({1, 2, 2, 2, 2, 1}, 2)) == std::array{64, 0, 0, 0});
  CHECK(drawn(fan_stream({1, -1, 16, 1, 100, 1}, 2))[1] > 0);
  CHECK(drawn(fan_stream({1, -1, 16, 100, 99, 1}, 4)) == std::array{64, 0, 0, 0});
}

TEST_CASE("viewports: a program that does not choose draws to the first of them") {
  traces::CommandStream stream = fan_stream({0, 0, 0, 0, 0, 0}, 4);
  stream.shaders[0].spirv = scenes::compile_glsl(R"(#version 450
layout(location = 0) in vec3 at;
void main() { gl_Position = vec4(at.xy, 0.5, 1.0); })",
                                                 traces::ShaderStage::kVertex, "fan");
  CHECK(drawn(stream) == std::array{64, 0, 0, 0});
}

TEST_CASE("viewports: streams survive their trace file") {
  const traces::CommandStream stream = viewports_stream(2);
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}
