#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/random_source.h"

#include "scenes/material/glsl.h"

#include <array>
#include <cstring>

namespace quadrille::pipeline::test {

namespace {

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color; layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 v_color; layout(location = 1) out vec2 v_uv; layout(location = 2) flat out float v_index;
void main() { gl_Position = position; v_color = color; v_uv = uv; v_index = float(gl_VertexIndex % 5) * 0.2; })";

/// The same with sizes of points, clip and cull distances.
constexpr const char* kDistancesVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color; layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 v_color; layout(location = 1) out vec2 v_uv; layout(location = 2) flat out float v_index;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; float gl_CullDistance[1]; };
void main() {
  gl_Position = position; v_color = color; v_uv = uv; v_index = float(gl_VertexIndex % 5) * 0.2;
  gl_PointSize = 12.0 * color.r - 1.0;
  gl_ClipDistance[0] = position.x + 0.7 * position.w;
  gl_ClipDistance[1] = color.g - 0.2;
  gl_CullDistance[0] = 1.5 - uv.x;
})";

constexpr std::array<const char*, 6> kFragments{// Plain.
                                                R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 2) flat in float v_index; layout(location = 0) out vec4 o;
void main() { o = vec4(v_color.rgb * 0.8 + 0.2 * v_index, v_color.a); })",
                                                // Textured.
                                                R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 1) in vec2 v_uv; layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler2D t;
void main() { o = texture(t, v_uv) * v_color; })",
                                                // Discards.
                                                R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 1) in vec2 v_uv; layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler2D t;
void main() { vec4 c = texture(t, v_uv * 2.0); if (c.g < 0.5) discard; o = vec4(c.rgb, v_color.a); })",
                                                // Of points.
                                                R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 1) noperspective in vec2 v_uv; layout(location = 0) out vec4 o;
void main() { o = vec4(gl_PointCoord, fract(v_uv.x), v_color.a); })",
                                                // Writes depth.
                                                R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 1) in vec2 v_uv; layout(location = 0) out vec4 o;
void main() { gl_FragDepth = clamp(gl_FragCoord.z * 0.7 + 0.3 * fract(v_uv.x), 0.0, 1.0); o = v_color.bgra; })",
                                                // Diverges, in a loop with derivatives after it.
                                                R"(#version 450
layout(location = 0) in vec4 v_color; layout(location = 1) in vec2 v_uv; layout(location = 0) out vec4 o;
void main() {
  float s = 0.0; int n = int(mod(gl_FragCoord.x * 3.0 + gl_FragCoord.y, 7.0));
  for (int i = 0; i < n; ++i) { s += 0.1 * float(i); if (s > 0.7) break; }
  o = vec4(v_color.rgb * (0.3 + s), 0.5 + 0.5 * v_color.a) + vec4(abs(dFdx(v_uv)) * 0.5, 0.0, 0.0);
})"};

struct Vertex {
  std::array<float, 4> position, color;
  std::array<float, 2> uv;
};

std::vector<std::byte> bytes_of(const void* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), data, size);
  return bytes;
}

/// A triangle of clip-space vertices: mostly on screen, some crossing the near plane, some tiny, some huge.
void add_triangle(RandomSource& random, std::vector<Vertex>& out) {
  const float size = random.integer(0, 3) == 0 ? 0.05f : random.integer(0, 5) == 0 ? 40.0f : 0.9f;
  const float cx = random.real(-1, 1), cy = random.real(-1, 1), cz = random.real(0.05f, 0.95f);
  for (int i = 0; i < 3; ++i) {
    const float w = random.integer(0, 9) == 0 ? random.real(-1, 2) : random.real(0.5f, 3);
    const float z = random.integer(0, 9) == 0 ? random.real(-1, 2) : cz + random.real(-0.04f, 0.04f);
    out.push_back({{(cx + random.real(-size, size)) * w, (cy + random.real(-size, size)) * w, z * w, w},
                   {random.real(0, 1), random.real(0, 1), random.real(0, 1), random.real(0, 1)},
                   {random.real(-2, 2), random.real(-2, 2)}});
  }
}

/// What is assembled, and how it is drawn: half of all pipelines draw plain lists of triangles.
void choose_primitives(RandomSource& random, traces::Pipeline& p) {
  if (random.integer(0, 1) == 0) return;
  p.vertex_shader = static_cast<traces::Index>(random.integer(0, 1));
  p.topology = static_cast<traces::Topology>(random.integer(0, 5));
  p.polygon_mode = static_cast<traces::PolygonMode>(std::max(0, random.integer(-2, 2)));
  p.line_mode = static_cast<traces::LineMode>(random.integer(0, 2));
  p.line_width = random.integer(0, 2) == 0 ? random.real(1, 12) : 1.0f;
  p.primitive_restart = !models::is_list(p.topology) && random.integer(0, 1) == 0;
}

