/// What commands set, and which of it counts for a draw.
#include "traces/capture/raster_commands.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <functional>
#include <map>

#include "models/base/error.h"
#include "traces/capture/attributes.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

using models::kMaxColorAttachments;
using models::kMaxViewports;
using Setter = std::function<void(RasterState&, const Value&)>;

/// Attachments that a command names, with a value each.
template <class F>
void each_attachment(const Value& call, std::string_view values, F&& set) {
  const std::uint32_t first = call["firstAttachment"].u32();
  for (std::size_t i = 0; i < call[values].size() && first + i < kMaxColorAttachments; ++i)
    set(first + i, call[values], i);
}

/// The faces that a command names.
template <class F>
void each_face(RasterState& s, const Value& call, F&& set) {
  const std::uint32_t faces = call["faceMask"].u32();
  if ((faces & VK_STENCIL_FACE_FRONT_BIT) != 0) set(s.pipeline.stencil.front);
  if ((faces & VK_STENCIL_FACE_BACK_BIT) != 0) set(s.pipeline.stencil.back);
}

void set_stencil_op(RasterState& s, const Value& call) {
  each_face(s, call, [&](traces::StencilFace& face) {
    face.fail = stencil_op_of(call["failOp"].u32());
    face.pass = stencil_op_of(call["passOp"].u32());
    face.depth_fail = stencil_op_of(call["depthFailOp"].u32());
    face.compare = compare_of(call["compareOp"].u32());
  });
}

void set_vertex_input(RasterState& s, const Value& call) {
  s.pipeline.bindings.clear();
  s.pipeline.attributes.clear();
  s.expanded.clear();
  const Value& bindings = call["pVertexBindingDescriptions"];
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    if (bindings.at(i)["inputRate"].u32() == VK_VERTEX_INPUT_RATE_INSTANCE &&
        bindings.at(i)["divisor"].u32() != 1)
      throw user_error("divisor {} of instances is not supported", bindings.at(i)["divisor"].u32());
    s.pipeline.bindings.push_back(binding_of(bindings.at(i)));
  }
  const Value& attributes = call["pVertexAttributeDescriptions"];
  for (std::size_t i = 0; i < attributes.size(); ++i) add_attribute(s, attributes.at(i));
}

void set_sample_mask(RasterState& s, const Value& c) {
  s.pipeline.sample_mask = c["pSampleMask"].null() ? ~0u : c["pSampleMask"].u32();
}

const std::map<std::string_view, Setter>& tests() {
  static const std::map<std::string_view, Setter> kSetters{
      {"CmdSetDepthTestEnable",
       [](auto& s, auto& c) { s.pipeline.depth.test = c["depthTestEnable"].flag(); }},
      {"CmdSetDepthWriteEnable",
       [](auto& s, auto& c) { s.pipeline.depth.write = c["depthWriteEnable"].flag(); }},
      {"CmdSetDepthCompareOp",
       [](auto& s, auto& c) { s.pipeline.depth.compare = compare_of(c["depthCompareOp"].u32()); }},
      {"CmdSetDepthBoundsTestEnable",
       [](auto& s, auto& c) { s.pipeline.depth_bounds.test = c["depthBoundsTestEnable"].flag(); }},
      {"CmdSetDepthBounds",
       [](auto& s, auto& c) {
         s.pipeline.depth_bounds.least = c["minDepthBounds"].f32();
         s.pipeline.depth_bounds.most = c["maxDepthBounds"].f32();
       }},
      {"CmdSetStencilTestEnable",
       [](auto& s, auto& c) { s.pipeline.stencil.test = c["stencilTestEnable"].flag(); }},
      {"CmdSetStencilOp", set_stencil_op},
      {"CmdSetStencilCompareMask",
       [](auto& s, auto& c) {
         each_face(s, c,
                   [&](auto& f) { f.compare_mask = static_cast<std::uint8_t>(c["compareMask"].u32()); });
       }},
      {"CmdSetStencilWriteMask",
       [](auto& s, auto& c) {
         each_face(s, c, [&](auto& f) { f.write_mask = static_cast<std::uint8_t>(c["writeMask"].u32()); });
       }},
      {"CmdSetStencilReference",
       [](auto& s, auto& c) {
         each_face(s, c, [&](auto& f) { f.reference = static_cast<std::uint8_t>(c["reference"].u32()); });
       }},
      {"CmdSetRasterizationSamplesEXT",
       [](auto& s, auto& c) { s.samples = c["rasterizationSamples"].u32(); }},
      {"CmdSetSampleMaskEXT", set_sample_mask},
      {"CmdSetAlphaToCoverageEnableEXT",
       [](auto& s, auto& c) { s.pipeline.alpha_to_coverage = c["alphaToCoverageEnable"].flag(); }},
      {"CmdSetAlphaToOneEnableEXT", [](auto& s, auto& c) { s.alpha_to_one = c["alphaToOneEnable"].flag(); }},
  };
  return kSetters;
}

