/// Vertex fetch from the raw buffers and vertex shading, four vertices at a time.
#include "models/reference/vertices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "models/base/error.h"
#include "models/reference/parallel.h"

namespace quadrille::models::reference {
namespace {

constexpr std::size_t kVerticesPerTask = 512;

/// A little-endian unsigned number; zero beyond the buffer.
std::uint32_t read_bytes(const traces::Buffer& buffer, std::uint64_t offset, std::uint32_t bytes) {
  std::uint32_t word = 0;
  if (offset <= buffer.data.size() && bytes <= buffer.data.size() - offset)
    std::memcpy(&word, buffer.data.data() + offset, bytes);
  return word;
}

struct FormatLayout {
  std::uint32_t components, bytes;  ///< bytes of one component
  bool is_float, is_signed;
  bool is_integer = false;
};

FormatLayout layout_of(traces::Format format) {
  using traces::Format;
  switch (format) {
    case Format::kR32Float:
    case Format::kD32Float: return {1, 4, true, true};
    case Format::kR32G32Float: return {2, 4, true, true};
    case Format::kR32G32B32Float: return {3, 4, true, true};
    case Format::kR32G32B32A32Float: return {4, 4, true, true};
    case Format::kR8G8Unorm: return {2, 1, false, false};
    case Format::kR8G8B8A8Unorm:
    case Format::kR8G8B8A8UnormVertex: return {4, 1, false, false};
    case Format::kR16G16Unorm: return {2, 2, false, false};
    case Format::kR16G16B16A16Unorm: return {4, 2, false, false};
    case Format::kR8G8B8A8Snorm: return {4, 1, false, true};
    case Format::kR16G16B16A16Snorm: return {4, 2, false, true};
    case Format::kR8G8B8A8Uint: return {4, 1, false, false, true};
    case Format::kR16G16B16A16Uint: return {4, 2, false, false, true};
    default: break;
  }
  throw user_error("vertex attribute: a format that is not one of a vertex attribute");
}

double component(std::uint32_t word, const FormatLayout& layout) {
  if (layout.is_float) return static_cast<double>(std::bit_cast<float>(word));
  if (layout.is_integer) return word;
  const std::uint32_t bits = 8 * layout.bytes;
  if (!layout.is_signed) return word / static_cast<double>((1u << bits) - 1);
  const std::uint32_t sign = 1u << (bits - 1);
  return std::max(
      static_cast<double>(static_cast<std::int32_t>((word ^ sign) - sign)) / static_cast<double>(sign - 1),
      -1.0);
}

/// VertexIndex of each vertex of the draw, and the positions of indices that end a strip or fan. [VK1.3
/// #interfaces-builtin-variables-vertexindex]
std::vector<std::uint32_t> vertex_indices(const DrawState& state, std::vector<std::uint32_t>& breaks) {
  const traces::Draw& draw = *state.draw;
  std::vector<std::uint32_t> indices(draw.count);
  for (std::uint32_t i = 0; i < draw.count; ++i) {
    if (!draw.indexed) {
      indices[i] = draw.first + i;
      continue;
    }
    const std::uint32_t bytes = state.index_buffer.type == traces::IndexType::kUint8    ? 1
                                : state.index_buffer.type == traces::IndexType::kUint16 ? 2
                                                                                        : 4;
    const std::uint64_t offset = state.index_buffer.offset + (std::uint64_t{draw.first} + i) * bytes;
    const std::uint32_t index = read_bytes(state.stream->buffers[state.index_buffer.buffer], offset, bytes);
    indices[i] = index + static_cast<std::uint32_t>(draw.vertex_offset);
    const std::uint32_t special = bytes == 4 ? 0xffffffffu : bytes == 2 ? 0xffffu : 0xffu;
    if (state.pipeline->primitive_restart && index == special) breaks.push_back(i);
  }
  return indices;
}

/// Where an attribute comes from, and the cells its components go to.
struct AttributeFeed {
  const traces::Buffer* buffer = nullptr;
  std::uint64_t offset = 0;
  std::uint32_t stride = 0;
  bool per_instance = false;
  traces::Format format = traces::Format::kUndefined;
  std::array<Slot, 4> slots{kNoSlot, kNoSlot, kNoSlot, kNoSlot};
  bool integers = false;  ///< how the shader declares it
};

std::vector<AttributeFeed> attribute_feeds(const DrawState& state, const ShaderProgram& program) {
  std::vector<AttributeFeed> feeds;
  for (const traces::VertexAttribute& attribute : state.pipeline->attributes) {
    AttributeFeed feed;
    for (const Port& port : program.inputs) {
      if (port.location == attribute.location && port.component < 4)
        feed.slots.at(port.component) = port.slot, feed.integers = port.kind == ScalarKind::kInt;
    }
    if (feed.slots == std::array<Slot, 4>{kNoSlot, kNoSlot, kNoSlot, kNoSlot}) continue;
    if (feed.integers != traces::is_integer_format(attribute.format)) {
      throw user_error("draw {}: vertex input location {} is declared as {} and supplied as {}", state.number,
                       attribute.location, feed.integers ? "integers" : "floats",
                       feed.integers ? "floats" : "integers");
    }
    const auto bound = state.vertex_buffers.find(attribute.binding);
    if (bound == state.vertex_buffers.end())
      throw user_error("draw {}: vertex binding {} has no buffer", state.number, attribute.binding);
    feed.buffer = &state.stream->buffers[bound->second.buffer];
    feed.offset = bound->second.offset + attribute.offset;
    feed.format = attribute.format;
    for (const traces::VertexBinding& binding : state.pipeline->bindings) {
      if (binding.binding == attribute.binding)
        feed.stride = binding.stride, feed.per_instance = binding.per_instance;
    }
    feeds.push_back(feed);
  }
  return feeds;
}

/// Shades vertices in groups of four.
class VertexWorker {
 public:
  VertexWorker(const BoundShader& shader, const std::vector<AttributeFeed>& feeds,
               std::uint32_t instance_index, const std::vector<std::uint32_t>& distinct, ShadedVertices& out)
      : program_(*shader.program),
        lanes_(shader.lanes()),
        feeds_(feeds),
        instance_index_(instance_index),
        distinct_(distinct),
        out_(out) {}

