#include "tests/pipeline/random_pipelines.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_states.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

constexpr std::size_t kMostTargets = 4;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color; layout(location = 1) flat out vec4 v_flat;
void main() { gl_Position = position; gl_PointSize = 1.0 + 4.0 * color.r; v_color = color; v_flat = color.bgra; })";

/// What the targets hold, each.
using Kinds = std::array<models::NumberKind, kMostTargets>;

/// A colour as what a target holds. Integers are few and fit into 8 bits.
std::string converted(models::NumberKind kind, const std::string& color) {
  if (kind == models::NumberKind::kFloat) return color;
  const bool is_signed = kind == models::NumberKind::kSint;
  return (is_signed ? "ivec4(" : "uvec4(") + ("clamp(" + color + ", 0.0, 1.0) * 7.0) * ") +
         (is_signed ? "31 - 100" : "31u");
}

/// Every program has outputs for all targets.
std::string head(const Kinds& kinds) {
  constexpr std::array kTypes{"vec4", "uvec4", "ivec4"};
  constexpr std::array kColors{"c", "c.gbra", "1.0 - c", "v_flat"};
  std::string text =
      "#version 450\nlayout(location = 0) in vec4 v_color; layout(location = 1) flat in vec4 v_flat;\n";
  std::string body;
  for (std::size_t i = 0; i < kMostTargets; ++i) {
    const std::string name = "o" + std::to_string(i);
    text += "layout(location = " + std::to_string(i) + ") out " + kTypes[static_cast<std::size_t>(kinds[i])] +
            " " + name + ";\n";
    body += name + " = " + converted(kinds[i], std::string("(") + kColors[i] + ")") + "; ";
  }
  return text + "void put(vec4 c) { " + body + "}\n";
}
constexpr std::array kBodies{
    "void main() { put(v_color); }",
    "void main() { put(v_flat); }",
    "void main() { if ((int(gl_FragCoord.x) ^ int(gl_FragCoord.y)) % 3 == 0) discard; put(v_color); }",
    "void main() { put(v_color); gl_FragDepth = (int(gl_FragCoord.x) & 4) != 0 ? 0.25 : 0.75; }",
    "layout(early_fragment_tests) in;\n"
    "void main() { if ((int(gl_FragCoord.x) & 3) == 1) discard; put(v_color); }",
    "layout(early_fragment_tests) in;\nvoid main() { put(v_flat); gl_FragDepth = 0.125; }",
    "void main() { put(v_color); gl_SampleMask[0] = int(gl_FragCoord.y) % 2 == 0 ? 0x6 : 0xb; }",
    "void main() { put(gl_FrontFacing ? v_color : v_color.bgra); }",
    "void main() { vec4 s = vec4(0.0); for (int i = 0; i < int(gl_FragCoord.x) % 5; ++i) s += 0.2 * "
    "v_color;\n"
    "  put(s); }"};
constexpr const char* kTwoColors = R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 1) flat in vec4 v_flat;
layout(location = 0, index = 0) out vec4 o; layout(location = 0, index = 1) out vec4 second;
void main() { o = v_color; second = vec4(v_flat.rgb, 0.25); })";

constexpr auto kTwoColorsShader = static_cast<Index>(kBodies.size());  ///< the last fragment shader
constexpr Index kVertexShader = kTwoColorsShader + 1;

/// Made once for each choice of kinds.
const std::vector<traces::Shader>& shaders(const Kinds& kinds) {
  static std::map<Kinds, std::vector<traces::Shader>> all;
  std::vector<traces::Shader>& made = all[kinds];
  if (!made.empty()) return made;
  const auto add = [&](const std::string& text, traces::ShaderStage stage) {
    made.push_back({"pipelines", stage, scenes::compile_glsl(text, stage, "pipelines")});
  };
  for (const char* body : kBodies) add(head(kinds) + body, traces::ShaderStage::kFragment);
  add(kTwoColors, traces::ShaderStage::kFragment);
  add(kVertex, traces::ShaderStage::kVertex);
  return made;
}

std::vector<Format> formats_for(models::FormatUse use) {
  std::vector<Format> all;
  for (int f = 0; f <= static_cast<int>(models::kLastFormat); ++f)
    if (models::format_info(static_cast<Format>(f)).may(use)) all.push_back(static_cast<Format>(f));
  return all;
}

struct Vertex {
  float position[4], color[4];
};

class Maker {
 public:
  Maker(std::uint64_t seed, const PipelinesOptions& options)
      : random_(seed), integers_(~seed), options_(options) {
    stream_.name = "pipelines";
    begin_pass();
    stream_.shaders = shaders(kinds_);
    const auto side = static_cast<float>(options.side);
    stream_.commands.emplace_back(traces::SetViewport{0, 0, side, side, 0, 1});
  }

