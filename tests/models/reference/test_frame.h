/// A command stream of one pass, built in a few lines: clip-space positions with a vec4 each, and GLSL for
/// both stages.
#pragma once

#include "models/reference/reference.h"
#include "tests/models/reference/lane_shader.h"

#include <algorithm>
#include <cstring>

namespace quadrille::models::reference::test {

/// A vertex as the default vertex shader takes it.
struct Vertex {
  std::array<float, 4> position{}, value{};
};

inline constexpr const char* kPassThrough =
    "#version 450\nlayout(location = 0) in vec4 position; layout(location = 1) in vec4 value; "
    "layout(location = 0) out vec4 v;\n"
    "void main() { gl_Position = position; v = value; }\n";
inline constexpr const char* kShowValue =
    "#version 450\nlayout(location = 0) in vec4 v; layout(location = 0) out vec4 o;\nvoid main() { o = v; "
    "}\n";

template <class T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

class TestFrame {
 public:
  TestFrame(std::uint32_t width, std::uint32_t height, traces::Format color = traces::Format::kR8G8B8A8Unorm,
            std::array<float, 4> clear = {0, 0, 0, 0}) {
    stream.commands.push_back(
        traces::make_pass(stream, {width, height, color, traces::Format::kD32Float}, clear));
    stream.commands.push_back(
        traces::SetViewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1});
    stream.commands.push_back(traces::SetScissor{0, 0, width, height});
  }

  /// A new pipeline, bound; change its state through the reference before the stream is rendered.
  traces::Pipeline& pipeline(const char* fragment = kShowValue, const char* vertex = kPassThrough) {
    traces::Pipeline p;
    p.vertex_shader = static_cast<traces::Index>(stream.shaders.size());
    p.fragment_shader = p.vertex_shader + 1;
    stream.shaders.push_back(glsl(vertex, traces::ShaderStage::kVertex));
    stream.shaders.push_back(glsl(fragment));
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, traces::Format::kR32G32B32A32Float, 0},
                    {1, 0, traces::Format::kR32G32B32A32Float, 16}};
    stream.pipelines.push_back(p);
    stream.commands.push_back(traces::BindPipeline{static_cast<traces::Index>(stream.pipelines.size() - 1)});
    return stream.pipelines.back();
  }

  traces::Index buffer(std::vector<std::byte> data) {
    stream.buffers.push_back({"data", std::move(data)});
    return static_cast<traces::Index>(stream.buffers.size() - 1);
  }

  void draw(const std::vector<Vertex>& vertices, std::uint32_t instances = 1) {
    stream.commands.push_back(traces::BindVertexBuffer{0, buffer(bytes_of(vertices)), 0});
    traces::Draw draw;
    draw.count = static_cast<std::uint32_t>(vertices.size()), draw.instances = instances;
    stream.commands.push_back(draw);
  }

  [[nodiscard]] Result render(const Options& options = {}) const {
    return reference::render(stream, options);
  }

  traces::CommandStream stream;
};

/// Two triangles over the whole target at one depth.
inline std::vector<Vertex> full_screen(std::array<float, 4> value, float z = 0.5f) {
  const Vertex a{{-1, -1, z, 1}, value}, b{{1, -1, z, 1}, value}, c{{1, 1, z, 1}, value},
      d{{-1, 1, z, 1}, value};
  return {a, b, c, a, c, d};
}

/// A vertex at a window position of a 16 x 16 target.
inline Vertex at(float x, float y, std::array<float, 4> value = {1, 1, 1, 1}, float z = 0.5f) {
  return {{x / 8 - 1, y / 8 - 1, z, 1}, value};
}

inline std::size_t count_covered(const Result& r) {
  return static_cast<std::size_t>(
      std::ranges::count_if(r.triangle_id, [](std::uint64_t id) { return id != kNoTriangle; }));
}

inline int channel(std::uint32_t rgba, int c) { return static_cast<int>((rgba >> (8 * c)) & 0xffu); }

}  // namespace quadrille::models::reference::test
