#include "studies/experiments/triangle_mesh.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "scenes/material/glsl.h"

namespace quadrille::studies::experiments {
namespace {

constexpr const char* kVertexShader = R"(#version 450
layout(location = 0) in vec3 position;
void main() { gl_Position = vec4(position, 1); })";
constexpr const char* kFragmentShader = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.8, 0.4, 0.2, 1); })";
constexpr const char* kTranslucentShader = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.8, 0.4, 0.2, 0.5); })";
/// Every other column of quads.
constexpr const char* kDiscardingShader = R"(#version 450
layout(location = 0) out vec4 color;
void main() {
  if ((int(gl_FragCoord.x) & 2) != 0) discard;
  color = vec4(0.8, 0.4, 0.2, 1);
})";

template <class T>
traces::Buffer buffer_of(const char* name, std::span<const T> values) {
  traces::Buffer buffer{name, std::vector<std::byte>(values.size_bytes())};
  std::memcpy(buffer.data.data(), values.data(), values.size_bytes());
  return buffer;
}

/// Clip space, from the window. The error of a float, 2^-24 of the frame, is far below half a step of the
/// grid: snapping finds the corner again.
std::vector<float> clip_positions(const TriangleMesh& mesh, bool depth) {
  std::vector<float> positions;
  positions.reserve(3 * mesh.corners.size());
  const auto clip = [](std::int32_t at, std::uint32_t size) {
    return static_cast<float>(2.0 * at / (double{kGrid} * size) - 1);
  };
  for (const WindowCorner& c : mesh.corners) {
    positions.push_back(clip(c.x, mesh.width));
    positions.push_back(clip(c.y, mesh.height));
    if (depth) positions.push_back(c.depth);
  }
  return positions;
}

traces::Pipeline pipeline_of(const DrawOptions& options) {
  traces::Pipeline pipeline;
  pipeline.vertex_shader = 0;
  pipeline.fragment_shader = 1;
  // A component that is not there reads as 0.
  const traces::Format format =
      options.depth ? traces::Format::kR32G32B32Float : traces::Format::kR32G32Float;
  pipeline.bindings = {{0, traces::format_bytes(format), false}};
  pipeline.attributes = {{0, 0, format, 0}};
  pipeline.topology = options.topology;
  pipeline.cull = options.cull;
  if (options.depth) pipeline.depth = {true, true, traces::CompareOp::kLess};
  if (options.blends) {
    pipeline.blend[0].enable = true;
    pipeline.blend[0].src_color = traces::BlendFactor::kSrcAlpha;
    pipeline.blend[0].dst_color = traces::BlendFactor::kOneMinusSrcAlpha;
  }
  return pipeline;
}

const char* fragment_shader_of(const DrawOptions& options) {
  if (!options.fragment_shader.empty()) return options.fragment_shader.c_str();
  if (options.discards) return kDiscardingShader;
  return options.blends ? kTranslucentShader : kFragmentShader;
}

traces::TextureDescriptor add_texture(const DrawTexture& texture, traces::CommandStream& stream) {
  traces::Image image{"grey", texture.format, texture.width, texture.height, texture.levels, {}, nullptr};
  image.texels.assign(traces::texel_bytes(image), std::byte{0x80});
  stream.images.push_back(std::move(image));
  traces::Sampler sampler;
  sampler.mag = sampler.min = sampler.mip = texture.filter;
  stream.samplers = {sampler};
  return {0, static_cast<traces::Index>(stream.images.size() - 1), 0};
}

traces::StorageBinding add_storage(std::uint32_t words, traces::CommandStream& stream) {
  stream.buffers.push_back({"words", std::vector<std::byte>(std::size_t{4} * words)});
  return {1, static_cast<traces::Index>(stream.buffers.size() - 1), 0, 4 * words};
}