  traces::CommandStream make() {
    for (int i = 0; i < options_.draws; ++i) draw();
    stream_.commands.emplace_back(traces::EndPass{});
    traces::use_samples(stream_, options_.samples);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  Format pick(std::vector<Format> formats) {
    if (!options_.small_floats) std::erase(formats, Format::kB10G11R11Ufloat);
    return formats[static_cast<std::size_t>(random_.integer(0, static_cast<int>(formats.size()) - 1))];
  }

  /// One in five holds integers, which no other choice depends on.
  Format pick_color() {
    const Format other = pick(formats_for(models::kBlendUse));
    if (!integers_.chance(0.2)) return other;
    std::vector<Format> formats = formats_for(models::kColorUse);
    std::erase_if(formats, [](Format f) { return !models::is_integer_format(f); });
    return formats[static_cast<std::size_t>(integers_.integer(0, static_cast<int>(formats.size()) - 1))];
  }

  void begin_pass() {
    const Format depth = random_.chance(0.9) ? pick(formats_for(models::kDepthUse)) : Format::kUndefined;
    traces::BeginPass pass = traces::make_pass(stream_, {options_.side, options_.side, pick_color(), depth},
                                               color(), random_.chance(0.8) ? 1.0f : 0.0f);
    pass.depth.clear_stencil = static_cast<std::uint8_t>(random_.integer(0, 3));
    targets_ = static_cast<std::size_t>(random_.integer(1, kMostTargets));
    while (pass.colors.size() < targets_) {
      traces::Image image;
      image.name = "target";
      image.format = pick_color();
      image.width = image.height = options_.side;
      image.usage = traces::kColorAttachment;
      stream_.images.push_back(image);
      traces::ColorAttachmentUse use;
      use.image = static_cast<Index>(stream_.images.size() - 1);
      use.clear = color();
      pass.colors.push_back(use);
    }
    depths_ = depth;
    for (std::size_t i = 0; i < targets_; ++i) {
      kinds_[i] = models::number_kind(stream_.images[pass.colors[i].image].format);
      pass.colors[i].clear_integers.fill(static_cast<std::uint32_t>(integers_.integer(0, 100)));
    }
    colors_ = pass.colors;
    stream_.commands.emplace_back(pass);
  }

  std::array<float, 4> color() {
    return {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), random_.real(0, 1)};
  }
  /// Few values, so that depths are often equal, and none in the middle between two of a format's.
  float depth_value() { return static_cast<float>(random_.integer(1, 5)) / 8.0f + 1.0f / 1024; }

  traces::BlendState blend(bool second_source) {
    traces::BlendState b;
    const int last =
        static_cast<int>(second_source ? models::kLastBlendFactor : traces::BlendFactor::kSrcAlphaSaturate);
    const auto factor = [&] { return static_cast<traces::BlendFactor>(random_.integer(0, last)); };
    b.enable = second_source || random_.chance(0.4);
    b.src_color = factor();
    b.dst_color = second_source ? traces::BlendFactor::kOneMinusSrc1Color : factor();
    b.src_alpha = factor();
    b.dst_alpha = factor();
    b.color = static_cast<traces::BlendOp>(random_.integer(0, 4));
    b.alpha = static_cast<traces::BlendOp>(random_.integer(0, 4));
    if (random_.chance(0.25)) b.write_mask = static_cast<std::uint8_t>(random_.integer(0, 15));
    return b;
  }

  void colors(traces::Pipeline& p, bool second_source) {
    bool integers = !second_source;
    for (std::size_t i = 0; i < targets_; ++i) {
      p.blend[i] = blend(second_source && i == 0);
      const Format format = stream_.images[colors_[i].image].format;
      p.blend[i].enable = p.blend[i].enable && !models::is_integer_format(format);
      integers = integers && (format == Format::kR8G8B8A8Unorm || format == Format::kB8G8R8A8Unorm ||
                              models::is_integer_format(format));
    }
    p.blend_shared.constants = color();
    p.blend_shared.logic = integers && random_.chance(0.3);
    p.blend_shared.logic_op = static_cast<traces::LogicOp>(random_.integer(0, 15));
  }

  void depths(traces::Pipeline& p) {
    if (depths_ == Format::kUndefined) return;
    p.depth = {random_.chance(0.7), random_.chance(0.7),
               static_cast<traces::CompareOp>(random_.integer(0, 7))};
    if (random_.chance(0.5)) p.depth.compare = traces::CompareOp::kLessOrEqual;
    p.stencil = {random_.chance(0.5), random_stencil_face(random_), random_stencil_face(random_)};
    if (options_.depth_bounds) p.depth_bounds = {random_.chance(0.2), 0.2f, 0.6f};
    if (random_.chance(0.2)) p.depth_bias = {true, static_cast<float>(random_.integer(-3000, 3000)), 0.5f, 0};
    if (p.depth_bias.enable && random_.chance(0.3)) p.depth_bias.clamp = random_.chance(0.5) ? 0.01f : -0.01f;
  }

  void primitives(traces::Pipeline& p) {
    // Bresenham lines cover pixels, and what masks of samples do to them each driver decides.
    const int last =
        static_cast<int>(options_.samples > 1 ? traces::Topology::kPointList : traces::Topology::kLineStrip);
    if (random_.chance(0.5)) p.topology = static_cast<traces::Topology>(random_.integer(0, last));
    p.primitive_restart = !models::is_list(p.topology) && random_.chance(0.5);
    p.cull = static_cast<traces::CullMode>(std::max(0, random_.integer(-2, 2)));
    p.front = random_.chance(0.5) ? traces::FrontFace::kClockwise : traces::FrontFace::kCounterClockwise;
    p.depth_clamp = random_.chance(0.1);
  }

