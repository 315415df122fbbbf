#include "tests/pipeline/texture_card.h"

#include "models/texture/block/astc_header.h"
#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <span>

namespace quadrille::pipeline::test {
namespace {

using models::Numeric;
using traces::Format;
using traces::Index;

constexpr const char* kVertex = R"(#version 450
void main() {
  gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
})";

std::uint32_t random_word(RandomSource& random) {
  return static_cast<std::uint32_t>(random.integer(0, 0xffff)) << 16 |
         static_cast<std::uint32_t>(random.integer(0, 0xffff));
}

/// A float below 2 of a small format: sign, five bits of exponent, mantissa.
std::uint32_t small_float(RandomSource& random, int mantissa_bits, bool has_sign) {
  const auto exponent = static_cast<std::uint32_t>(random.integer(9, 15));
  const std::uint32_t mantissa = random_word(random) & ((1u << mantissa_bits) - 1);
  const std::uint32_t sign = has_sign ? random_word(random) & 1u : 0;
  return (sign << 5 | exponent) << mantissa_bits | mantissa;
}

std::uint32_t random_code(RandomSource& random, const models::ComponentBits& component, bool depth) {
  if (component.numeric == Numeric::kUfloat) return small_float(random, component.bits - 5, false);
  if (component.numeric == Numeric::kFloat && component.bits == 16) return small_float(random, 10, true);
  if (component.numeric == Numeric::kFloat)
    return std::bit_cast<std::uint32_t>(depth ? random.real(0, 1) : random.real(-2, 2));
  return static_cast<std::uint32_t>(random_word(random) & ((std::uint64_t{1} << component.bits) - 1));
}

models::PixelCode random_texel(RandomSource& random, Format format) {
  const models::FormatInfo& info = models::format_info(format);
  models::PixelCode code;
  for (std::size_t c = 0; c < info.channels; ++c) {
    const models::ComponentBits& component = info.component[c];
    code.word[component.shift / 32] |= random_code(random, component, info.may(models::kDepthUse))
                                       << component.shift % 32;
  }
  if (info.numeric == Numeric::kSharedExponent)
    code.word[0] |= static_cast<std::uint32_t>(random.integer(10, 16)) << 27;
  return code;
}

/// Of most patterns ASTC makes magenta: seven blocks of eight are drawn again until they are legal.
void make_legal(traces::Image& image, RandomSource& random) {
  constexpr std::size_t kBytes = 16;
  const models::FormatInfo& info = models::format_info(image.format);
  for (std::size_t at = 0; at < image.texels.size(); at += kBytes) {
    const std::span block(image.texels.data() + at, kBytes);
    while (at / kBytes % 8 != 7 &&
           !models::astc_header(models::AstcBits(block), info.block_width, info.block_height))
      for (std::byte& byte : block) byte = static_cast<std::byte>(random.integer(0, 255));
  }
}

/// Blocks of chance; of floats in the mode of two ends of ten bits, below 2.
void random_blocks(traces::Image& image, std::uint64_t seed) {
  RandomSource random(seed);
  for (std::byte& byte : image.texels) byte = static_cast<std::byte>(random.integer(0, 255));
  if (models::is_astc_format(image.format)) return make_legal(image, random);
  const bool is_signed = image.format == Format::kBc6hSfloat;
  if (!is_signed && image.format != Format::kBc6hUfloat) return;
  constexpr std::uint32_t kTwoEnds = 3, kModeBits = 5, kEndBits = 10, kEnds = 6;
  for (std::size_t at = 0; at < image.texels.size(); at += 16) {
    std::uint64_t low = kTwoEnds;
    for (std::uint32_t end = 0; end < kEnds; ++end)
      low |= static_cast<std::uint64_t>(random.integer(0, is_signed ? 255 : 511))
             << (kModeBits + kEndBits * end);
    std::memcpy(image.texels.data() + at, &low, sizeof low);
  }
}

const char* letter(Format format) {
  switch (traces::number_kind(format)) {
    case traces::NumberKind::kUint: return "u";
    case traces::NumberKind::kSint: return "i";
    case traces::NumberKind::kFloat: break;
  }
  return "";
}

constexpr std::array<std::string_view, 7> kGlslKinds{"2D",      "1D",      "3D",       "Cube",
                                                     "1DArray", "2DArray", "CubeArray"};

/// Declares `t` and the place that a picture shows.
std::string declarations(const TextureCard& card) {
  const std::string kind =
      fmt::format("{}{}", kGlslKinds.at(static_cast<std::size_t>(card.view)), card.shadow ? "Shadow" : "");
  const std::string l = letter(card.image.format);
  std::string text = "#version 450\n";
  if (card.separate)
    text += fmt::format(
        "#extension GL_EXT_samplerless_texture_functions : require\n"
        "layout(set = 0, binding = 0) uniform {0}texture{1} image;\n"
        "layout(set = 0, binding = 1) uniform sampler{2} state;\n#define t {0}sampler{3}(image, state)\n",
        l, kGlslKinds.at(static_cast<std::size_t>(card.view)), card.shadow ? "Shadow" : "", kind);
  else text += fmt::format("layout(set = 0, binding = 0) uniform {}sampler{} t;\n", l, kind);
  return text + "layout(push_constant) uniform Place { vec2 step, first, size; };\n";
}

/// Directions towards nine squares, each a face and a little more.
constexpr const char* kDirections = R"(
vec3 direction(vec2 place) {
  ivec2 cell = ivec2(place) / 16;
  vec2 q = (mod(place, 16.0) - 8.0) / 7.13;
  int face = (cell.x + 3 * cell.y) % 6;
  return face == 0 ? vec3(1, -q.y, -q.x) : face == 1 ? vec3(-1, -q.y, q.x) : face == 2 ? vec3(q.x, 1, q.y)
       : face == 3 ? vec3(q.x, -1, -q.y) : face == 4 ? vec3(q.x, -q.y, 1) : vec3(-q.x, -q.y, -1);
}
)";

