/// Draws: a pipeline, descriptor sets and buffers of the stream from what is bound.
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"
#include "traces/capture/provoking.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

std::map<std::uint32_t, std::uint32_t> constants_of(const Value& stage) {
  std::map<std::uint32_t, std::uint32_t> constants;
  if (stage["pSpecializationInfo"].null()) return constants;
  const Value& info = stage["pSpecializationInfo"];
  const std::span<const std::byte> data = info["pData"].bytes();
  for (std::size_t i = 0; i < info["pMapEntries"].size(); ++i) {
    const Value& entry = info["pMapEntries"].at(i);
    const std::uint64_t offset = entry["offset"].u32(), size = entry["size"].u64();
    if (size != sizeof(std::uint32_t) || offset > data.size() || size > data.size() - offset)
      throw user_error("a specialisation constant of {} bytes at byte {} of {}", size, offset, data.size());
    std::memcpy(&constants[entry["constantID"].u32()], data.data() + offset, sizeof(std::uint32_t));
  }
  return constants;
}

/// Outputs whose locations are not the places of what they write to. Those without an attachment go behind
/// the others, so that each place has one.
std::map<std::uint32_t, std::uint32_t> moved_outputs(std::span<const traces::Index> places) {
  std::map<std::uint32_t, std::uint32_t> moved;
  auto behind =
      static_cast<std::uint32_t>(std::ranges::count_if(places, [](auto p) { return p != traces::kNone; }));
  for (std::uint32_t location = 0; location < places.size(); ++location) {
    const std::uint32_t place = places[location] != traces::kNone ? places[location] : behind++;
    if (place != location) moved[location] = place;
  }
  return moved;
}

}  // namespace

bool FrameRecorder::draw(const Call& call, const BoundState& bound) {
  const Value& p = call.parameters;
  const auto draw_range = [&](bool indexed, const Value& count, const Value& first, std::int32_t offset) {
    draw_one(bound,
             {indexed, count.u32(), first.u32(), offset, p["instanceCount"].u32(), p["firstInstance"].u32()});
  };
  if (call.name == "CmdDraw") {
    draw_range(false, p["vertexCount"], p["firstVertex"], 0);
  } else if (call.name == "CmdDrawIndexed") {
    draw_range(true, p["indexCount"], p["firstIndex"], p["vertexOffset"].i32());
  } else if (call.name == "CmdDrawMultiEXT") {
    for (std::size_t i = 0; i < p["pVertexInfo"].size(); ++i) {
      const Value& one = p["pVertexInfo"].at(i);
      draw_range(false, one["vertexCount"], one["firstVertex"], 0);
    }
  } else if (call.name == "CmdDrawMultiIndexedEXT") {
    for (std::size_t i = 0; i < p["pIndexInfo"].size(); ++i) {
      const Value& one = p["pIndexInfo"].at(i);
      const std::int32_t offset =
          p["pVertexOffset"].null() ? one["vertexOffset"].i32() : p["pVertexOffset"].i32();
      draw_range(true, one["indexCount"], one["firstIndex"], offset);
    }
  } else {
    return draw_indirect(call, bound);
  }
  return true;
}

void FrameRecorder::draw_one(const BoundState& bound, const DrawRange& range) {
  if (!in_pass_) throw user_error("outside a pass");
  if (bound.pipeline == nullptr) throw user_error("without a pipeline");
  const RasterState state = combined_state(*bound.pipeline->state, bound.fixed, bound.dynamic);
  if (state.discard) return;
  traces::Pipeline pipeline = pipeline_of(bound, state, range.first_instance);
  traces::Draw made;
  made.indexed = range.indexed;
  made.count = range.count;
  made.first = range.first;
  made.vertex_offset = range.vertex_offset;
  made.instances = range.instances;
  made.first_instance = range.first_instance;
  for (const std::string& label : labels_) made.label += (made.label.empty() ? "" : "/") + label;
  if (state.last_vertex && tables_.facts(pipeline.fragment_shader).flat_input)
    turn_primitives(bound, pipeline, made);
  else if (made.indexed)
    emit_change(
        0, traces::BindIndexBuffer{tables_.buffer(bound.index_buffer), bound.index_offset, bound.index_type});
  emit_buffers(bound, pipeline);
  expand_attributes(bound, state, pipeline);
  emit_change(0, traces::BindPipeline{tables_.pipeline(pipeline)});
  emit_window(state);
  emit_sets(bound, pipeline);
  if (!bound.constants.empty()) emit_change(0, traces::PushConstants{0, bound.constants});
  tables_.stream.commands.emplace_back(std::move(made));
  drew_ = true;
}