  traces::Pipeline pipeline() {
    traces::Pipeline p;
    p.name = "random";
    const bool floats = kinds_[0] == models::NumberKind::kFloat;
    const bool second_source = targets_ == 1 && random_.chance(0.15) && floats;
    p.fragment_shader =
        second_source ? kTwoColorsShader : static_cast<Index>(random_.integer(0, kTwoColorsShader - 1));
    p.vertex_shader = kVertexShader;
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
    primitives(p);
    depths(p);
    colors(p, second_source);
    const bool several = options_.samples > 1;
    p.sample_shading = several && options_.sample_shading && random_.chance(0.1);
    p.alpha_to_coverage = several && !p.sample_shading && random_.chance(0.1) && floats;
    if ((several || options_.sample_masks) && random_.chance(0.15))
      p.sample_mask = static_cast<std::uint32_t>(random_.integer(0, 15));
    return p;
  }

  /// Rectangles at one depth, facing either way, and triangles of any shape and perspective.
  std::vector<Vertex> mesh() {
    std::vector<Vertex> vertices;
    for (int i = random_.integer(1, 4); i > 0; --i) {
      const float z = depth_value();
      std::array<std::array<float, 2>, 6> at{};
      const bool rectangle = random_.chance(0.6);
      if (rectangle) {
        const float x0 = random_.real(-1, 0.5f), y0 = random_.real(-1, 0.5f), x1 = random_.real(x0, 1),
                    y1 = random_.real(y0, 1);
        at = {{{x0, y0}, {x1, y0}, {x0, y1}, {x1, y0}, {x1, y1}, {x0, y1}}};
        if (random_.chance(0.5)) std::ranges::reverse(at);
      } else {
        for (auto& corner : at) corner = {random_.real(-1, 1), random_.real(-1, 1)};
      }
      const std::array<float, 4> one = color();
      for (const auto& corner : at) {
        const float w = rectangle ? 1.0f : random_.real(0.5f, 2);
        const std::array<float, 4> c = rectangle ? one : color();
        vertices.push_back({{corner[0] * w, corner[1] * w, z * w, w}, {c[0], c[1], c[2], c[3]}});
      }
    }
    return vertices;
  }

  template <class T>
  Index buffer(const char* name, const std::vector<T>& values) {
    traces::Buffer made{name, std::vector<std::byte>(values.size() * sizeof(T))};
    std::memcpy(made.data.data(), values.data(), made.data.size());
    stream_.buffers.push_back(std::move(made));
    return static_cast<Index>(stream_.buffers.size() - 1);
  }

  void indices(const traces::Pipeline& p, traces::Draw& draw) {
    std::vector<std::uint16_t> values;
    for (std::uint32_t i = 0; i < draw.count; ++i) {
      const bool ends = p.primitive_restart && random_.integer(0, 6) == 0;
      const bool other = random_.integer(0, 4) == 0;
      const int index = other ? random_.integer(0, static_cast<int>(draw.count) - 1) : static_cast<int>(i);
      values.push_back(ends ? std::uint16_t{0xffff} : static_cast<std::uint16_t>(index));
    }
    stream_.commands.emplace_back(
        traces::BindIndexBuffer{buffer("indices", values), 0, traces::IndexType::kUint16});
    draw.indexed = true;
  }

  void draw() {
    const std::vector<Vertex> vertices = mesh();
    stream_.pipelines.push_back(pipeline());
    auto& commands = stream_.commands;
    commands.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    commands.emplace_back(traces::BindVertexBuffer{0, buffer("vertices", vertices), 0});
    const auto most = static_cast<int>(options_.side);
    const bool cut = random_.chance(0.2) && (options_.samples == 1 || options_.sample_scissors);
    const auto x = cut ? random_.integer(0, most / 2) : 0;
    commands.emplace_back(traces::SetScissor{x, x / 2, options_.side - static_cast<std::uint32_t>(x),
                                             options_.side - static_cast<std::uint32_t>(x)});
    traces::Draw draw;
    draw.count = static_cast<std::uint32_t>(vertices.size());
    if (random_.chance(0.3)) draw.instances = 2;
    if (random_.chance(0.5)) indices(stream_.pipelines.back(), draw);
    commands.emplace_back(draw);
  }

  RandomSource random_, integers_;
  PipelinesOptions options_;
  traces::CommandStream stream_;
  Format depths_ = Format::kUndefined;
  std::size_t targets_ = 1;
  Kinds kinds_{};  ///< of the targets
  std::vector<traces::ColorAttachmentUse> colors_;
};

}  // namespace

traces::CommandStream random_pipelines(std::uint64_t seed, const PipelinesOptions& options) {
  return Maker(seed, options).make();
}

}  // namespace quadrille::pipeline::test
