#include "studies/stability/stream_builder.h"

#include <algorithm>
#include <cstring>

#include "scenes/material/glsl.h"

namespace quadrille::studies::stability {

namespace {

constexpr std::uint32_t kTextureSide = 16;

constexpr std::string_view kVertexShader = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 v_color;
layout(location = 1) out vec2 v_uv;
layout(push_constant) uniform PerDraw { mat4 matrix; } draw;
void main() {
  gl_Position = draw.matrix * position;
  v_color = color;
  v_uv = uv;
})";
constexpr std::string_view kColorShader = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 out_color;
void main() { out_color = v_color; })";
constexpr std::string_view kTextureShader = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 1) in vec2 v_uv;
layout(set = 0, binding = 0) uniform sampler2D checks;
layout(location = 0) out vec4 out_color;
void main() { out_color = texture(checks, v_uv) * v_color; })";
constexpr std::string_view kCountShader = R"(#version 450
layout(location = 0) out vec4 out_color;
void main() { out_color = vec4(1.0 / 255.0, 0.0, 0.0, 0.0); })";

template <class T>
traces::Index append(std::vector<T>& table, T object) {
  table.push_back(std::move(object));
  return static_cast<traces::Index>(table.size() - 1);
}

template <class T>
std::vector<std::byte> bytes_of(std::span<const T> values) {
  std::vector<std::byte> bytes(values.size_bytes());
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

traces::Image checks() {
  traces::Image image{"checks", traces::Format::kR8G8B8A8Unorm, kTextureSide, kTextureSide, 1, {}, nullptr};
  for (std::uint32_t i = 0; i < kTextureSide * kTextureSide; ++i) {
    const bool light = ((i / kTextureSide / 4) + (i % kTextureSide / 4)) % 2 == 0;
    for (int c = 0; c < 4; ++c) image.texels.push_back(static_cast<std::byte>(c == 3 || light ? 255 : 110));
  }
  return image;
}

}  // namespace

StreamBuilder::StreamBuilder(std::string name, std::uint32_t width, std::uint32_t height, bool depth,
                             float clear_depth)
    : StreamBuilder(std::move(name), width, height, traces::Format::kR8G8B8A8Unorm,
                    depth ? traces::Format::kD32Float : traces::Format::kUndefined, clear_depth) {}

StreamBuilder::StreamBuilder(std::string name, std::uint32_t width, std::uint32_t height,
                             traces::Format color, traces::Format depth, float clear_depth) {
  stream_.name = std::move(name);
  pass_ = traces::make_pass(stream_, {width, height, color, depth}, {0, 0, 0, 0}, clear_depth);
  const traces::Index image = append(stream_.images, checks());
  traces::Sampler sampler;
  sampler.max_lod = 0;
  stream_.descriptor_sets.push_back({{}, {{0, image, append(stream_.samplers, sampler)}}});
  area({0, 0, width, height});
}

StreamBuilder& StreamBuilder::clear(const std::array<float, 4>& color) {
  pass_.colors[0].clear = color;
  return *this;
}

StreamBuilder& StreamBuilder::area(const Area& v, const Area& s) {
  commands_.emplace_back(traces::SetViewport{static_cast<float>(v.x), static_cast<float>(v.y),
                                             static_cast<float>(v.width), static_cast<float>(v.height), 0,
                                             1});
  commands_.emplace_back(traces::SetScissor{s.x, s.y, s.width, s.height});
  return *this;
}

traces::Index StreamBuilder::shader(const std::string& name, traces::ShaderStage stage,
                                    std::string_view source) {
  const auto found = std::ranges::find(stream_.shaders, name, &traces::Shader::name);
  if (found != stream_.shaders.end()) return static_cast<traces::Index>(found - stream_.shaders.begin());
  return append(stream_.shaders, {name, stage, scenes::compile_glsl(source, stage, name)});
}

