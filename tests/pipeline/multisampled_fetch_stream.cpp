#include "tests/pipeline/multisampled_fetch_stream.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <string_view>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;
using traces::ViewKind;

constexpr Index kColors = 0, kIntegers = 1, kDepths = 2, kResolve = 3, kPicture = 4;

constexpr std::string_view kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color; layout(location = 1) flat out uint seed;
void main() { gl_Position = position; v_color = color; seed = uint(gl_VertexIndex) * 0x9e3779b9u; })";

constexpr std::string_view kColor = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { o = v_color; })";

constexpr std::string_view kMixing = R"(
uint mixed(uint v) {
  v = (v ^ (v >> 16)) * 0x7feb352du;
  v = (v ^ (v >> 15)) * 0x846ca68bu;
  return v ^ (v >> 16);
}
)";

/// Of a triangle that holds the picture.
constexpr std::string_view kWholePicture = R"(#version 450
layout(location = 0) flat out vec4 picked;
PICKS
void main() {
  gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
  picked = FOUND;
})";

constexpr std::string_view kDeclared = R"(#version 450
layout(location = 0) flat in vec4 picked;
layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler2DMS one;
layout(set = 0, binding = 1) uniform sampler2DMSArray some;
layout(set = 0, binding = 2) uniform LETTERsampler2DMS words;
layout(set = 0, binding = 3) uniform sampler2DMS depths;
layout(set = 0, binding = 4) uniform sampler2D resolved;
)";

constexpr std::string_view kMeanBody = R"(
void main() {
  vec4 sum = vec4(0.0);
  for (int s = 0; s < textureSamples(one); ++s) sum += texelFetch(one, ivec2(gl_FragCoord.xy), s);
  o = sum / float(textureSamples(one));
})";
constexpr std::string_view kEverythingBody = R"(
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int count = textureSamples(one), chosen = (at.x + 3 * at.y) % textureSamples(some);
  vec4 c = texelFetch(some, ivec3(at, 1), chosen).gbra * 0.3 + texelFetch(some, ivec3(at, 0), 1) * 0.3;
  c += texelFetch(one, ivec2(at.y, at.x % textureSize(one).y), count - 1).brga * 0.2;
  c += vec4(texelFetch(depths, at, chosen).r) * 0.1;
  if ((at.x & 4) != 0) c += vec4(texelFetch(words, at, 0).x & 15) * 0.01;
  ivec3 size = textureSize(some);
  o = vec4(c.rgb + picked.rgb * 0.1, float(size.x + size.y + size.z + count + textureSize(depths).y) / 255.0);
})";
constexpr std::string_view kIntegersBody = R"(
void main() {
  uint h = 1u;
  for (int s = 0; s < textureSamples(words); ++s) {
    uvec4 v = uvec4(texelFetch(words, ivec2(gl_FragCoord.xy), s));
    h = mixed(h ^ v.x) + mixed(h ^ v.y) * 3u + mixed(h ^ v.z) * 5u + mixed(h ^ v.w) * 7u;
  }
  o = vec4(uvec4(h, h >> 8, h >> 16, h >> 24) & 255u) / 255.0;
})";
constexpr std::string_view kBeyondBody = R"(
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(one);
  int count = textureSamples(one) + (at.x & 1);
  vec4 all = abs(texelFetch(one, at, count)) + abs(texelFetch(one, at, -1 - at.x));
  all += abs(texelFetch(one, at + size, 0)) + abs(texelFetch(one, ivec2(at.x, -1), 1));
  all += abs(texelFetch(some, ivec3(at, 2), 0)) + abs(texelFetch(some, ivec3(at, 0), 99));
  uvec4 w = uvec4(texelFetch(words, at, count)) | uvec4(texelFetch(words, at + size, 0));
  o = vec4(all == vec4(0.0) && w == uvec4(0u) && texelFetch(depths, at, count).r == 0.0 ? 1.0 : 0.0);
})";

std::string replaced(std::string_view text, std::string_view what, std::string_view by) {
  std::string result(text);
  for (std::size_t at = result.find(what); at != std::string::npos; at = result.find(what))
    result.replace(at, what.size(), by);
  return result;
}

struct Vertex {
  float position[4], color[4];
};

class Maker {
 public:
  Maker(std::uint64_t seed, const FetchWish& wish) : random_(seed), wish_(wish) {
    stream_.name = "multisampled fetch";
    stream_.samplers.resize(1);  // filters between texels, which does not matter
    stream_.samplers[0].mag = stream_.samplers[0].min = traces::Filter::kLinear;
    add_image(wish.color, traces::kColorAttachment, wish.samples, 3);
    add_image(wish.integers, traces::kColorAttachment, wish.samples);
    add_image(wish.depth, traces::kDepthAttachment, wish.samples);
    add_image(wish.color, traces::kColorAttachment, 1);
    add_image(Format::kR8G8B8A8Unorm, traces::kColorAttachment, 1);
  }

