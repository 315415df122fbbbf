#include "tests/pipeline/lines_stream.h"

#include "scenes/material/glsl.h"

namespace quadrille::pipeline::test {
namespace {

using traces::Index;

constexpr Index kLines = 0, kPicture = 1;

constexpr const char* kWhole = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
  uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
})";
constexpr const char* kGradient = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
void main() { o = vec4(uv.x, fract(gl_FragCoord.x / 8.0), 1.0 - uv.x, 1.0); })";
constexpr const char* kDown = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler1D above;
void main() { o = texture(above, uv.x).gbra; })";
constexpr const char* kShow = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler1D chain; layout(set = 0, binding = 1) uniform sampler1DArray all;
void main() {
  vec4 one = textureLod(all, vec2(uv.x, uv.y < 0.75 ? 0.0 : 2.0), 0.0);
  o = uv.y < 0.5 ? textureLod(chain, uv.x, 2.0 * uv.y) : one;
})";

traces::ColorAttachmentUse color(Index image, std::uint32_t level, std::uint32_t layer) {
  traces::ColorAttachmentUse use;
  use.image = image;
  use.level = level;
  use.layer = layer;
  return use;
}

class Maker {
 public:
  Maker() {
    stream_.name = "lines";
    traces::Image image;
    image.width = kLinesWidth;
    image.levels = 2;
    image.layers = 3;
    image.kind = traces::ImageKind::k1D;
    image.usage = traces::kColorAttachment | traces::kSampled;
    stream_.images.push_back(image);
    traces::Image picture;
    picture.width = kLinesWidth;
    picture.height = kLinesHeight;
    picture.usage = traces::kColorAttachment;
    stream_.images.push_back(picture);
    stream_.samplers.resize(1);
    const auto seen = [](std::uint32_t binding, std::uint32_t levels, std::uint32_t layer, bool array) {
      traces::TextureDescriptor texture{binding, kLines, 0, 0, levels, layer};
      texture.view = array ? traces::ViewKind::k1DArray : traces::ViewKind::k1D;
      texture.layers = array ? 3 : 1;
      return texture;
    };
    stream_.descriptor_sets = {{{}, {seen(0, 1, 2, false)}},
                               {{}, {seen(0, 2, 2, false), seen(1, 1, 0, true)}}};
  }

  traces::CommandStream make(std::uint32_t samples) {
    pass(color(kLines, 0, 0), kGradient);
    pass(color(kLines, 0, 1), kGradient);
    pass(color(kLines, 0, 2), kGradient);
    pass(color(kLines, 1, 2), kDown, 0);
    pass(color(kPicture, 0, 0), kShow, 1);
    traces::use_samples(stream_, samples);
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  Index shader(const char* source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"lines", stage, scenes::compile_glsl(source, stage, "lines")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  void pass(const traces::ColorAttachmentUse& use, const char* fragment, Index set = traces::kNone) {
    traces::Pipeline pipeline;
    pipeline.vertex_shader = shader(kWhole, traces::ShaderStage::kVertex);
    pipeline.fragment_shader = shader(fragment, traces::ShaderStage::kFragment);
    stream_.pipelines.push_back(std::move(pipeline));
    traces::BeginPass begin;
    begin.colors.push_back(use);
    const traces::PassTarget target = traces::target_of(stream_, begin);
    auto& c = stream_.commands;
    c.emplace_back(std::move(begin));
    c.emplace_back(
        traces::SetViewport{0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0, 1});
    c.emplace_back(traces::SetScissor{0, 0, target.width, target.height});
    c.emplace_back(traces::BindPipeline{static_cast<Index>(stream_.pipelines.size() - 1)});
    if (set != traces::kNone) c.emplace_back(traces::BindDescriptorSet{0, set});
    traces::Draw draw;
    draw.count = 3;
    c.emplace_back(draw);
    c.emplace_back(traces::EndPass{});
  }

  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream lines_stream(std::uint32_t samples) { return Maker().make(samples); }

}  // namespace quadrille::pipeline::test
