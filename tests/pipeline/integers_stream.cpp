#include "tests/pipeline/integers_stream.h"

#include "models/rop/blend.h"
#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <string>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

constexpr std::uint32_t kWidth = 72, kHeight = 40;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 0) flat out uint seed;
void main() { gl_Position = position; seed = uint(gl_VertexIndex) * 0x9e3779b9u; })";

constexpr const char* kWholePicture = R"(#version 450
void main() {
  gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
})";

constexpr const char* kMixing = R"(
uint mixed(uint v) {
  v = (v ^ (v >> 16)) * 0x7feb352du;
  v = (v ^ (v >> 15)) * 0x846ca68bu;
  return v ^ (v >> 16);
}
)";

/// "ivec4" or "uvec4", without the size.
const char* letter(Format format) {
  return traces::number_kind(format) == traces::NumberKind::kSint ? "i" : "u";
}

/// Writes hashes that each format can hold: the high bits of a word, shifted down by its sign.
std::string writer(const std::vector<Format>& formats) {
  std::string text = std::string("#version 450\nlayout(location = 0) flat in uint seed;\n") + kMixing, body;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    text += fmt::format("layout(location = {0}) out {1}vec4 o{0};\n", i, letter(formats[i]));
    body += fmt::format("  o{0} = {1}vec4(h * {2}u) >> {3};\n", i, letter(formats[i]), 2 * i + 1,
                        32 - models::format_info(formats[i]).component[0].bits);
  }
  return text +
         "void main() {\n  uvec2 at = uvec2(gl_FragCoord.xy);\n"
         "  uvec4 h = uvec4(mixed(seed + at.x), mixed(seed ^ at.y), mixed(seed), mixed(at.x * 77u + "
         "at.y));\n" +
         body + "}";
}

/// Shows a hash of all that the attachments hold at a pixel.
std::string reader(const std::vector<Format>& formats) {
  std::string text = std::string("#version 450\nlayout(location = 0) out vec4 o;\n") + kMixing, body;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    text += fmt::format("layout(set = 0, binding = {0}) uniform {1}sampler2D t{0};\n", i, letter(formats[i]));
    body += fmt::format(
        "  v = uvec4(textureLod(t{0}, uv, 0.0));\n"
        "  h = mixed(h ^ v.x) + mixed(h ^ v.y) * 3u + mixed(h ^ v.z) * 5u + mixed(h ^ v.w) * 7u;\n",
        i);
  }
  return text +
         "void main() {\n  vec2 uv = gl_FragCoord.xy / vec2(textureSize(t0, 0));\n  uint h = 1u;\n  uvec4 "
         "v;\n" +
         body + "  o = vec4(uvec4(h, h >> 8, h >> 16, h >> 24) & 255u) / 255.0;\n}";
}

class Maker {
 public:
  Maker(std::uint64_t seed, const std::vector<Format>& formats) : random_(seed), formats_(formats) {
    stream_.name = "integers";
    stream_.samplers.resize(1);
    stream_.samplers[0].mag = stream_.samplers[0].min = stream_.samplers[0].mip = traces::Filter::kNearest;
    for (const Format format : formats) add_image(format, traces::kColorAttachment | traces::kSampled);
    add_image(Format::kD32Float, traces::kDepthAttachment);
    add_image(Format::kR8G8B8A8Unorm, traces::kColorAttachment);
  }

