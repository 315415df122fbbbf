#include "tests/pipeline/viewports_stream.h"

#include "models/raster/primitives.h"
#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <array>
#include <cstring>
#include <string>
#include <utility>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

constexpr const char* kVertex = R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
void main() {
  gl_Position = position;
  gl_PointSize = 3.0;
  gl_ViewportIndex = int(color.a);
  v_color = color;
})";
constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { o = vec4(v_color.rgb, 1.0); })";

struct Vertex {
  float position[4], color[4];  ///< alpha is the number of the viewport
};

class Maker {
 public:
  Maker(std::uint64_t seed, std::uint32_t samples, bool agreeing)
      : random_(seed), samples_(samples), agreeing_(agreeing) {
    stream_.name = "viewports";
    stream_.shaders = {{"v", traces::ShaderStage::kVertex,
                        scenes::compile_glsl(kVertex, traces::ShaderStage::kVertex, "viewports")},
                       {"f", traces::ShaderStage::kFragment,
                        scenes::compile_glsl(kFragment, traces::ShaderStage::kFragment, "viewports")}};
  }

  traces::CommandStream make() {
    stream_.commands.emplace_back(
        traces::make_pass(stream_, {kViewportsSide, kViewportsSide, Format::kR8G8B8A8Unorm}));
    for (int i = 0; i < 12; ++i) draw();
    stream_.commands.emplace_back(traces::EndPass{});
    traces::use_samples(stream_, samples_);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  /// Some overlap, some are turned over or have depths of their own.
  void set_viewports(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto whole = [&](int low, int high) { return static_cast<float>(random_.integer(low, high)); };
      traces::SetViewport v{whole(-4, 40), whole(-4, 40), whole(8, 40), whole(8, 40), 0, 1, i};
      if (random_.chance(0.3)) v.y += v.height, v.height = -v.height;
      if (random_.chance(0.4)) v.min_depth = 0.5f, v.max_depth = random_.chance(0.5) ? 0.75f : 0.25f;
      stream_.commands.emplace_back(v);
      const int x = samples_ > 1 ? 0 : random_.integer(0, 30), y = samples_ > 1 ? 0 : random_.integer(0, 30);
      const auto side = static_cast<std::uint32_t>(static_cast<int>(kViewportsSide) - std::max(x, y));
      stream_.commands.emplace_back(traces::SetScissor{x, y, side, side, i});
    }
  }

  traces::Pipeline pipeline(std::uint32_t viewports) {
    traces::Pipeline p;
    p.vertex_shader = 0;
    p.fragment_shader = 1;
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
    p.depth = {true, true, traces::CompareOp::kLessOrEqual};
    p.viewports = viewports;
    const int last =
        static_cast<int>(samples_ > 1 ? traces::Topology::kTriangleFan : traces::Topology::kLineStrip);
    p.topology = static_cast<traces::Topology>(random_.integer(0, last));
    p.depth_clamp = random_.chance(0.3);
    p.cull = static_cast<traces::CullMode>(std::max(0, random_.integer(-2, 2)));
    return p;
  }

  void choose(std::vector<Vertex>& vertices, std::uint32_t viewports) {
    const traces::Topology topology = stream_.pipelines.back().topology;
    const std::size_t corners = !models::is_list(topology)                    ? vertices.size()
                                : topology == traces::Topology::kTriangleList ? 3
                                : topology == traces::Topology::kLineList     ? 2
                                                                              : 1;
    const int most = static_cast<int>(viewports) + (agreeing_ ? -1 : 1);
    int number = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (!agreeing_ || i % corners == 0) number = random_.integer(0, most);
      vertices[i].color[3] = static_cast<float>(number);
    }
  }

  void draw() {
    const auto viewports = static_cast<std::uint32_t>(random_.pick({1, 2, 3, 5, 16}));
    set_viewports(viewports);
    stream_.pipelines.push_back(pipeline(viewports));
    // Devices differ in what they draw of points and lines that leave the view volume.
    const bool within = agreeing_ && models::assembled_kind(stream_.pipelines.back().topology) !=
                                         models::PieceKind::kTriangle;
    const float reach = within ? 0.8f : 1.3f, beyond = within ? 0.0f : 0.1f;
    std::vector<Vertex> vertices;
    for (int i = 0; i < 24; ++i) {
      const float w = random_.real(0.5f, 2);
      vertices.push_back({{random_.real(-reach, reach) * w, random_.real(-reach, reach) * w,
                           random_.real(-beyond, 1 + beyond) * w, w},
                          {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), 0}});
    }
    choose(vertices, viewports);
    std::vector<std::byte> bytes(vertices.size() * sizeof(Vertex));
    std::memcpy(bytes.data(), vertices.data(), bytes.size());
    stream_.buffers.push_back({"vertices", std::move(bytes)});
    stream_.commands.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    stream_.commands.emplace_back(
        traces::BindVertexBuffer{0, static_cast<Index>(stream_.buffers.size() - 1), 0});
    traces::Draw draw;
    draw.count = static_cast<std::uint32_t>(vertices.size());
    stream_.commands.emplace_back(draw);
  }

  RandomSource random_;
  std::uint32_t samples_;
  bool agreeing_;
  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream viewports_stream(std::uint64_t seed, std::uint32_t samples, bool agreeing) {
  return Maker(seed, samples, agreeing).make();
}

}  // namespace quadrille::pipeline::test
