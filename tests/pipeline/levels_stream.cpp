#include "tests/pipeline/levels_stream.h"

#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <array>
#include <cstring>
#include <string>

namespace quadrille::pipeline::test {
namespace {

using traces::Format;
using traces::Index;

constexpr Index kLevels = 0, kDepths = 1, kPicture = 2;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
void main() { gl_Position = position; v_color = color; })";
constexpr const char* kColor = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() { o = v_color; })";
constexpr const char* kWholePicture = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
  uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
})";
/// One level from the one above, and something else to a second attachment.
constexpr const char* kDown = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o; layout(location = 1) out vec4 other;
layout(set = 0, binding = 0) uniform sampler2D above;
void main() {
  o = texture(above, uv);
  other = vec4(o.gbr, float(textureSize(above, 0).x) / 255.0);
})";
constexpr const char* kShow = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler2D chain; layout(set = 0, binding = 1) uniform sampler2D loaded;
layout(set = 0, binding = 2) uniform sampler2D depths; layout(set = 0, binding = 3) uniform sampler2D coarse;
void main() {
  vec2 at = uv * (1.0 + 3.0 * uv.x);
  vec3 c = texture(chain, at).rgb * 0.5 + textureLod(chain, uv, 3.0 * uv.y).rgb * 0.2;
  c += texture(loaded, uv).rgb * 0.2 + texture(depths, uv).rrr * 0.1;
  o = vec4(mix(c, texture(coarse, at.yx).rgb, 0.25), float(textureSize(chain, 1).x) / 255.0);
})";

struct Vertex {
  float position[4], color[4];
};

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed) {
    stream_.name = "levels";
    add_image(Format::kR8G8B8A8Unorm, traces::kColorAttachment, 4, 3);
    add_image(seed % 2 == 0 ? Format::kD32Float : Format::kD16Unorm, traces::kDepthAttachment, 2, 1);
    add_image(Format::kR8G8B8A8Unorm, traces::kColorAttachment, 1, 1);
    stream_.samplers.resize(2);
    stream_.samplers[1].mag = stream_.samplers[1].min = stream_.samplers[1].mip = traces::Filter::kNearest;
    stream_.descriptor_sets = {{{}, {{0, kLevels, 0, 0, 1, 1}}},
                               {{}, {{0, kLevels, 0, 1, 1, 1}}},
                               {{},
                                {{0, kLevels, 0, 0, 3, 1},
                                 {1, kLevels, 1, 1, 1, 2},
                                 {2, kDepths, 1, 1, 1, 0},
                                 {3, kLevels, 1, 2, 1, 0}}}};
  }

  traces::CommandStream make(std::uint32_t samples) {
    const traces::Pipeline triangles = pipeline(kVertex, kColor), down = pipeline(kWholePicture, kDown),
                           show = pipeline(kWholePicture, kShow);
    pass({color(0, 1)}, traces::kNone, triangles, 9);
    pass({color(1, 2)}, 1, triangles, 7);
    pass({color(1, 1)}, traces::kNone, down, 0, 0);
    pass({color(2, 1), color(2, 0)}, traces::kNone, down, 0, 1);
    pass({color(1, 2, traces::LoadOp::kLoad)}, traces::kNone, triangles, 2);
    traces::ColorAttachmentUse picture;
    picture.image = kPicture;
    pass({picture}, traces::kNone, show, 0, 2);
    traces::use_samples(stream_, samples);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  void add_image(Format format, traces::ImageUsage usage, std::uint32_t levels, std::uint32_t layers) {
    traces::Image image;
    image.name = std::to_string(stream_.images.size());
    image.format = format;
    image.width = kLevelsWidth;
    image.height = kLevelsHeight;
    image.levels = levels;
    image.layers = layers;
    image.usage = static_cast<std::uint8_t>(usage | traces::kSampled);
    stream_.images.push_back(image);
  }

  traces::ColorAttachmentUse color(std::uint32_t level, std::uint32_t layer,
                                   traces::LoadOp load = traces::LoadOp::kClear) {
    traces::ColorAttachmentUse use;
    use.image = kLevels;
    use.level = level;
    use.layer = layer;
    use.load = load;
    use.clear = {random_.real(0, 1), random_.real(0, 1), random_.real(0, 1), 1};
    return use;
  }

  Index shader(const char* source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"levels", stage, scenes::compile_glsl(source, stage, "levels")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  traces::Pipeline pipeline(const char* vertex, const char* fragment) {
    traces::Pipeline p;
    p.vertex_shader = shader(vertex, traces::ShaderStage::kVertex);
    p.fragment_shader = shader(fragment, traces::ShaderStage::kFragment);
    if (vertex != kVertex) return p;
    p.bindings = {{0, sizeof(Vertex), false}};
    p.attributes = {{0, 0, Format::kR32G32B32A32Float, 0}, {1, 0, Format::kR32G32B32A32Float, 16}};
    return p;
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

  /// `triangles` 0: one that holds the picture, with a descriptor set. `depth_level`: of the depths.
  void pass(std::vector<traces::ColorAttachmentUse> colors, std::uint32_t depth_level, traces::Pipeline p,
            int triangles, Index set = traces::kNone) {
    traces::BeginPass pass;
    pass.colors = std::move(colors);
    if (depth_level != traces::kNone) {
      pass.depth.image = kDepths;
      pass.depth.level = depth_level;
      p.depth = {true, true, traces::CompareOp::kLess};
    }
    const traces::PassTarget target = traces::target_of(stream_, pass);
    auto& c = stream_.commands;
    c.emplace_back(std::move(pass));
    c.emplace_back(
        traces::SetViewport{0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0, 1});
    c.emplace_back(traces::SetScissor{0, 0, target.width, target.height});
    stream_.pipelines.push_back(std::move(p));
    c.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    if (set != traces::kNone) c.emplace_back(traces::BindDescriptorSet{0, set});
    else c.emplace_back(traces::BindVertexBuffer{0, vertices(triangles), 0});
    traces::Draw draw;
    draw.count = triangles == 0 ? 3 : static_cast<std::uint32_t>(3 * triangles);
    c.emplace_back(draw);
    c.emplace_back(traces::EndPass{});
  }

  RandomSource random_;
  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream levels_stream(std::uint64_t seed, std::uint32_t samples) {
  return Maker(seed).make(samples);
}

}  // namespace quadrille::pipeline::test