  traces::CommandStream make(std::uint32_t samples) {
    draw_integers();
    show();
    traces::use_samples(stream_, samples);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  void add_image(Format format, int usage) {
    traces::Image image;
    image.name = std::to_string(stream_.images.size());
    image.format = format;
    image.width = kWidth;
    image.height = kHeight;
    image.usage = static_cast<std::uint8_t>(usage);
    stream_.images.push_back(image);
  }

  Index shader(const std::string& source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"integers", stage, scenes::compile_glsl(source, stage, "integers")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  void begin(const traces::BeginPass& pass) {
    stream_.commands.emplace_back(pass);
    stream_.commands.emplace_back(
        traces::SetViewport{0, 0, static_cast<float>(kWidth), static_cast<float>(kHeight), 0, 1});
    stream_.commands.emplace_back(traces::SetScissor{0, 0, kWidth, kHeight});
  }

  void draw(const traces::Pipeline& pipeline, std::uint32_t count) {
    stream_.pipelines.push_back(pipeline);
    stream_.commands.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    traces::Draw draw;
    draw.count = count;
    stream_.commands.emplace_back(draw);
  }

  std::array<std::uint32_t, 4> clear_value(Format format) {
    std::array<std::uint32_t, 4> value{};
    for (std::uint32_t& word : value)
      word = static_cast<std::uint32_t>(random_.integer(0, 0xffff)) << 16 |
             static_cast<std::uint32_t>(random_.integer(0, 0xffff));
    const models::FormatInfo& info = models::format_info(format);
    for (std::size_t c = 0; c < info.channels; ++c) {
      const int down = 32 - info.component[c].bits;
      const bool is_signed = info.numeric == models::Numeric::kSint;
      value[c] = is_signed ? static_cast<std::uint32_t>(static_cast<std::int32_t>(value[c]) >> down)
                           : value[c] >> down;
    }
    return value;
  }

  void draw_integers() {
    traces::BeginPass pass;
    for (Index i = 0; i < formats_.size(); ++i) {
      traces::ColorAttachmentUse use;
      use.image = i;
      use.clear_integers = clear_value(formats_[i]);
      pass.colors.push_back(use);
    }
    pass.depth.image = static_cast<Index>(formats_.size());
    begin(pass);
    stream_.commands.emplace_back(traces::BindVertexBuffer{0, triangles(30), 0});
    traces::Pipeline p;
    p.vertex_shader = shader(kVertex, traces::ShaderStage::kVertex);
    p.fragment_shader = shader(writer(formats_), traces::ShaderStage::kFragment);
    p.bindings = {{0, 16, false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}};
    p.depth = {true, true, traces::CompareOp::kLess};
    draw(p, 45);
    for (std::size_t i = 0; i < formats_.size(); ++i)
      p.blend[i].write_mask = static_cast<std::uint8_t>(random_.integer(1, 14));
    draw(p, 66);
    p.depth.compare = traces::CompareOp::kAlways;
    for (std::size_t i = 0; i < formats_.size(); ++i) p.blend[i].write_mask = 0xf;
    p.blend_shared.logic = true;
    p.blend_shared.logic_op = random_.chance(0.5) ? traces::LogicOp::kXor : traces::LogicOp::kOrInverted;
    draw(p, 90);
    stream_.commands.emplace_back(traces::EndPass{});
  }

  void show() {
    traces::DescriptorSet set;
    for (std::uint32_t i = 0; i < formats_.size(); ++i) set.textures.push_back({i, i, 0});
    stream_.descriptor_sets.push_back(set);
    traces::BeginPass pass;
    pass.colors.resize(1);
    pass.colors[0].image = static_cast<Index>(formats_.size() + 1);
    begin(pass);
    stream_.commands.emplace_back(traces::BindDescriptorSet{0, 0});
    traces::Pipeline p;
    p.vertex_shader = shader(kWholePicture, traces::ShaderStage::kVertex);
    p.fragment_shader = shader(reader(formats_), traces::ShaderStage::kFragment);
    draw(p, 3);
    stream_.commands.emplace_back(traces::EndPass{});
  }

  Index triangles(int count) {
    std::vector<std::array<float, 4>> corners;
    corners.reserve(3 * static_cast<std::size_t>(count));
    for (int i = 0; i < 3 * count; ++i)
      corners.push_back({random_.real(-1, 1), random_.real(-1, 1), random_.real(0, 1), 1});
    std::vector<std::byte> bytes(corners.size() * sizeof corners[0]);
    std::memcpy(bytes.data(), corners.data(), bytes.size());
    stream_.buffers.push_back({"triangles", std::move(bytes)});
    return static_cast<Index>(stream_.buffers.size() - 1);
  }

  RandomSource random_;
  const std::vector<Format>& formats_;
  traces::CommandStream stream_;
};

}  // namespace

std::vector<Format> integer_formats() {
  std::vector<Format> formats;
  for (int f = 0; f <= static_cast<int>(models::kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (traces::is_integer_format(format) && models::format_info(format).may(models::kColorUse))
      formats.push_back(format);
  }
  return formats;
}

traces::CommandStream integers_stream(std::uint64_t seed, const std::vector<Format>& formats,
                                      std::uint32_t samples) {
  return Maker(seed, formats).make(samples);
}

}  // namespace quadrille::pipeline::test