/// `o` becomes what is asked.
std::string body(const TextureCard& card, std::string_view place) {
  const std::string shown =
      traces::is_integer_format(card.image.format)
          ? fmt::format("uvec4 v = uvec4({});\n  o = {}.x < {}.0 ? vec4(v & 0xffffu) : vec4(v >> 16);",
                        card.sample, place, kCardSide / 2)
          : fmt::format("o = {};", card.sample);
  return fmt::format(
      "{}void main() {{\n  vec2 place = {};\n  vec2 at = place * step + first, uv = at / size;\n"
      "  vec3 dir = direction(place);\n  {}\n",
      kDirections, place, shown);
}

std::string vertex(const TextureCard& card) {
  if (!card.in_vertex) return kVertex;
  return declarations(card) + "layout(location = 0) out vec4 o;\n" +
         body(card, "vec2(float(gl_VertexIndex) * 7.0 + 0.5, float(gl_VertexIndex) * 3.0 + 0.5)") +
         "  gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, "
         "1.0);\n}";
}

std::string fragment(const TextureCard& card) {
  if (card.in_vertex)
    return "#version 450\nlayout(location = 0) in vec4 v;\nlayout(location = 0) out vec4 o;\nvoid main() { o "
           "= v; }";
  return declarations(card) + "layout(location = 0) out vec4 o;\n" + body(card, "gl_FragCoord.xy") + "}";
}

Index add_shader(traces::CommandStream& stream, const std::string& source, traces::ShaderStage stage) {
  stream.shaders.push_back({"card", stage, scenes::compile_glsl(source, stage, "card")});
  return static_cast<Index>(stream.shaders.size() - 1);
}

std::vector<std::byte> place_of(const TextureCard& card) {
  const std::array<float, 6> numbers{card.step[0],
                                     card.step[1],
                                     card.first[0],
                                     card.first[1],
                                     static_cast<float>(card.image.width),
                                     static_cast<float>(card.image.height)};
  std::vector<std::byte> bytes(sizeof numbers);
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

}  // namespace

traces::Image card_image(Format format, std::uint32_t width, std::uint32_t height, std::uint32_t levels,
                         std::uint64_t seed) {
  return card_image(format, traces::ImageKind::k2D, {width, height, 1}, 1, levels, seed);
}

traces::Image card_image(Format format, traces::ImageKind kind, const std::array<std::uint32_t, 3>& size,
                         std::uint32_t layers, std::uint32_t levels, std::uint64_t seed) {
  traces::Image image;
  image.name = "card";
  image.format = format;
  image.kind = kind;
  image.width = size[0];
  image.height = size[1];
  image.depth = size[2];
  image.layers = layers;
  image.levels = levels;
  image.texels.resize(traces::texel_bytes(image));
  if (models::is_block_format(format)) {
    random_blocks(image, seed);
    return image;
  }
  RandomSource random(seed);
  const std::size_t bytes = models::format_bytes(format);
  for (std::size_t at = 0; at < image.texels.size(); at += bytes) {
    const models::PixelCode code = random_texel(random, format);
    std::memcpy(image.texels.data() + at, code.word.data(), bytes);
  }
  return image;
}

