#include "tests/pipeline/states_stream.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_states.h"

#include <array>
#include <cstring>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
void main() { gl_Position = position; v_color = color; })";

constexpr const char* kPlain = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { o = v_color; })";
constexpr const char* kDiscards = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { if ((int(gl_FragCoord.x) ^ int(gl_FragCoord.y)) % 3 == 0) discard; o = v_color; })";
constexpr const char* kWritesDepth = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { o = v_color; gl_FragDepth = (int(gl_FragCoord.x) & 4) != 0 ? 0.25 : 0.75; })";
constexpr const char* kEarly = R"(#version 450
layout(early_fragment_tests) in;
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { if ((int(gl_FragCoord.x) & 3) == 1) discard; o = v_color; })";
constexpr const char* kEarlyDepth = R"(#version 450
layout(early_fragment_tests) in;
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { o = v_color; gl_FragDepth = 0.125; })";
constexpr const char* kTwoColors = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0, index = 0) out vec4 o;
layout(location = 0, index = 1) out vec4 second;
void main() { o = v_color; second = vec4(v_color.gbr, 0.25); })";

constexpr int kTwoColorsShader = 5;  ///< the last fragment shader of the stream; a vertex shader follows

struct Vertex {
  float position[4], color[4];
};

class Maker {
 public:
  Maker(std::uint64_t seed, std::uint32_t width, std::uint32_t height, const StatesOptions& options)
      : random_(seed), options_(options) {
    // The last one is left out beside drivers that round it toward zero, as they may.
    constexpr std::array kColors{Format::kR8G8B8A8Unorm,     Format::kR8G8B8A8Srgb,
                                 Format::kR16G16B16A16Float, Format::kA2B10G10R10Unorm,
                                 Format::kR8G8Unorm,         Format::kR32G32B32A32Float,
                                 Format::kB8G8R8A8Unorm,     Format::kB10G11R11Ufloat};
    constexpr std::array kDepths{Format::kD32Float, Format::kD16Unorm, Format::kD24UnormS8Uint,
                                 Format::kD32FloatS8Uint, Format::kD24UnormS8Uint};
    stream_.name = "states";
    for (const char* source : {kPlain, kDiscards, kWritesDepth, kEarly, kEarlyDepth, kTwoColors})
      shader(source, traces::ShaderStage::kFragment);
    shader(kVertex, traces::ShaderStage::kVertex);
    pass_ = traces::make_pass(
        stream_,
        {width, height, kColors[static_cast<std::size_t>(random_.integer(0, options.small_floats ? 7 : 6))],
         kDepths[static_cast<std::size_t>(random_.integer(0, 4))]},
        {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), random_.real(0, 1)},
        random_.chance(0.8) ? 1.0f : 0.0f);
    pass_.depth.clear_stencil = static_cast<std::uint8_t>(random_.integer(0, 3));
    commands_ = {pass_,
                 traces::SetViewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1},
                 traces::SetScissor{0, 0, width, height}};
  }

  traces::CommandStream make() {
    for (int i = 0; i < options_.draws; ++i) draw();
    commands_.emplace_back(traces::EndPass{});
    stream_.commands = commands_;
    traces::use_samples(stream_, options_.samples);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  /// Few values, so that depths are often equal, and none in the middle between two of a format's.
  float depth_value() { return static_cast<float>(random_.integer(1, 5)) / 8.0f + 1.0f / 1024; }

  void shader(const char* source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"states", stage, scenes::compile_glsl(source, stage, "states")});
  }

  void blending(traces::Pipeline& p, bool second_source) {
    traces::BlendState& blend = p.blend[0];
    const int last =
        static_cast<int>(second_source ? models::kLastBlendFactor : traces::BlendFactor::kSrcAlphaSaturate);
    const auto factor = [&] { return static_cast<traces::BlendFactor>(random_.integer(0, last)); };
    blend.enable = second_source || random_.chance(0.5);
    blend.src_color = factor();
    blend.dst_color = factor();
    blend.src_alpha = factor();
    blend.dst_alpha = factor();
    if (second_source) blend.dst_color = traces::BlendFactor::kOneMinusSrc1Color;
    blend.color = static_cast<traces::BlendOp>(random_.integer(0, 4));
    blend.alpha = static_cast<traces::BlendOp>(random_.integer(0, 4));
    if (random_.chance(0.25)) blend.write_mask = static_cast<std::uint8_t>(random_.integer(0, 15));
    p.blend_shared.constants = {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1),
                                random_.real(0, 1)};
    const Format format = stream_.images[pass_.colors[0].image].format;
    const bool integers = format == Format::kR8G8B8A8Unorm || format == Format::kB8G8R8A8Unorm;
    p.blend_shared.logic = integers && !second_source && random_.chance(0.15);
    p.blend_shared.logic_op = static_cast<traces::LogicOp>(random_.integer(0, 15));
  }

  traces::Pipeline pipeline() {
    traces::Pipeline p;
    const int shader = random_.integer(0, kTwoColorsShader);
    p.fragment_shader = static_cast<Index>(shader);
    p.vertex_shader = kTwoColorsShader + 1;
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
    p.front = random_.chance(0.5) ? traces::FrontFace::kClockwise : traces::FrontFace::kCounterClockwise;
    p.depth = {random_.chance(0.8), random_.chance(0.7),
               static_cast<traces::CompareOp>(random_.integer(0, 7))};
    if (random_.chance(0.5)) p.depth.compare = traces::CompareOp::kLessOrEqual;
    p.stencil = {random_.chance(0.6), random_stencil_face(random_), random_stencil_face(random_)};
    if (options_.depth_bounds) p.depth_bounds = {random_.chance(0.2), 0.2f, 0.6f};
    if (random_.chance(0.3)) p.depth_bias = {true, static_cast<float>(random_.integer(-3000, 3000)), 0.5f, 0};
    if (p.depth_bias.enable && random_.chance(0.3)) p.depth_bias.clamp = random_.chance(0.5) ? 0.01f : -0.01f;
    blending(p, shader == kTwoColorsShader);
    return p;
  }

  /// Rectangles at one depth, facing either way.
  void draw() {
    std::vector<Vertex> vertices;
    for (int i = 0; i < 3; ++i) {
      const float x0 = random_.real(-1, 0.5f), y0 = random_.real(-1, 0.5f), x1 = random_.real(x0, 1),
                  y1 = random_.real(y0, 1), z = depth_value();
      const float c[4] = {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), random_.real(0, 1)};
      const bool turned = random_.chance(0.5);
      const float corner[6][2] = {{x0, y0}, {x1, y0}, {x0, y1}, {x1, y0}, {x1, y1}, {x0, y1}};
      for (std::size_t k = 0; k < 6; ++k) {
        const auto& at = corner[turned ? 5 - k : k];
        vertices.push_back({{at[0], at[1], z, 1}, {c[0], c[1], c[2], c[3]}});
      }
    }
    traces::Buffer buffer{"vertices", std::vector<std::byte>(vertices.size() * sizeof(Vertex))};
    std::memcpy(buffer.data.data(), vertices.data(), buffer.data.size());
    const auto number = static_cast<Index>(stream_.buffers.size());
    stream_.buffers.push_back(std::move(buffer));
    stream_.pipelines.push_back(pipeline());
    traces::Draw draw;
    draw.count = static_cast<std::uint32_t>(vertices.size());
    commands_.insert(commands_.end(),
                     {traces::BindPipeline{number}, traces::BindVertexBuffer{0, number, 0}, draw});
  }

  RandomSource random_;
  StatesOptions options_;
  traces::CommandStream stream_;
  traces::BeginPass pass_;
  std::vector<traces::Command> commands_;
};

}  // namespace

traces::CommandStream states_stream(std::uint64_t seed, std::uint32_t width, std::uint32_t height,
                                    const StatesOptions& options) {
  return Maker(seed, width, height, options).make();
}

}  // namespace quadrille::pipeline::test