void FrameRecorder::turn_primitives(const BoundState& bound, traces::Pipeline& pipeline, traces::Draw& draw) {
  constexpr std::uint32_t kMostVertices = 1u << 26;  // [G: far beyond what flat shading is used for]
  if (draw.count > kMostVertices)
    throw user_error("a draw of {} vertices whose last ones provoke", draw.count);
  std::vector<std::optional<std::uint32_t>> vertices(draw.indexed ? 0 : draw.count);
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = draw.first + static_cast<std::uint32_t>(i);
  if (draw.indexed)
    vertices = read_indices(device_.contents(object(device_.buffers, bound.index_buffer, "buffer")),
                            bound.index_offset, bound.index_type, draw.first, draw.count,
                            pipeline.primitive_restart);
  else draw.vertex_offset = 0;
  const std::vector<std::uint32_t> indices = turned_indices(pipeline.topology, vertices);
  pipeline.topology = turned_topology(pipeline.topology);
  pipeline.primitive_restart = false;
  draw.indexed = true;
  draw.first = 0;
  draw.count = static_cast<std::uint32_t>(indices.size());
  emit_change(0, traces::BindIndexBuffer{tables_.index_buffer(indices), 0, traces::IndexType::kUint32});
}

traces::Index FrameRecorder::stage_of(const Value& stage, bool negative_one_to_one,
                                      std::uint32_t first_instance) {
  ShaderWish wish;
  wish.entry = stage["pName"].text();
  const bool vertex = stage["stage"].u32() == VK_SHADER_STAGE_VERTEX_BIT;
  wish.stage = vertex ? traces::ShaderStage::kVertex : traces::ShaderStage::kFragment;
  wish.constants = constants_of(stage);
  wish.negative_one_to_one = vertex && negative_one_to_one;
  if (!vertex) wish.outputs = moved_outputs(color_places_);
  const Handle module = stage["module"].u64();
  if (vertex && reads_first_instance(object(device_.modules, module, "shader module")))
    wish.first_instance = first_instance;
  return tables_.shader(module, wish);
}

traces::Pipeline FrameRecorder::pipeline_of(const BoundState& bound, const RasterState& state,
                                            std::uint32_t first_instance) {
  traces::Pipeline made = state.pipeline;
  const Value& stages = (*bound.pipeline->state)["pStages"];
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const Value& stage = stages.at(i);
    const std::uint32_t bit = stage["stage"].u32();
    if (bit == VK_SHADER_STAGE_VERTEX_BIT)
      made.vertex_shader = stage_of(stage, state.negative_one_to_one, first_instance);
    else if (bit == VK_SHADER_STAGE_FRAGMENT_BIT) made.fragment_shader = stage_of(stage, false, 0);
    else throw user_error("VkShaderStageFlagBits {:#x} is not supported", bit);
  }
  if (made.vertex_shader == traces::kNone) throw user_error("a pipeline without a vertex shader");
  place_colors(made, state);
  // Depths are tested and written all the same; colours are not defined. [VK1.3 #interfaces-fragmentoutput]
  if (made.fragment_shader == traces::kNone) {
    made.fragment_shader = tables_.own(OwnShader::kNothing);
    for (traces::BlendState& blend : made.blend) blend.write_mask = 0;
  }
  if (state.stippled) throw user_error("stippled lines are not supported");
  if (state.alpha_to_one) throw user_error("alpha to one is not supported");
  if (models::is_list(made.topology)) made.primitive_restart = false;
  if (pass_.depth.image == traces::kNone) {
    made.depth = {};
    made.stencil = {};
    made.depth_bounds = {};
  }
  made.viewports = static_cast<std::uint32_t>(std::max<std::size_t>(1, state.viewports.size()));
  for (const auto& [number, source] : bound.vertex_buffers) {
    const auto binding = std::ranges::find(made.bindings, number, &traces::VertexBinding::binding);
    if (binding != made.bindings.end() && source.stride) binding->stride = *source.stride;
  }
  return made;
}