traces::CommandStream card_stream(const TextureCard& card) {
  traces::CommandStream stream;
  stream.name = "card";
  traces::BeginPass pass = traces::make_pass(
      stream, {kCardSide, kCardSide, Format::kR32G32B32A32Float, Format::kUndefined}, {0, 0, 0, 0});
  stream.images.push_back(card.image);
  stream.samplers = {card.sampler};
  stream.descriptor_sets.emplace_back();
  traces::TextureDescriptor bound;
  bound.image = static_cast<Index>(stream.images.size() - 1);
  bound.view = card.view;
  bound.layer = card.first_layer;
  bound.layers = card.layers;
  bound.components = card.components;
  if (card.separate) stream.descriptor_sets[0].samplers = {{1, 0}};
  else bound.sampler = 0;
  stream.descriptor_sets[0].textures = {bound};
  traces::Pipeline pipeline;
  pipeline.vertex_shader = add_shader(stream, vertex(card), traces::ShaderStage::kVertex);
  pipeline.fragment_shader = add_shader(stream, fragment(card), traces::ShaderStage::kFragment);
  stream.pipelines.push_back(pipeline);
  auto& c = stream.commands;
  c.emplace_back(std::move(pass));
  c.emplace_back(traces::BindPipeline{0});
  c.emplace_back(traces::BindDescriptorSet{0, 0});
  c.emplace_back(traces::PushConstants{0, place_of(card)});
  constexpr auto kSide = static_cast<float>(kCardSide);
  c.emplace_back(traces::SetViewport{0, 0, kSide, kSide, 0, 1});
  c.emplace_back(traces::SetScissor{0, 0, kCardSide, kCardSide});
  traces::Draw draw;
  draw.count = 3;
  c.emplace_back(draw);
  c.emplace_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

std::vector<Format> texture_formats() {
  std::vector<Format> formats;
  for (int f = 0; f <= static_cast<int>(models::kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (models::format_info(format).may(models::kFileUse)) formats.push_back(format);
  }
  return formats;
}

/// A border that every format holds: floats between 0 and 1, or small integers.
std::array<std::uint32_t, 4> border_bits(bool integers) {
  if (integers) return {7, 3, 5, 2};
  return {std::bit_cast<std::uint32_t>(0.8f), std::bit_cast<std::uint32_t>(0.2f),
          std::bit_cast<std::uint32_t>(0.6f), std::bit_cast<std::uint32_t>(0.4f)};
}

std::vector<TextureCard> format_cards() {
  constexpr int kWraps = static_cast<int>(models::kLastWrap) + 1;
  std::vector<TextureCard> cards;
  int number = 0;
  for (const Format format : texture_formats()) {
    for (const bool linear : {false, true}) {
      if (linear && traces::is_integer_format(format)) continue;
      for (const bool levels : {false, true}) {
        TextureCard card;
        card.image = levels ? card_image(format, 16, 32, 5, static_cast<std::uint64_t>(number) + 1)
                            : card_image(format, 11, 7, 1, static_cast<std::uint64_t>(number) + 1);
        card.sampler.mag = card.sampler.min = card.sampler.mip =
            linear ? traces::Filter::kLinear : traces::Filter::kNearest;
        card.sampler.wrap_u = static_cast<traces::Wrap>(number % kWraps);
        card.sampler.wrap_v = static_cast<traces::Wrap>(number / 2 % kWraps);
        card.sampler.border = static_cast<traces::BorderColor>(number % 4);
        card.sampler.border_bits = border_bits(traces::is_integer_format(format));
        if (levels) card.step = {2.6f, 2.2f};
        card.first = levels ? std::array{-47.97f, -51.03f} : std::array{-12.0f, -9.0f};
        cards.push_back(std::move(card));
        ++number;
      }
    }
  }
  return cards;
}

std::string name_of(const TextureCard& card) {
  return fmt::format("{} {} {}x{} levels {} filter {} wrap {} {} border {}: {}",
                     models::kViewKindNames.at(static_cast<std::size_t>(card.view)),
                     models::format_info(card.image.format).name, card.image.width, card.image.height,
                     card.image.levels, static_cast<int>(card.sampler.mag),
                     static_cast<int>(card.sampler.wrap_u), static_cast<int>(card.sampler.wrap_v),
                     static_cast<int>(card.sampler.border), card.sample);
}

double card_tolerance(const TextureCard& card) {
  if (card.tolerance >= 0) return card.tolerance;
  const models::FormatInfo& info = models::format_info(card.image.format);
  const bool wide = models::is_float_format(card.image.format) || info.numeric == Numeric::kSnorm;
  // A weight of 1/256 more or less, of texels that differ by the whole range.
  return card.sampler.mag == traces::Filter::kNearest ? 1e-6 : (wide ? 4.0 : 1.0) / 255.0 + 1e-6;
}

}  // namespace quadrille::pipeline::test