const std::map<std::string_view, Setter>& blending() {
  static const std::map<std::string_view, Setter> kSetters{
      {"CmdSetLogicOpEXT",
       [](auto& s, auto& c) { s.pipeline.blend_shared.logic_op = logic_op_of(c["logicOp"].u32()); }},
      {"CmdSetLogicOpEnableEXT",
       [](auto& s, auto& c) { s.pipeline.blend_shared.logic = c["logicOpEnable"].flag(); }},
      {"CmdSetBlendConstants",
       [](auto& s, auto& c) {
         for (std::size_t i = 0; i < 4; ++i)
           s.pipeline.blend_shared.constants[i] = c["blendConstants"].f32(i);
       }},
      {"CmdSetColorBlendEnableEXT",
       [](auto& s, auto& c) {
         each_attachment(c, "pColorBlendEnables",
                         [&](auto at, auto& v, auto i) { s.pipeline.blend[at].enable = v.flag(i); });
       }},
      {"CmdSetColorBlendEquationEXT",
       [](auto& s, auto& c) {
         each_attachment(c, "pColorBlendEquations",
                         [&](auto at, auto& v, auto i) { take_equation(s.pipeline.blend[at], v.at(i)); });
       }},
      {"CmdSetColorWriteMaskEXT",
       [](auto& s, auto& c) {
         each_attachment(c, "pColorWriteMasks", [&](auto at, auto& v, auto i) {
           s.pipeline.blend[at].write_mask = static_cast<std::uint8_t>(v.u32(i) & 0xf);
         });
       }},
      {"CmdSetColorWriteEnableEXT",
       [](auto& s, auto& c) {
         const Value& enables = c["pColorWriteEnables"];
         for (std::size_t i = 0; i < enables.size() && i < kMaxColorAttachments; ++i)
           s.color_write[i] = enables.flag(i);
       }},
  };
  return kSetters;
}

const std::map<std::string_view, Setter>& geometry() {
  static const std::map<std::string_view, Setter> kSetters{
      {"CmdSetViewport",
       [](auto& s, auto& c) {
         set_viewports(s, c["pViewports"], c["firstViewport"].u32(), c["viewportCount"].u32());
       }},
      {"CmdSetScissor",
       [](auto& s, auto& c) {
         set_scissors(s, c["pScissors"], c["firstScissor"].u32(), c["scissorCount"].u32());
       }},
      {"CmdSetViewportWithCount",
       [](auto& s, auto& c) {
         s.viewports.clear();
         set_viewports(s, c["pViewports"], 0, c["viewportCount"].u32());
       }},
      {"CmdSetScissorWithCount",
       [](auto& s, auto& c) {
         s.scissors.clear();
         set_scissors(s, c["pScissors"], 0, c["scissorCount"].u32());
       }},
      {"CmdSetVertexInputEXT", set_vertex_input},
      {"CmdSetPrimitiveTopology",
       [](auto& s, auto& c) { s.pipeline.topology = topology_of(c["primitiveTopology"].u32()); }},
      {"CmdSetPrimitiveRestartEnable",
       [](auto& s, auto& c) { s.pipeline.primitive_restart = c["primitiveRestartEnable"].flag(); }},
      {"CmdSetCullMode", [](auto& s, auto& c) { s.pipeline.cull = cull_of(c["cullMode"].u32()); }},
      {"CmdSetFrontFace", [](auto& s, auto& c) { s.pipeline.front = front_of(c["frontFace"].u32()); }},
      {"CmdSetPolygonModeEXT",
       [](auto& s, auto& c) { s.pipeline.polygon_mode = polygon_mode_of(c["polygonMode"].u32()); }},
      {"CmdSetRasterizerDiscardEnable",
       [](auto& s, auto& c) { s.discard = c["rasterizerDiscardEnable"].flag(); }},
      {"CmdSetDepthBiasEnable",
       [](auto& s, auto& c) { s.pipeline.depth_bias.enable = c["depthBiasEnable"].flag(); }},
      {"CmdSetDepthBias",
       [](auto& s, auto& c) {
         models::DepthBias& bias = s.pipeline.depth_bias;
         bias.constant = c["depthBiasConstantFactor"].f32();
         bias.clamp = c["depthBiasClamp"].f32();
         bias.slope = c["depthBiasSlopeFactor"].f32();
       }},
      // With clipping off depths are clamped; both commands are given, and the second one says it again.
      {"CmdSetDepthClampEnableEXT",
       [](auto& s, auto& c) { s.pipeline.depth_clamp = c["depthClampEnable"].flag(); }},
      {"CmdSetDepthClipEnableEXT", [](auto&, auto&) {}},
      {"CmdSetDepthClipNegativeOneToOneEXT",
       [](auto& s, auto& c) { s.negative_one_to_one = c["negativeOneToOne"].flag(); }},
      {"CmdSetProvokingVertexModeEXT",
       [](auto& s, auto& c) {
         s.last_vertex = c["provokingVertexMode"].u32() == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
       }},
      {"CmdSetLineWidth", [](auto& s, auto& c) { s.pipeline.line_width = c["lineWidth"].f32(); }},
      {"CmdSetLineRasterizationModeEXT",
       [](auto& s, auto& c) { s.pipeline.line_mode = line_mode_of(c["lineRasterizationMode"].u32()); }},
      {"CmdSetLineStippleEnableEXT", [](auto& s, auto& c) { s.stippled = c["stippledLineEnable"].flag(); }},
  };
  return kSetters;
}

}  // namespace

