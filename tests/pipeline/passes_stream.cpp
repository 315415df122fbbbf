#include "tests/pipeline/passes_stream.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <array>
#include <cstring>
#include <string>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
void main() { gl_Position = position; v_color = color; })";

constexpr const char* kThreeColors = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 a; layout(location = 1) out vec4 b; layout(location = 2) out vec4 c;
void main() { a = v_color; b = vec4(v_color.bgr, 0.5); c = vec4(v_color.gbr * 0.5, 1.0); })";

constexpr const char* kHoles = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 a;
void main() { if (fract(v_color.r * 5.0) < 0.3) discard; a = v_color; })";

constexpr const char* kNothing = R"(#version 450
void main() {})";

constexpr const char* kWholePicture = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
  uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
})";

constexpr const char* kMix = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler2D a; layout(set = 0, binding = 1) uniform sampler2D b;
layout(set = 0, binding = 2) uniform sampler2D c; layout(set = 0, binding = 3) uniform sampler2D d;
layout(set = 0, binding = 4) uniform sampler2D e;
void main() {
  vec3 left = mix(texture(a, uv).rgb, texture(b, uv).rgb, 0.5);
  vec3 right = texture(c, uv * 0.9 + 0.05).rgb + texture(c, uv).a * 0.1;
  o = vec4(mix(left, right, 0.4) * (0.4 + 0.3 * texture(d, uv).r + 0.3 * texture(e, uv).r), 1.0);
})";

struct Vertex {
  float position[4], color[4];
};

/// Of the depth attachments, by the same choice as the colours; later passes load and sample them.
constexpr std::array<std::array<Format, 2>, 4> kDepthFormats{{{Format::kD32Float, Format::kD32Float},
                                                              {Format::kD24UnormS8Uint, Format::kD16Unorm},
                                                              {Format::kD32FloatS8Uint, Format::kD32Float},
                                                              {Format::kD16Unorm, Format::kD24UnormS8Uint}}};
/// Of the first pass's three colour attachments and of the picture. Pixels of 1, 2, 4, 8 and 16 bytes.
constexpr std::array<std::array<Format, 4>, 4> kFormats{
    {{Format::kR8G8B8A8Unorm, Format::kB8G8R8A8Srgb, Format::kA2B10G10R10Unorm, Format::kR8G8B8A8Srgb},
     {Format::kR16G16B16A16Float, Format::kR8Unorm, Format::kB10G11R11Ufloat, Format::kR16G16B16A16Float},
     {Format::kR16G16Float, Format::kR32G32B32A32Float, Format::kR16Float, Format::kR8G8B8A8Srgb},
     {Format::kR32G32Float, Format::kR8G8Unorm, Format::kR32Float, Format::kR16G16B16A16Float}}};