  traces::CommandStream make() {
    draw_layer_1();
    draw_layer_2(traces::LoadOp::kClear, 8);
    draw_layer_2(traces::LoadOp::kLoad, 3);
    fetch();
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  void add_image(Format format, traces::ImageUsage usage, std::uint32_t samples, std::uint32_t layers = 1) {
    traces::Image image;
    image.name = std::to_string(stream_.images.size());
    image.format = format;
    image.width = kFetchWidth;
    image.height = kFetchHeight;
    image.samples = samples;
    image.layers = layers;
    image.usage = static_cast<std::uint8_t>(usage | traces::kSampled);
    stream_.images.push_back(image);
  }

  Index shader(const std::string& source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"fetch", stage, scenes::compile_glsl(source, stage, "fetch")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  [[nodiscard]] bool is_signed() const {
    return traces::number_kind(wish_.integers) == traces::NumberKind::kSint;
  }

  traces::ColorAttachmentUse color(Index image, std::uint32_t layer) {
    traces::ColorAttachmentUse use;
    use.image = image;
    use.layer = layer;
    use.clear = {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), 1};
    use.clear_integers = {7, 1, 2, 3};
    return use;
  }

  void draw_layer_1() {
    traces::BeginPass pass;
    pass.colors = {color(kColors, 1), color(kIntegers, 0)};
    pass.colors[0].resolve = kResolve;
    pass.depth.image = kDepths;
    const std::string kind = is_signed() ? "i" : "u";
    const int down = 32 - models::format_info(wish_.integers).component[0].bits;
    const std::string fragment = fmt::format(
        "#version 450\nlayout(location = 0) in vec4 v_color; layout(location = 1) flat in uint seed;\n"
        "layout(location = 0) out vec4 o; layout(location = 1) out {0}vec4 words;\n{1}"
        "void main() {{\n  uvec2 at = uvec2(gl_FragCoord.xy);\n  o = v_color;\n"
        "  words = {0}vec4(mixed(seed), mixed(seed + at.x), mixed(seed ^ at.y), mixed(at.x)) >> {2};\n}}",
        kind, kMixing, down);
    draw(pass, std::string(kVertex), fragment, 14);
  }

  void draw_layer_2(traces::LoadOp load, int triangles) {
    traces::BeginPass pass;
    pass.colors = {color(kColors, 2)};
    pass.colors[0].load = load;
    draw(pass, std::string(kVertex), std::string(kColor), triangles);
  }

  void fetch() {
    stream_.descriptor_sets = {{{},
                                {{0, kColors, 0, 0, 1, 1, ViewKind::k2DMultisampled},
                                 {1, kColors, 0, 0, 0, 1, ViewKind::k2DMultisampledArray, 2},
                                 {2, kIntegers, 0, 0, 1, 0, ViewKind::k2DMultisampled},
                                 {3, kDepths, 0, 0, 1, 0, ViewKind::k2DMultisampled},
                                 {4, kResolve, 0}}}};
    traces::BeginPass pass;
    pass.colors.resize(1);
    pass.colors[0].image = kPicture;
    const bool picks = wish_.shows == FetchShows::kEverything;
    const std::string vertex = replaced(
        replaced(kWholePicture, "PICKS",
                 picks ? "layout(set = 0, binding = 0) uniform sampler2DMS one;" : ""),
        "FOUND", picks ? "texelFetch(one, textureSize(one) / 2, textureSamples(one) / 2)" : "vec4(0.0)");
    draw(pass, vertex,
         replaced(kDeclared, "LETTER", is_signed() ? "i" : "u") + std::string(kMixing) + std::string(body()),
         0);
  }

  [[nodiscard]] std::string_view body() const {
    switch (wish_.shows) {
      case FetchShows::kResolved:
        return "void main() { o = texelFetch(resolved, ivec2(gl_FragCoord.xy), 0); }";
      case FetchShows::kMean: return kMeanBody;
      case FetchShows::kEverything: return kEverythingBody;
      case FetchShows::kIntegers: return kIntegersBody;
      case FetchShows::kBeyond: return kBeyondBody;
    }
    return {};
  }

  Index vertices(int triangles) {
    std::vector<Vertex> all;
    all.reserve(3 * static_cast<std::size_t>(triangles));
    for (int i = 0; i < 3 * triangles; ++i)
      all.push_back({{random_.real(-1, 1), random_.real(-1, 1), random_.real(0, 1), 1},
                     {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), 1}});
    std::vector<std::byte> bytes(all.size() * sizeof(Vertex));
    std::memcpy(bytes.data(), all.data(), bytes.size());
    stream_.buffers.push_back({"triangles", std::move(bytes)});
    return static_cast<Index>(stream_.buffers.size() - 1);
  }

  /// `triangles` 0: one that holds the picture, with the descriptor set.
  void draw(const traces::BeginPass& pass, const std::string& vertex, const std::string& fragment,
            int triangles) {
    auto& c = stream_.commands;
    c.emplace_back(pass);
    c.emplace_back(
        traces::SetViewport{0, 0, static_cast<float>(kFetchWidth), static_cast<float>(kFetchHeight), 0, 1});
    c.emplace_back(traces::SetScissor{0, 0, kFetchWidth, kFetchHeight});
    traces::Pipeline p;
    p.vertex_shader = shader(vertex, traces::ShaderStage::kVertex);
    p.fragment_shader = shader(fragment, traces::ShaderStage::kFragment);
    if (pass.depth.image != traces::kNone) p.depth = {true, true, traces::CompareOp::kLess};
    if (triangles > 0) {
      p.bindings = {{0, sizeof(Vertex), false}};
      p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
      c.emplace_back(traces::BindVertexBuffer{0, vertices(triangles), 0});
    } else {
      c.emplace_back(traces::BindDescriptorSet{0, 0});
    }
    stream_.pipelines.push_back(p);
    c.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    traces::Draw one;
    one.count = triangles == 0 ? 3 : static_cast<std::uint32_t>(3 * triangles);
    c.emplace_back(one);
    c.emplace_back(traces::EndPass{});
  }

  RandomSource random_;
  const FetchWish& wish_;
  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream multisampled_fetch_stream(std::uint64_t seed, const FetchWish& wish) {
  return Maker(seed, wish).make();
}

}  // namespace quadrille::pipeline::test