/// Blending is by the location of an output; the stream has it by the place of the attachment.
void FrameRecorder::place_colors(traces::Pipeline& pipeline, const RasterState& state) const {
  if (pipeline.alpha_to_coverage && !color_places_.empty() && color_places_[0] == traces::kNone)
    throw user_error("alpha to coverage without colour attachment 0 is not supported");
  pipeline.blend = {};
  for (std::size_t location = 0; location < color_places_.size(); ++location) {
    if (color_places_[location] == traces::kNone) continue;
    traces::BlendState& blend = pipeline.blend.at(color_places_[location]);
    blend = state.pipeline.blend.at(location);
    if (!state.color_write.at(location)) blend.write_mask = 0;
  }
}

/// Vulkan lets a scissor reach beyond the target; what is beyond has no pixels.
void FrameRecorder::emit_window(const RasterState& state) {
  for (const traces::SetViewport& viewport : state.viewports) emit_change(viewport.index, viewport);
  for (traces::SetScissor scissor : state.scissors) {
    const auto clip = [](std::int32_t& begin, std::uint32_t& size, std::uint32_t side) {
      const std::int64_t from = std::clamp<std::int64_t>(begin, 0, side);
      const std::int64_t to = std::clamp<std::int64_t>(std::int64_t{begin} + size, from, side);
      begin = static_cast<std::int32_t>(from);
      size = static_cast<std::uint32_t>(to - from);
    };
    clip(scissor.x, scissor.width, pass_width_);
    clip(scissor.y, scissor.height, pass_height_);
    emit_change(scissor.index, scissor);
  }
}

void FrameRecorder::emit_buffers(const BoundState& bound, const traces::Pipeline& pipeline) {
  for (const traces::VertexBinding& binding : pipeline.bindings) {
    const auto source = bound.vertex_buffers.find(binding.binding);
    if (source == bound.vertex_buffers.end() || source->second.buffer == 0)
      throw user_error("without a vertex buffer at binding {}", binding.binding);
    emit_change(binding.binding,
                traces::BindVertexBuffer{binding.binding, tables_.buffer(source->second.buffer),
                                         source->second.offset});
  }
}

void FrameRecorder::expand_attributes(const BoundState& bound, const RasterState& state,
                                      traces::Pipeline& pipeline) {
  constexpr std::uint32_t kBindings = 16;
  for (traces::VertexAttribute& attribute : pipeline.attributes) {
    const auto format = state.expanded.find(attribute.location);
    if (format == state.expanded.end()) continue;
    const auto from =
        std::ranges::find(pipeline.bindings, attribute.binding, &traces::VertexBinding::binding);
    if (from == pipeline.bindings.end()) throw user_error("binding {} is not described", attribute.binding);
    std::uint32_t own = 0;
    while (own < kBindings && std::ranges::find(pipeline.bindings, own, &traces::VertexBinding::binding) !=
                                  pipeline.bindings.end())
      ++own;
    if (own == kBindings) throw user_error("too many vertex bindings, once attributes are expanded");
    const BoundState::VertexBuffer& source = bound.vertex_buffers.at(attribute.binding);
    const traces::Index buffer = tables_.expanded_attribute(
        source.buffer, {format->second, source.offset + attribute.offset, from->stride});
    pipeline.bindings.push_back({own, models::format_bytes(attribute.format), from->per_instance});
    attribute.binding = own;
    attribute.offset = 0;
    emit_change(own, traces::BindVertexBuffer{own, buffer, 0});
  }
}

}  // namespace quadrille::capture
