/// Which dynamic state a pipeline leaves to commands, and what of it a draw takes.
#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/error.h"
#include "traces/capture/raster_state.h"

namespace quadrille::capture {
namespace {

void take_stencil(traces::StencilFace& to, const traces::StencilFace& from, std::uint32_t state) {
  if (state == VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK) to.compare_mask = from.compare_mask;
  if (state == VK_DYNAMIC_STATE_STENCIL_WRITE_MASK) to.write_mask = from.write_mask;
  if (state == VK_DYNAMIC_STATE_STENCIL_REFERENCE) to.reference = from.reference;
  if (state == VK_DYNAMIC_STATE_STENCIL_OP) {
    to.fail = from.fail;
    to.pass = from.pass;
    to.depth_fail = from.depth_fail;
    to.compare = from.compare;
  }
}

void take_blend(traces::BlendState& to, const traces::BlendState& from, std::uint32_t state) {
  traces::BlendState taken = from;
  taken.enable = to.enable;
  taken.write_mask = to.write_mask;
  if (state == VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT) to.enable = from.enable;
  if (state == VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT) to.write_mask = from.write_mask;
  if (state == VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT) to = taken;
}

/// True if it knows that state.
bool take_geometry(RasterState& to, const RasterState& from, std::uint32_t state) {
  traces::Pipeline& p = to.pipeline;
  const traces::Pipeline& d = from.pipeline;
  switch (state) {
    case VK_DYNAMIC_STATE_VIEWPORT:
    case VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT: to.viewports = from.viewports; return true;
    case VK_DYNAMIC_STATE_SCISSOR:
    case VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT: to.scissors = from.scissors; return true;
    case VK_DYNAMIC_STATE_LINE_WIDTH: p.line_width = d.line_width; return true;
    case VK_DYNAMIC_STATE_DEPTH_BIAS: {
      const bool enable = p.depth_bias.enable;
      p.depth_bias = d.depth_bias;
      p.depth_bias.enable = enable;
      return true;
    }
    case VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE: p.depth_bias.enable = d.depth_bias.enable; return true;
    case VK_DYNAMIC_STATE_CULL_MODE: p.cull = d.cull; return true;
    case VK_DYNAMIC_STATE_FRONT_FACE: p.front = d.front; return true;
    case VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY: p.topology = d.topology; return true;
    case VK_DYNAMIC_STATE_PRIMITIVE_RESTART_ENABLE: p.primitive_restart = d.primitive_restart; return true;
    case VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE: to.discard = from.discard; return true;
    case VK_DYNAMIC_STATE_VERTEX_INPUT_EXT:
      p.bindings = d.bindings;
      p.attributes = d.attributes;
      to.expanded = from.expanded;
      return true;
    case VK_DYNAMIC_STATE_POLYGON_MODE_EXT: p.polygon_mode = d.polygon_mode; return true;
    case VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT: p.depth_clamp = d.depth_clamp; return true;
    case VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT: return true;
    case VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT:
      to.negative_one_to_one = from.negative_one_to_one;
      return true;
    case VK_DYNAMIC_STATE_PROVOKING_VERTEX_MODE_EXT: to.last_vertex = from.last_vertex; return true;
    case VK_DYNAMIC_STATE_LINE_RASTERIZATION_MODE_EXT: p.line_mode = d.line_mode; return true;
    case VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT: to.stippled = from.stippled; return true;
    case VK_DYNAMIC_STATE_LINE_STIPPLE_EXT:
    case VK_DYNAMIC_STATE_PATCH_CONTROL_POINTS_EXT: return true;
    default: return false;
  }
}

bool take_tests(RasterState& to, const RasterState& from, std::uint32_t state) {
  traces::Pipeline& p = to.pipeline;
  const traces::Pipeline& d = from.pipeline;
  switch (state) {
    case VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE: p.depth.test = d.depth.test; return true;
    case VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE: p.depth.write = d.depth.write; return true;
    case VK_DYNAMIC_STATE_DEPTH_COMPARE_OP: p.depth.compare = d.depth.compare; return true;
    case VK_DYNAMIC_STATE_DEPTH_BOUNDS_TEST_ENABLE: p.depth_bounds.test = d.depth_bounds.test; return true;
    case VK_DYNAMIC_STATE_DEPTH_BOUNDS:
      p.depth_bounds.least = d.depth_bounds.least;
      p.depth_bounds.most = d.depth_bounds.most;
      return true;
    case VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE: p.stencil.test = d.stencil.test; return true;
    case VK_DYNAMIC_STATE_STENCIL_OP:
    case VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK:
    case VK_DYNAMIC_STATE_STENCIL_WRITE_MASK:
    case VK_DYNAMIC_STATE_STENCIL_REFERENCE:
      take_stencil(p.stencil.front, d.stencil.front, state);
      take_stencil(p.stencil.back, d.stencil.back, state);
      return true;
    case VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT: to.samples = from.samples; return true;
    case VK_DYNAMIC_STATE_SAMPLE_MASK_EXT: p.sample_mask = d.sample_mask; return true;
    case VK_DYNAMIC_STATE_ALPHA_TO_COVERAGE_ENABLE_EXT:
      p.alpha_to_coverage = d.alpha_to_coverage;
      return true;
    case VK_DYNAMIC_STATE_ALPHA_TO_ONE_ENABLE_EXT: to.alpha_to_one = from.alpha_to_one; return true;
    default: return false;
  }
}

bool take_blending(RasterState& to, const RasterState& from, std::uint32_t state) {
  traces::Pipeline& p = to.pipeline;
  const traces::Pipeline& d = from.pipeline;
  switch (state) {
    case VK_DYNAMIC_STATE_BLEND_CONSTANTS: p.blend_shared.constants = d.blend_shared.constants; return true;
    case VK_DYNAMIC_STATE_LOGIC_OP_EXT: p.blend_shared.logic_op = d.blend_shared.logic_op; return true;
    case VK_DYNAMIC_STATE_LOGIC_OP_ENABLE_EXT: p.blend_shared.logic = d.blend_shared.logic; return true;
    case VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT: to.color_write = from.color_write; return true;
    case VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT:
    case VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT:
    case VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT:
      for (std::size_t i = 0; i < p.blend.size(); ++i) take_blend(p.blend[i], d.blend[i], state);
      return true;
    default: return false;
  }
}

}  // namespace

RasterState combined_state(const Value& info, const RasterState& fixed, const RasterState& dynamic) {
  RasterState state = fixed;
  if (info["pDynamicState"].null()) return state;
  const Value& states = info["pDynamicState"]["pDynamicStates"];
  for (std::size_t i = 0; i < states.size(); ++i) {
    const std::uint32_t number = states.u32(i);
    if (!take_geometry(state, dynamic, number) && !take_tests(state, dynamic, number) &&
        !take_blending(state, dynamic, number))
      throw user_error("VkDynamicState {} is not supported", number);
  }
  return state;
}

}  // namespace quadrille::capture