traces::VertexBinding binding_of(const Value& d) {
  return {d["binding"].u32(), d["stride"].u32(), d["inputRate"].u32() == VK_VERTEX_INPUT_RATE_INSTANCE};
}
void add_attribute(RasterState& state, const Value& d) {
  const std::uint32_t format = d["format"].u32(), location = d["location"].u32();
  traces::Format fetched = attribute_format(format);
  if (fetched == traces::Format::kUndefined) {
    fetched = expanded_attribute_format(format);
    state.expanded[location] = format;
  }
  if (fetched == traces::Format::kUndefined)
    throw user_error("a vertex attribute of {} is not supported", format_name(format));
  state.pipeline.attributes.push_back({location, d["binding"].u32(), fetched, d["offset"].u32()});
}
traces::FrontFace front_of(std::uint32_t value) {
  return value == VK_FRONT_FACE_CLOCKWISE ? traces::FrontFace::kClockwise
                                          : traces::FrontFace::kCounterClockwise;
}

void take_equation(traces::BlendState& blend, const Value& from) {
  blend.src_color = blend_factor_of(from["srcColorBlendFactor"].u32());
  blend.dst_color = blend_factor_of(from["dstColorBlendFactor"].u32());
  blend.color = blend_op_of(from["colorBlendOp"].u32());
  blend.src_alpha = blend_factor_of(from["srcAlphaBlendFactor"].u32());
  blend.dst_alpha = blend_factor_of(from["dstAlphaBlendFactor"].u32());
  blend.alpha = blend_op_of(from["alphaBlendOp"].u32());
}

void set_viewports(RasterState& state, const Value& from, std::uint32_t first, std::uint32_t count) {
  if (first > kMaxViewports || count > kMaxViewports - first)
    throw user_error("viewports {}+{}; there are {}", first, count, kMaxViewports);
  if (state.viewports.size() < first + count) state.viewports.resize(first + count);
  for (std::uint32_t i = 0; i < count && i < from.size(); ++i) {
    const Value& v = from.at(i);
    state.viewports[first + i] = {v["x"].f32(),      v["y"].f32(),        v["width"].f32(),
                                  v["height"].f32(), v["minDepth"].f32(), v["maxDepth"].f32(),
                                  first + i};
  }
}

void set_scissors(RasterState& state, const Value& from, std::uint32_t first, std::uint32_t count) {
  if (first > kMaxViewports || count > kMaxViewports - first)
    throw user_error("scissors {}+{}; there are {}", first, count, kMaxViewports);
  if (state.scissors.size() < first + count) state.scissors.resize(first + count);
  for (std::uint32_t i = 0; i < count && i < from.size(); ++i) {
    const Value& r = from.at(i);
    state.scissors[first + i] = {r["offset"]["x"].i32(), r["offset"]["y"].i32(), r["extent"]["width"].u32(),
                                 r["extent"]["height"].u32(), first + i};
  }
}

bool set_dynamic_state(RasterState& dynamic, const Call& call) {
  for (const auto* setters : {&geometry(), &tests(), &blending()}) {
    const auto found = setters->find(call.name);
    if (found == setters->end()) continue;
    found->second(dynamic, call.parameters);
    return true;
  }
  return false;
}

}  // namespace quadrille::capture