traces::Pipeline random_pipeline(RandomSource& random, traces::Index fragment) {
  traces::Pipeline p;
  p.name = "random";
  p.vertex_shader = 0;
  p.fragment_shader = fragment;
  p.bindings = {{0, sizeof(Vertex), false}};
  p.attributes = {{0, 0, traces::Format::kR32G32B32A32Float, 0},
                  {1, 0, traces::Format::kR32G32B32A32Float, 16},
                  {2, 0, traces::Format::kR32G32Float, 32}};
  p.cull = random.integer(0, 4) == 0 ? traces::CullMode::kBack : traces::CullMode::kNone;
  p.depth.test = random.integer(0, 5) != 0;
  p.depth.write = random.integer(0, 2) != 0;
  // Mostly "less", so that Hi-Z and early kills are at work; now and then a change of direction.
  p.depth.compare = random.integer(0, 3) != 0 ? traces::CompareOp::kLess
                                              : static_cast<traces::CompareOp>(random.integer(0, 7));
  p.depth_clamp = random.integer(0, 6) == 0;
  p.blend[0].enable = random.integer(0, 2) == 0;
  p.blend[0].src_color = static_cast<traces::BlendFactor>(random.integer(0, 9));
  p.blend[0].dst_color = static_cast<traces::BlendFactor>(random.integer(0, 9));
  p.blend[0].src_alpha = traces::BlendFactor::kOne;
  p.blend[0].dst_alpha = traces::BlendFactor::kOneMinusSrcAlpha;
  p.blend[0].color = static_cast<traces::BlendOp>(random.integer(0, 4));
  p.blend[0].write_mask =
      random.integer(0, 5) == 0 ? static_cast<std::uint8_t>(random.integer(1, 15)) : std::uint8_t{0xf};
  return p;
}

void add_texture(RandomSource& random, traces::CommandStream& stream) {
  traces::Image image{"noise", traces::Format::kR8G8B8A8Srgb, 32, 16, 6, {}, nullptr};
  std::size_t texels = 0;
  for (std::uint32_t l = 0; l < image.levels; ++l)
    texels += std::size_t{std::max(1u, image.width >> l)} * std::max(1u, image.height >> l);
  for (std::size_t i = 0; i < 4 * texels; ++i)
    image.texels.push_back(static_cast<std::byte>(random.integer(0, 255)));
  stream.images.push_back(image);
  stream.samplers.push_back({});
  stream.descriptor_sets.push_back({{}, {{0, 0, 0}}});
}

const std::vector<traces::Shader>& shaders() {
  static const std::vector<traces::Shader> all = [] {
    std::vector<traces::Shader> s;
    for (const char* text : {kVertex, kDistancesVertex}) {
      s.push_back({"random.vert", traces::ShaderStage::kVertex,
                   scenes::compile_glsl(text, traces::ShaderStage::kVertex, "random.vert")});
    }
    for (const char* text : kFragments) {
      s.push_back({"random.frag", traces::ShaderStage::kFragment,
                   scenes::compile_glsl(text, traces::ShaderStage::kFragment, "random.frag")});
    }
    return s;
  }();
  return all;
}

}  // namespace

traces::CommandStream random_stream(std::uint64_t seed, const StreamShape& shape) {
  RandomSource random(seed), primitives(seed + 1);
  traces::CommandStream stream;
  stream.name = "random";
  stream.shaders = shaders();
  add_texture(random, stream);
  stream.commands.push_back(traces::make_pass(stream, {shape.width, shape.height}, {0.2f, 0.3f, 0.4f, 1.0f}));
  stream.commands.push_back(
      traces::SetViewport{0, 0, static_cast<float>(shape.width), static_cast<float>(shape.height), 0, 1});
  stream.commands.push_back(traces::SetScissor{0, 0, shape.width, shape.height});
  for (int d = 0; d < shape.draws; ++d) {
    stream.pipelines.push_back(random_pipeline(
        random, static_cast<traces::Index>(2 + random.integer(0, static_cast<int>(kFragments.size()) - 1))));
    choose_primitives(primitives, stream.pipelines.back());
    stream.commands.push_back(traces::BindPipeline{static_cast<traces::Index>(stream.pipelines.size() - 1)});
    stream.commands.push_back(traces::BindDescriptorSet{0, 0});
    std::vector<Vertex> vertices;
    const int triangles = random.integer(1, 2 * shape.triangles - 1);
    for (int t = 0; t < triangles; ++t) add_triangle(random, vertices);
    stream.buffers.push_back({"vertices", bytes_of(vertices.data(), vertices.size() * sizeof(Vertex))});
    stream.commands.push_back(
        traces::BindVertexBuffer{0, static_cast<traces::Index>(stream.buffers.size() - 1), 0});
    traces::Draw draw;
    draw.count = static_cast<std::uint32_t>(vertices.size());
    if (random.integer(0, 1) == 0) {
      std::vector<std::uint16_t> indices;
      for (int i = 0; i < static_cast<int>(draw.count); ++i) {
        const int index = random.integer(0, 4) == 0 ? random.integer(0, static_cast<int>(draw.count) - 1) : i;
        indices.push_back(static_cast<std::uint16_t>(index));
      }
      if (stream.pipelines.back().primitive_restart) {
        for (std::uint16_t& index : indices)
          index = primitives.integer(0, 6) == 0 ? std::uint16_t{0xffff} : index;
      }
      stream.buffers.push_back({"indices", bytes_of(indices.data(), indices.size() * 2)});
      stream.commands.push_back(traces::BindIndexBuffer{static_cast<traces::Index>(stream.buffers.size() - 1),
                                                        0, traces::IndexType::kUint16});
      draw.indexed = true;
    }
    stream.commands.push_back(draw);
  }
  stream.commands.push_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

traces::CommandStream random_primitives(std::uint64_t seed) {
  traces::CommandStream stream =
      random_stream(seed, {.width = 160, .height = 96, .draws = 10, .triangles = 5});
  for (traces::Pipeline& p : stream.pipelines) {
    p.fragment_shader = 2;  // the plain one
    p.depth = {};
    p.blend[0] = {};
  }
  traces::validate(stream);
  return stream;
}

}  // namespace quadrille::pipeline::test