  void operator()(std::size_t task) {
    const std::size_t end = std::min(distinct_.size(), (task + 1) * kVerticesPerTask);
    for (std::size_t first = task * kVerticesPerTask; first < end; first += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        load(std::min(first + lane, end - 1), static_cast<int>(lane));
      execute(program_, lanes_, kAllLanes);
      for (std::size_t lane = 0; lane < kLanes && first + lane < end; ++lane) store(first + lane, lane);
    }
  }

 private:
  void load(std::size_t vertex, int lane) {
    const std::uint32_t index = distinct_[vertex];
    for (const AttributeFeed& feed : feeds_) {
      const std::uint64_t element = feed.per_instance ? instance_index_ : index;
      const std::array<double, 4> values =
          read_attribute(*feed.buffer, feed.offset + element * feed.stride, feed.format);
      for (std::size_t c = 0; c < 4; ++c) {
        if (feed.slots[c] == kNoSlot) continue;
        Cell& cell = lanes_.cells[feed.slots[c]];
        feed.integers ? cell.set_u(lane, static_cast<std::uint32_t>(values[c])) : cell.set_f(lane, values[c]);
      }
    }
    if (program_.builtins.vertex_index != kNoSlot)
      lanes_.cells[program_.builtins.vertex_index].set_u(lane, index);
    if (program_.builtins.instance_index != kNoSlot)
      lanes_.cells[program_.builtins.instance_index].set_u(lane, instance_index_);
  }

  void store(std::size_t vertex, std::size_t lane) {
    for (std::uint32_t c = 0; c < 4; ++c)
      out_.clip[vertex][c] = lanes_.cells[program_.builtins.position + c].f(static_cast<int>(lane));
    for (std::size_t i = 0; i < out_.ports; ++i)
      out_.outputs[vertex * out_.ports + i] = lanes_.cells[program_.outputs[i].slot].bits[lane];
    store_extras(vertex, static_cast<int>(lane));
  }

  void store_extras(std::size_t vertex, int lane) {
    const BuiltinSlots& b = program_.builtins;
    if (b.point_size != kNoSlot) out_.point_size[vertex] = lanes_.cells[b.point_size].f(lane);
    if (b.viewport_index != kNoSlot) out_.viewport[vertex] = lanes_.cells[b.viewport_index].u(lane);
    if (out_.distances.empty()) return;
    for (std::uint32_t i = 0; i < b.clip_distances; ++i)
      out_.distances[vertex].push_back(lanes_.cells[b.clip_distance + i].f(lane));
    for (std::uint32_t i = 0; i < b.cull_distances; ++i)
      out_.distances[vertex].push_back(lanes_.cells[b.cull_distance + i].f(lane));
  }