traces::Index StreamBuilder::fragment_shader(Paint paint) {
  using traces::ShaderStage;
  switch (paint) {
    case Paint::kColor: return shader("color", ShaderStage::kFragment, kColorShader);
    case Paint::kTexture: return shader("texture", ShaderStage::kFragment, kTextureShader);
    case Paint::kCount: return shader("count", ShaderStage::kFragment, kCountShader);
  }
  return traces::kNone;
}

StreamBuilder& StreamBuilder::state(const DrawState& state) {
  traces::Pipeline p;
  p.vertex_shader = shader("vertex", traces::ShaderStage::kVertex, kVertexShader);
  p.fragment_shader = fragment_shader(state.paint);
  p.bindings = {{0, sizeof(Corner), false}};
  p.attributes = {{0, 0, traces::Format::kR32G32B32A32Float, offsetof(Corner, position)},
                  {1, 0, traces::Format::kR32G32B32A32Float, offsetof(Corner, color)},
                  {2, 0, traces::Format::kR32G32Float, offsetof(Corner, uv)}};
  p.cull = state.cull;
  p.depth = state.depth;
  if (state.paint == Paint::kCount || state.mix == Mix::kAdd) {
    p.blend[0].enable = true;
    p.blend[0].dst_color = p.blend[0].dst_alpha = traces::BlendFactor::kOne;
  } else if (state.mix == Mix::kOver) {
    p.blend[0].enable = true;
    p.blend[0].src_color = traces::BlendFactor::kSrcAlpha;
    p.blend[0].dst_color = traces::BlendFactor::kOneMinusSrcAlpha;
  }
  commands_.emplace_back(traces::BindPipeline{append(stream_.pipelines, p)});
  commands_.emplace_back(traces::BindDescriptorSet{0, 0});
  return *this;
}

StreamBuilder& StreamBuilder::draw(std::span<const Corner> corners, const glm::mat4& matrix) {
  if (stream_.pipelines.empty()) state({});
  const traces::Index buffer = append(stream_.buffers, {"corners", bytes_of(corners)});
  commands_.emplace_back(traces::BindVertexBuffer{0, buffer, 0});
  commands_.emplace_back(traces::PushConstants{0, bytes_of(std::span<const glm::mat4>(&matrix, 1))});
  traces::Draw draw;
  draw.count = static_cast<std::uint32_t>(corners.size());
  commands_.emplace_back(draw);
  return *this;
}

StreamBuilder& StreamBuilder::draw_indexed(std::span<const Corner> corners,
                                           std::span<const std::uint32_t> indices) {
  draw(corners);
  auto& draw = std::get<traces::Draw>(commands_.back());
  draw.indexed = true;
  draw.count = static_cast<std::uint32_t>(indices.size());
  const traces::Index buffer = append(stream_.buffers, {"indices", bytes_of(indices)});
  commands_.insert(commands_.end() - 1, traces::BindIndexBuffer{buffer, 0, traces::IndexType::kUint32});
  return *this;
}

traces::CommandStream StreamBuilder::finish() const {
  traces::CommandStream stream = stream_;
  stream.commands.emplace_back(pass_);
  stream.commands.insert(stream.commands.end(), commands_.begin(), commands_.end());
  stream.commands.emplace_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

Corners quad(const glm::vec2& low, const glm::vec2& high, float z, const glm::vec4& color) {
  const auto corner = [&](float x, float y, float u, float v) { return Corner{{x, y, z, 1}, color, {u, v}}; };
  const Corner a = corner(low.x, low.y, 0, 0), b = corner(low.x, high.y, 0, 1),
               c = corner(high.x, high.y, 1, 1), d = corner(high.x, low.y, 1, 0);
  return {a, b, c, a, c, d};
}

glm::vec4 at_pixel(double x, double y, std::uint32_t width, std::uint32_t height, float z) {
  return {static_cast<float>(2 * x / width - 1), static_cast<float>(2 * y / height - 1), z, 1};
}

}  // namespace quadrille::studies::stability
