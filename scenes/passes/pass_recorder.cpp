#include "scenes/passes/pass_recorder.h"

#include <cstring>
#include <utility>

#include "scenes/material/glsl.h"
#include "scenes/material/screen_triangle.h"

namespace quadrille::scenes {
namespace {

using traces::Index;

constexpr std::string_view kInterface = R"(#version 450
layout(set = 0, binding = 0) uniform FrameBlock {
  mat4 view_projection, inverse_view_projection, light;
  vec4 eye, right, up, sun;
} frame;
layout(push_constant) uniform DrawBlock { mat4 model; } draw;
)";

template <class T>
Index append(std::vector<T>& table, T object) {
  table.push_back(std::move(object));
  return static_cast<Index>(table.size() - 1);
}

std::vector<std::byte> bytes_of(const void* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), data, size);
  return bytes;
}

traces::Sampler nearest() {
  traces::Sampler s;
  s.mag = s.min = s.mip = traces::Filter::kNearest;
  s.wrap_u = s.wrap_v = traces::Wrap::kClampToEdge;
  return s;
}

}  // namespace

PassRecorder::PassRecorder(const SceneData& scene, const SceneOptions& options)
    : scene_(scene), view_(make_view(scene, options)) {
  stream_.name = scene.name;
  for (const Array& array : scene.arrays)
    arrays_.push_back(append(stream_.buffers, traces::Buffer{array.name, array.data}));
}

Index PassRecorder::shader(traces::ShaderStage stage, const std::string& name, std::string_view text) {
  const std::string whole = std::string(kInterface) + std::string(text);
  return append(stream_.shaders, traces::Shader{name, stage, compile_glsl(whole, stage, name)});
}

traces::Pipeline PassRecorder::scene_pipeline(const std::string& name, const PassStreams& streams,
                                              std::string_view vertex, std::string_view fragment) {
  traces::Pipeline p;
  p.name = name;
  p.vertex_shader = shader(traces::ShaderStage::kVertex, name + ".vert", vertex);
  p.fragment_shader = shader(traces::ShaderStage::kFragment, name + ".frag", fragment);
  p.depth = {true, true, traces::CompareOp::kLess};
  for (std::uint32_t i = 0; i < streams.size(); ++i) {
    const bool color = streams[i] == Semantic::kColor;
    const traces::Format format =
        color ? traces::Format::kR32G32B32A32Float : traces::Format::kR32G32B32Float;
    p.bindings.push_back({i, traces::format_bytes(format), false});
    p.attributes.push_back({i, i, format, 0});
  }
  return p;
}

traces::Pipeline PassRecorder::screen_pipeline(const std::string& name, std::string_view fragment) {
  using traces::ShaderStage;
  const std::string vertex_name = name + ".vert";
  traces::Pipeline p;
  p.name = name;
  p.vertex_shader = append(stream_.shaders,
                           traces::Shader{vertex_name, ShaderStage::kVertex,
                                          compile_glsl(kScreenTriangle, ShaderStage::kVertex, vertex_name)});
  p.fragment_shader = shader(ShaderStage::kFragment, name + ".frag", fragment);
  return p;
}

Index PassRecorder::add(traces::Pipeline pipeline) { return append(stream_.pipelines, std::move(pipeline)); }

Index PassRecorder::attachment(const std::string& name, traces::Format format, std::uint32_t width,
                               std::uint32_t height) {
  traces::Image image;
  image.name = name;
  image.format = format;
  image.width = width;
  image.height = height;
  const bool depth = models::format_info(format).may(models::kDepthUse);
  image.usage = static_cast<std::uint8_t>((depth ? traces::kDepthAttachment : traces::kColorAttachment) |
                                          traces::kSampled);
  return append(stream_.images, std::move(image));
}

Index PassRecorder::buffer(const std::string& name, const void* data, std::size_t bytes) {
  return append(stream_.buffers, traces::Buffer{name, bytes_of(data, bytes)});
}

Index PassRecorder::textures(const std::vector<Index>& images) {
  if (stream_.samplers.empty()) stream_.samplers.push_back(nearest());
  traces::DescriptorSet set;
  for (const Index image : images)
    set.textures.push_back({static_cast<std::uint32_t>(set.textures.size()), image, 0});
  return append(stream_.descriptor_sets, std::move(set));
}

void PassRecorder::set_frame(const PassFrame& frame) {
  const Index block = buffer("frame", &frame, sizeof frame);
  traces::DescriptorSet set;
  set.uniforms.push_back({0, block, 0, sizeof frame});
  frame_set_ = append(stream_.descriptor_sets, std::move(set));
}

void PassRecorder::begin(const traces::BeginPass& pass) {
  const traces::PassTarget target = traces::target_of(stream_, pass);
  stream_.commands.emplace_back(pass);
  stream_.commands.emplace_back(
      traces::SetViewport{0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0, 1});
  stream_.commands.emplace_back(traces::SetScissor{0, 0, target.width, target.height});
}

void PassRecorder::bind(Index pipeline, Index textures) {
  stream_.commands.emplace_back(traces::BindPipeline{pipeline});
  stream_.commands.emplace_back(traces::BindDescriptorSet{0, frame_set_});
  if (textures != traces::kNone) stream_.commands.emplace_back(traces::BindDescriptorSet{1, textures});
}

void PassRecorder::draw_scene(Index pipeline, const PassStreams& streams, Index textures) {
  bind(pipeline, textures);
  for (const Instance& instance : scene_.instances) {
    const Primitive& primitive = scene_.primitives[instance.primitive];
    const glm::mat4 model(instance.world);
    stream_.commands.emplace_back(traces::PushConstants{0, bytes_of(&model, sizeof model)});
    for (std::uint32_t i = 0; i < streams.size(); ++i) {
      const int array = primitive.attributes[static_cast<std::size_t>(streams[i])];
      stream_.commands.emplace_back(traces::BindVertexBuffer{i, arrays_[static_cast<std::size_t>(array)], 0});
    }
    stream_.commands.emplace_back(traces::BindIndexBuffer{
        arrays_[static_cast<std::size_t>(primitive.indices)], 0, primitive.index_type});
    traces::Draw draw;
    draw.indexed = true;
    draw.count = primitive.count;
    draw.label = instance.label;
    stream_.commands.emplace_back(draw);
  }
}

void PassRecorder::draw_screen(Index pipeline, Index textures, const std::string& label) {
  bind(pipeline, textures);
  traces::Draw draw;
  draw.count = 3;
  draw.label = label;
  stream_.commands.emplace_back(draw);
}

traces::CommandStream PassRecorder::finish() { return std::move(stream_); }

}  // namespace quadrille::scenes