  const ShaderProgram& program_;
  Lanes lanes_;
  const std::vector<AttributeFeed>& feeds_;
  std::uint32_t instance_index_;
  const std::vector<std::uint32_t>& distinct_;
  ShadedVertices& out_;
};

}  // namespace

std::array<double, 4> read_attribute(const traces::Buffer& buffer, std::uint64_t offset,
                                     traces::Format format) {
  const FormatLayout layout = layout_of(format);
  std::array<double, 4> values{0, 0, 0, 1};
  for (std::uint32_t c = 0; c < layout.components; ++c) {
    values[c] = component(read_bytes(buffer, offset + std::uint64_t{c} * layout.bytes, layout.bytes), layout);
  }
  return values;
}

ShadedVertices shade_vertices(const DrawState& state, const BoundShader& shader, std::uint32_t instance,
                              int threads) {
  if (shader.program->builtins.position == kNoSlot)
    throw user_error("shader '{}': does not write gl_Position", shader.program->name);
  ShadedVertices out;
  std::vector<std::uint32_t> distinct;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (const std::uint32_t index : vertex_indices(state, out.breaks)) {
    const auto [at, fresh] = number.try_emplace(index, static_cast<std::uint32_t>(distinct.size()));
    if (fresh) distinct.push_back(index);
    out.sequence.push_back(at->second);
  }
  out.ports = shader.program->outputs.size();
  out.clip.resize(distinct.size());
  out.outputs.resize(distinct.size() * out.ports);
  const BuiltinSlots& b = shader.program->builtins;
  if (b.point_size != kNoSlot) out.point_size.resize(distinct.size());
  if (b.viewport_index != kNoSlot) out.viewport.resize(distinct.size());
  if (b.clip_distances + b.cull_distances > 0) out.distances.resize(distinct.size());
  out.clip_distances = b.clip_distances;
  const std::vector<AttributeFeed> feeds = attribute_feeds(state, *shader.program);
  const std::uint32_t instance_index = state.draw->first_instance + instance;
  run_tasks((distinct.size() + kVerticesPerTask - 1) / kVerticesPerTask, threads,
            [&] { return VertexWorker(shader, feeds, instance_index, distinct, out); });
  return out;
}

namespace {

using Primitives = std::vector<std::array<std::uint32_t, 3>>;

/// Those of the vertices from `first` to before `end`.
void assemble_run(traces::Topology topology, std::uint32_t first, std::uint32_t end, Primitives& out) {
  using traces::Topology;
  switch (topology) {
    case Topology::kTriangleList:
      for (std::uint32_t i = first; end - i >= 3; i += 3) out.push_back({i, i + 1, i + 2});
      break;
    case Topology::kTriangleStrip:
      for (std::uint32_t i = first; i + 2 < end; ++i) {
        const std::uint32_t odd = (i - first) % 2;
        out.push_back({i, i + 1 + odd, i + 2 - odd});
      }
      break;
    case Topology::kTriangleFan:
      for (std::uint32_t i = first; i + 2 < end; ++i) out.push_back({i + 1, i + 2, first});
      break;
    case Topology::kPointList:
      for (std::uint32_t i = first; i < end; ++i) out.push_back({i, i, i});
      break;
    case Topology::kLineList:
      for (std::uint32_t i = first; end - i >= 2; i += 2) out.push_back({i, i + 1, i + 1});
      break;
    case Topology::kLineStrip:
      for (std::uint32_t i = first; i + 1 < end; ++i) out.push_back({i, i + 1, i + 1});
      break;
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> assemble(traces::Topology topology, std::uint32_t vertices,
                                                   std::span<const std::uint32_t> breaks) {
  Primitives primitives;
  std::uint32_t first = 0;
  for (const std::uint32_t at : breaks) {
    assemble_run(topology, first, at, primitives);
    first = at + 1;
  }
  if (first < vertices) assemble_run(topology, first, vertices, primitives);
  return primitives;
}

}  // namespace quadrille::models::reference