class Maker {
 public:
  Maker(std::uint64_t seed, std::uint32_t width, std::uint32_t height)
      : random_(seed), width_(width), height_(height) {
    const std::array<Format, 4>& formats = kFormats[seed % kFormats.size()];
    for (std::size_t i = 0; i < 3; ++i) add_image(formats[i], traces::kColorAttachment);
    for (const Format depth : kDepthFormats[seed % kFormats.size()])
      add_image(depth, traces::kDepthAttachment);
    add_image(formats[3], traces::kColorAttachment);
    stream_.name = "passes";
    stream_.samplers.resize(2);
    stream_.samplers[0].mip = traces::Filter::kNearest;
    stream_.samplers[1].mag = stream_.samplers[1].min = traces::Filter::kNearest;
    stream_.descriptor_sets = {{{}, {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 1}, {4, 4, 1}}}};
  }

  traces::CommandStream make() {
    traces::Pipeline three = pipeline(kVertex, kThreeColors);
    three.blend[1].enable = true;
    three.blend[1].src_color = traces::BlendFactor::kSrcAlpha;
    three.blend[1].dst_color = traces::BlendFactor::kOneMinusSrcAlpha;
    three.blend[2].write_mask = 0xb;
    pass({color(0), color(1), color(2)}, depth(3), {three}, 12);
    pass({color(0, traces::LoadOp::kLoad)}, depth(3, traces::LoadOp::kLoad),
         {pipeline(kVertex, kHoles), pipeline(kVertex, kHoles)}, 6);
    pass({}, depth(4), {pipeline(kVertex, kNothing)}, 8);
    traces::Pipeline whole = pipeline(kWholePicture, kMix);
    whole.bindings.clear();
    whole.attributes.clear();
    whole.depth = {};
    pass({color(5, traces::LoadOp::kDontCare)}, {}, {whole}, 1);
    traces::Pipeline over = pipeline(kVertex, kHoles);
    over.depth = {};
    over.blend[0].enable = true;
    over.blend[0].src_color = traces::BlendFactor::kSrcAlpha;
    over.blend[0].dst_color = traces::BlendFactor::kOneMinusSrcAlpha;
    pass({color(5, traces::LoadOp::kLoad)}, {}, {over}, 3);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  void add_image(Format format, traces::ImageUsage usage) {
    traces::Image image;
    image.name = std::to_string(stream_.images.size());
    image.format = format;
    image.width = width_;
    image.height = height_;
    image.usage = static_cast<std::uint8_t>(usage | traces::kSampled);
    stream_.images.push_back(image);
  }

  traces::ColorAttachmentUse color(Index image, traces::LoadOp load = traces::LoadOp::kClear) {
    traces::ColorAttachmentUse use;
    use.image = image;
    use.load = load;
    use.clear = {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), 1};
    return use;
  }
  static traces::DepthAttachmentUse depth(Index image, traces::LoadOp load = traces::LoadOp::kClear) {
    traces::DepthAttachmentUse use;
    use.image = image;
    use.load = load;
    return use;
  }

  Index shader(const char* source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"passes", stage, scenes::compile_glsl(source, stage, "passes")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  traces::Pipeline pipeline(const char* vertex, const char* fragment) {
    traces::Pipeline p;
    p.vertex_shader = shader(vertex, traces::ShaderStage::kVertex);
    p.fragment_shader = shader(fragment, traces::ShaderStage::kFragment);
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
    p.depth = {true, true, traces::CompareOp::kLess};
    return p;
  }

  Index triangles(int count) {
    std::vector<Vertex> vertices;
    vertices.reserve(3 * static_cast<std::size_t>(count));
    for (int i = 0; i < 3 * count; ++i)
      vertices.push_back(
          {{random_.real(-1.2f, 1.2f), random_.real(-1.2f, 1.2f), random_.real(0, 1), 1},
           {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), random_.real(0.2f, 1)}});
    std::vector<std::byte> bytes(vertices.size() * sizeof(Vertex));
    std::memcpy(bytes.data(), vertices.data(), bytes.size());
    stream_.buffers.push_back({"triangles", std::move(bytes)});
    return static_cast<Index>(stream_.buffers.size() - 1);
  }

  /// A pass of one draw for each pipeline, of `count` triangles.
  void pass(std::vector<traces::ColorAttachmentUse> colors, const traces::DepthAttachmentUse& depth,
            const std::vector<traces::Pipeline>& pipelines, int count) {
    auto& c = stream_.commands;
    c.emplace_back(traces::BeginPass{std::move(colors), depth});
    c.emplace_back(traces::SetViewport{0, 0, static_cast<float>(width_), static_cast<float>(height_), 0, 1});
    c.emplace_back(traces::SetScissor{0, 0, width_, height_});
    for (const traces::Pipeline& p : pipelines) {
      stream_.pipelines.push_back(p);
      c.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
      if (p.bindings.empty()) c.emplace_back(traces::BindDescriptorSet{0, 0});
      else c.emplace_back(traces::BindVertexBuffer{0, triangles(count), 0});
      traces::Draw draw;
      draw.count = static_cast<std::uint32_t>(3 * count);
      c.emplace_back(draw);
    }
    c.emplace_back(traces::EndPass{});
  }

  RandomSource random_;
  std::uint32_t width_, height_;
  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream passes_stream(std::uint64_t seed, std::uint32_t width, std::uint32_t height) {
  return Maker(seed, width, height).make();
}

}  // namespace quadrille::pipeline::test
