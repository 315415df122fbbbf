/// What pipelines fix.
#include "traces/capture/raster_state.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/error.h"
#include "traces/capture/raster_commands.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

using models::kMaxColorAttachments;

void fix_vertex_input(RasterState& state, const Value& input) {
  const Value& bindings = input["pVertexBindingDescriptions"];
  for (std::size_t i = 0; i < bindings.size(); ++i)
    state.pipeline.bindings.push_back(binding_of(bindings.at(i)));
  if (input.next(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_DIVISOR_STATE_CREATE_INFO_EXT) != nullptr)
    throw user_error("divisors of instances are not supported");
  const Value& attributes = input["pVertexAttributeDescriptions"];
  for (std::size_t i = 0; i < attributes.size(); ++i) add_attribute(state, attributes.at(i));
}

void fix_rasterization(RasterState& state, const Value& raster) {
  traces::Pipeline& pipeline = state.pipeline;
  pipeline.depth_clamp = raster["depthClampEnable"].flag();
  state.discard = raster["rasterizerDiscardEnable"].flag();
  pipeline.polygon_mode = polygon_mode_of(raster["polygonMode"].u32());
  pipeline.cull = cull_of(raster["cullMode"].u32());
  pipeline.front = front_of(raster["frontFace"].u32());
  pipeline.depth_bias = {raster["depthBiasEnable"].flag(), raster["depthBiasConstantFactor"].f32(),
                         raster["depthBiasSlopeFactor"].f32(), raster["depthBiasClamp"].f32()};
  pipeline.line_width = raster["lineWidth"].f32();
  pipeline.line_mode = traces::LineMode::kRectangular;
  if (const Value* line = raster.next(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT)) {
    pipeline.line_mode = line_mode_of((*line)["lineRasterizationMode"].u32());
    state.stippled = (*line)["stippledLineEnable"].flag();
  }
  if (const Value* provoking =
          raster.next(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT))
    state.last_vertex = (*provoking)["provokingVertexMode"].u32() == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
}

traces::StencilFace stencil_face(const Value& from) {
  traces::StencilFace face;
  face.compare = compare_of(from["compareOp"].u32());
  face.fail = stencil_op_of(from["failOp"].u32());
  face.pass = stencil_op_of(from["passOp"].u32());
  face.depth_fail = stencil_op_of(from["depthFailOp"].u32());
  face.compare_mask = static_cast<std::uint8_t>(from["compareMask"].u32());
  face.write_mask = static_cast<std::uint8_t>(from["writeMask"].u32());
  face.reference = static_cast<std::uint8_t>(from["reference"].u32());
  return face;
}

void fix_depth_stencil(RasterState& state, const Value& from) {
  traces::Pipeline& pipeline = state.pipeline;
  pipeline.depth = {from["depthTestEnable"].flag(), from["depthWriteEnable"].flag(),
                    compare_of(from["depthCompareOp"].u32())};
  pipeline.depth_bounds = {from["depthBoundsTestEnable"].flag(), from["minDepthBounds"].f32(),
                           from["maxDepthBounds"].f32()};
  pipeline.stencil = {from["stencilTestEnable"].flag(), stencil_face(from["front"]),
                      stencil_face(from["back"])};
}

void fix_blending(RasterState& state, const Value& from) {
  models::BlendShared& shared = state.pipeline.blend_shared;
  shared.logic = from["logicOpEnable"].flag();
  shared.logic_op = logic_op_of(from["logicOp"].u32());
  for (std::size_t c = 0; c < 4 && c < from["blendConstants"].size(); ++c)
    shared.constants[c] = from["blendConstants"].f32(c);
  const Value& attachments = from["pAttachments"];
  for (std::size_t i = 0; i < std::min<std::size_t>(attachments.size(), kMaxColorAttachments); ++i) {
    traces::BlendState& blend = state.pipeline.blend[i];
    take_equation(blend, attachments.at(i));
    blend.enable = attachments.at(i)["blendEnable"].flag();
    blend.write_mask = static_cast<std::uint8_t>(attachments.at(i)["colorWriteMask"].u32() & 0xf);
  }
}

void fix_samples(RasterState& state, const Value& from) {
  state.samples = from["rasterizationSamples"].u32();
  state.pipeline.sample_shading = from["sampleShadingEnable"].flag();
  if (!from["pSampleMask"].null()) state.pipeline.sample_mask = from["pSampleMask"].u32();
  state.pipeline.alpha_to_coverage = from["alphaToCoverageEnable"].flag();
  state.alpha_to_one = from["alphaToOneEnable"].flag();
}

}  // namespace

RasterState fixed_state(const Value& info) {
  RasterState state;
  if (!info["pVertexInputState"].null()) fix_vertex_input(state, info["pVertexInputState"]);
  if (const Value& assembly = info["pInputAssemblyState"]; !assembly.null()) {
    if (assembly["topology"].u32() <= VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN)
      state.pipeline.topology = topology_of(assembly["topology"].u32());
    state.pipeline.primitive_restart = assembly["primitiveRestartEnable"].flag();
  }
  if (const Value& viewport = info["pViewportState"]; !viewport.null()) {
    set_viewports(state, viewport["pViewports"], 0, viewport["viewportCount"].u32());
    set_scissors(state, viewport["pScissors"], 0, viewport["scissorCount"].u32());
    if (const Value* clip =
            viewport.next(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT))
      state.negative_one_to_one = (*clip)["negativeOneToOne"].flag();
  }
  if (!info["pRasterizationState"].null()) fix_rasterization(state, info["pRasterizationState"]);
  if (!info["pMultisampleState"].null()) fix_samples(state, info["pMultisampleState"]);
  if (!info["pDepthStencilState"].null()) fix_depth_stencil(state, info["pDepthStencilState"]);
  if (!info["pColorBlendState"].null()) fix_blending(state, info["pColorBlendState"]);
  return state;
}

}  // namespace quadrille::capture
