/// The vertex shaders, and the command stream around them.
#include "tests/pipeline/object_stream.h"

#include "scenes/material/glsl.h"

#include <cstring>
#include <span>

namespace quadrille::pipeline::test {
namespace {

using traces::Index;

constexpr std::uint32_t kSize = 64;  ///< of the target, pixels

/// Around `body`, which writes gl_Position.
std::string vertex_shader(const std::string& body) {
  return "#version 450\nlayout(location = 0) in vec3 position;\n"
         "layout(push_constant) uniform P { mat4 model; mat4 view; } p;\n"
         "layout(set = 0, binding = 0) uniform sampler2D t;\n"
         "layout(set = 0, binding = 1, std430) buffer B { uint w[4]; } b;\n"
         "void main() { vec4 at = vec4(position, 1.0);\n" +
         body + "}";
}

template <class Number>
std::vector<std::byte> bytes_of(const std::vector<Number>& numbers) {
  std::vector<std::byte> bytes(numbers.size() * sizeof(Number));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

template <class Number>
Index add_buffer(traces::CommandStream& stream, const std::vector<Number>& numbers) {
  stream.buffers.push_back({"object", bytes_of(numbers)});
  return static_cast<Index>(stream.buffers.size() - 1);
}

Index add_shader(traces::CommandStream& stream, const std::string& source, traces::ShaderStage stage) {
  stream.shaders.push_back({"object", stage, scenes::compile_glsl(source, stage, "object")});
  return static_cast<Index>(stream.shaders.size() - 1);
}

void add_pipeline(traces::CommandStream& stream, const ObjectDraw& draw) {
  traces::Pipeline p;
  p.name = "object";
  p.vertex_shader = static_cast<Index>(1 + draw.program);
  p.fragment_shader = 0;
  p.bindings = {{0, 3 * sizeof(float), false}};
  p.attributes = {{0, 0, traces::Format::kR32G32B32Float, 0}};
  p.depth_clamp = draw.depth_clamp;
  stream.pipelines.push_back(std::move(p));
  stream.commands.emplace_back(traces::BindPipeline{static_cast<Index>(stream.pipelines.size() - 1)});
}

void add_draw(traces::CommandStream& stream, const ObjectDraw& draw) {
  add_pipeline(stream, draw);
  std::vector<float> matrices(draw.model.begin(), draw.model.end());
  matrices.insert(matrices.end(), draw.view.begin(), draw.view.end());
  stream.commands.emplace_back(traces::PushConstants{0, bytes_of(matrices)});
  stream.commands.emplace_back(traces::BindVertexBuffer{0, add_buffer(stream, draw.corners), 0});
  traces::Draw command;
  command.count = static_cast<std::uint32_t>(draw.corners.size());
  command.label = "object";
  if (draw.indexed) {
    std::vector<std::uint16_t> indices(draw.corners.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint16_t>(i);
    stream.commands.emplace_back(
        traces::BindIndexBuffer{add_buffer(stream, indices), 0, traces::IndexType::kUint16});
    command.indexed = true;
  }
  stream.commands.emplace_back(std::move(command));
}

/// A texture, and a buffer of four words.
void add_descriptors(traces::CommandStream& stream) {
  traces::Image image{"white", traces::Format::kR8G8B8A8Unorm, 1, 1, 1, {}, nullptr};
  image.texels.assign(4, std::byte{0xff});
  stream.images.push_back(std::move(image));
  stream.samplers.emplace_back();
  const Index words = add_buffer(stream, std::vector<std::uint32_t>(4));
  traces::DescriptorSet set;
  set.textures.push_back({0, 0, 0});
  set.buffers.push_back({1, words, 0, 16});
  stream.descriptor_sets.push_back(std::move(set));
}

std::vector<std::string> vertex_shaders(std::span<const char* const> bodies) {
  std::vector<std::string> shaders;
  shaders.reserve(bodies.size());
  for (const char* const body : bodies) shaders.push_back(vertex_shader(body));
  return shaders;
}

}  // namespace

std::vector<std::string> bounded_programs() {
  const char* const bodies[] = {
      "gl_Position = p.view * (p.model * at);",
      "at.xy = abs(at.xy) * 0.5 - at.yx; gl_Position = p.view * (p.model * at);",
      "if (at.x > 0.1) at.y += at.x; else at.z -= 0.25 * at.y; gl_Position = p.view * (p.model * at);",
      "at = at.x < 0.0 ? at.yxzw : at; gl_Position = p.view * (p.model * at);",
      "at.xyz = clamp(at.xyz * at.yzx, vec3(-0.7), vec3(0.8)); gl_Position = p.view * (p.model * at);",
      "at.y *= float(gl_InstanceIndex + 2); gl_Position = p.view * (p.model * at);",
      "at.x += p.model[gl_InstanceIndex & 3][1]; gl_Position = p.view * (p.model * at);"};
  return vertex_shaders(bodies);
}

std::vector<std::string> unbounded_programs() {
  const char* const bodies[] = {
      "at.x += sin(at.y); gl_Position = p.view * (p.model * at);",
      "for (int i = int(fract(at.x) * 9.0); i > 0; --i) at *= 1.5; gl_Position = p.view * (p.model * at);",
      "at.x += float(gl_VertexIndex); gl_Position = p.view * (p.model * at);",
      "at += textureLod(t, at.xy, 0.0); gl_Position = p.view * (p.model * at);",
      "gl_Position = p.view * (p.model * at); gl_Position *= 1.0 / at.x;",
      "b.w[0] = 7u; gl_Position = p.view * (p.model * at);"};
  return vertex_shaders(bodies);
}

traces::CommandStream object_stream(const std::vector<ObjectDraw>& draws,
                                    const std::vector<std::string>& programs) {
  traces::CommandStream stream;
  stream.name = "objects";
  (void)add_shader(
      stream, "#version 450\nlayout(location = 0) out vec4 o; void main() { o = vec4(1.0, 0.5, 0.25, 1.0); }",
      traces::ShaderStage::kFragment);
  for (const std::string& program : programs) (void)add_shader(stream, program, traces::ShaderStage::kVertex);
  add_descriptors(stream);
  stream.commands.emplace_back(
      traces::make_pass(stream, {kSize, kSize, traces::Format::kR8G8B8A8Unorm}, {0, 0, 0, 0}));
  stream.commands.emplace_back(traces::SetViewport{0, 0, kSize, kSize, 0, 1});
  stream.commands.emplace_back(traces::SetScissor{0, 0, kSize, kSize});
  stream.commands.emplace_back(traces::BindDescriptorSet{0, 0});
  for (const ObjectDraw& draw : draws) add_draw(stream, draw);
  stream.commands.emplace_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

}  // namespace quadrille::pipeline::test