void bind_resources(const DrawOptions& options, traces::CommandStream& stream) {
  traces::DescriptorSet set;
  if (options.texture.width > 0) set.textures.push_back(add_texture(options.texture, stream));
  if (options.storage_words > 0) set.buffers.push_back(add_storage(options.storage_words, stream));
  if (set == traces::DescriptorSet{}) return;
  stream.descriptor_sets.push_back(std::move(set));
  stream.commands.emplace_back(traces::BindDescriptorSet{0, 0});
}

}  // namespace

void TriangleMesh::rectangle(std::int32_t left, std::int32_t top, std::int32_t right, std::int32_t bottom,
                             float depth) {
  const auto first = static_cast<std::uint32_t>(corners.size());
  for (const auto& [x, y] : {std::array{left, top}, {right, top}, {right, bottom}, {left, bottom}})
    corners.push_back({x * kGrid, y * kGrid, depth});
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
}

TriangleMesh tiled_frame(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width,
                         std::uint32_t tile_height, std::uint32_t column_tiles) {
  TriangleMesh mesh{width, height, {}, {}};
  const auto tiles = [](std::uint32_t size, std::uint32_t tile) { return (size + tile - 1) / tile; };
  const std::uint32_t columns = tiles(width, tile_width), rows = tiles(height, tile_height);
  for (std::uint32_t from = 0; from < columns; from += column_tiles) {
    const std::uint32_t across = std::min(column_tiles, columns - from);
    for (std::uint32_t row = 0; row <= rows; ++row) {
      const auto first = static_cast<std::uint32_t>(mesh.corners.size());
      for (std::uint32_t i = 0; i <= across; ++i) {
        mesh.corners.push_back({static_cast<std::int32_t>(std::min((from + i) * tile_width, width)) * kGrid,
                                static_cast<std::int32_t>(std::min(row * tile_height, height)) * kGrid});
      }
      for (std::uint32_t i = 0; row > 0 && i < across; ++i) {
        const std::uint32_t below = first + i, above = below - (across + 1);
        mesh.triangles.push_back({above, above + 1, below + 1});
        mesh.triangles.push_back({above, below + 1, below});
      }
    }
  }
  return mesh;
}

traces::CommandStream stream_of(const TriangleMesh& mesh, const DrawOptions& options) {
  using traces::ShaderStage;
  traces::CommandStream stream;
  stream.name = "triangles";
  stream.shaders = {
      {"hand through", ShaderStage::kVertex,
       scenes::compile_glsl(kVertexShader, ShaderStage::kVertex, "triangles.vert")},
      {"one colour", ShaderStage::kFragment,
       scenes::compile_glsl(fragment_shader_of(options), ShaderStage::kFragment, "triangles.frag")}};
  const std::vector<float> positions = clip_positions(mesh, options.depth);
  const std::span<const std::uint32_t> indices(
      mesh.triangles.empty() ? nullptr : mesh.triangles.front().data(), 3 * mesh.triangles.size());
  stream.buffers = {buffer_of<float>("positions", positions), buffer_of("indices", indices)};
  const traces::BeginPass pass =
      traces::make_pass(stream, {mesh.width, mesh.height, options.format,
                                 options.depth ? options.depth_format : traces::Format::kUndefined});
  stream.pipelines = {pipeline_of(options)};
  traces::Draw draw;
  draw.indexed = true;
  draw.count = static_cast<std::uint32_t>(indices.size());
  stream.commands = {
      pass,
      traces::BindPipeline{0},
      traces::BindVertexBuffer{0, 0, 0},
      traces::BindIndexBuffer{1, 0, traces::IndexType::kUint32},
      traces::SetViewport{0, 0, static_cast<float>(mesh.width), static_cast<float>(mesh.height), 0, 1},
      traces::SetScissor{0, 0, mesh.width, mesh.height}};
  bind_resources(options, stream);
  stream.commands.insert(stream.commands.end(), options.draws, draw);
  stream.commands.emplace_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

}  // namespace quadrille::studies::experiments
