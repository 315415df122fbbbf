#include "pipeline/compiler/compile.h"

#include "models/base/error.h"
#include "pipeline/compiler/emit.h"
#include "pipeline/compiler/lower.h"
#include "pipeline/compiler/passes.h"
#include "pipeline/compiler/spirv_module.h"
#include "pipeline/compiler/spirv_optimise.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

using models::Op;

ScalarShader compile_stage(std::span<const std::uint32_t> words, std::string_view name,
                           models::ShaderStage stage) {
  OptimisedSpirv optimised = optimise_spirv(words, name);
  spirv::Module module(std::move(optimised.words), stage, name);
  module.kills_return = optimised.kills_return;
  ScalarShader lowered = lower_shader(module, stage);
  if (!module.unsupported_capability.empty()) throw user_error("{}: {}", name, module.unsupported_capability);
  return lowered;
}

/// Packs the varyings that the fragment shader still reads, in order of location and component.
Linkage link(const ScalarShader& fragment) {
  std::vector<std::uint16_t> read;
  for (const ScalarInstruction& i : fragment.code)
    if (i.op == Op::kInterp) read.push_back(i.imm);
  std::sort(read.begin(), read.end());
  read.erase(std::unique(read.begin(), read.end()), read.end());
  Linkage linkage;
  for (const std::uint16_t raw : read) {
    linkage.varyings.emplace(raw, static_cast<std::uint16_t>(linkage.interpolation.size()));
    linkage.interpolation.push_back(fragment.varyings.at(raw));
  }
  if (read.size() > static_cast<std::size_t>(models::kMaxVaryings))
    throw user_error("{}: the fragment shader reads {} varying components; at most {} are possible",
                     fragment.name, read.size(), models::kMaxVaryings);
  return linkage;
}

/// What the vertex shader writes for the fixed functions; of gl_ClipDistance and gl_CullDistance, up to the
/// last element that is written.
models::VertexExtras extras_of(const ScalarShader& vertex) {
  models::VertexExtras extras;
  const auto up_to = [](std::uint8_t& count, std::uint16_t index) {
    count = std::max(count, static_cast<std::uint8_t>(index + 1));
  };
  for (const ScalarInstruction& i : vertex.code) {
    if (i.op != Op::kOutput || i.imm < kRawPointSize) continue;
    if (i.imm == kRawPointSize) extras.point_size = true;
    else if (i.imm == kRawViewportIndex) extras.viewport_index = true;
    else if (i.imm < kRawCullDistance)
      up_to(extras.clip_distances, static_cast<std::uint16_t>(i.imm - kRawClipDistance));
    else up_to(extras.cull_distances, static_cast<std::uint16_t>(i.imm - kRawCullDistance));
  }
  if (extras.clip_distances + extras.cull_distances > models::kMaxUserDistances)
    throw user_error("{}: {} clip and {} cull distances; at most {} together are possible", vertex.name,
                     extras.clip_distances, extras.cull_distances, models::kMaxUserDistances);
  return extras;
}

/// Removes vertex outputs that nobody reads and checks that those read are written.
void drop_unread_outputs(ScalarShader& vertex, const ScalarShader& fragment, const Linkage& linkage,
                         bool points) {
  const auto varying = [](const ScalarInstruction& i) {
    return static_cast<std::uint16_t>(i.imm - models::kFirstVaryingOutput);
  };
  const auto is_varying = [](const ScalarInstruction& i) {
    return i.op == Op::kOutput && i.imm >= models::kFirstVaryingOutput && i.imm < kRawPointSize;
  };
  for (const auto& [raw, packed] : linkage.varyings) {
    const bool written = std::any_of(
        vertex.code.begin(), vertex.code.end(),
        [&, raw = raw](const ScalarInstruction& i) { return is_varying(i) && varying(i) == raw; });
    if (!written)
      throw user_error("{}: reads location {} component {}, which the vertex shader {} does not write",
                       fragment.name, raw / 4, raw % 4, vertex.name);
  }
  std::erase_if(vertex.code, [&](const ScalarInstruction& i) {
    if (i.op == Op::kOutput && i.imm == kRawPointSize) return !points;
    return is_varying(i) && !linkage.varyings.contains(varying(i));
  });
}

}  // namespace

CompiledPipeline compile_pipeline(std::span<const std::uint32_t> vertex_spirv, std::string_view vertex_name,
                                  std::span<const std::uint32_t> fragment_spirv,
                                  std::string_view fragment_name, const ShaderTarget& target, bool points) {
  ScalarShader fragment = compile_stage(fragment_spirv, fragment_name, models::ShaderStage::kFragment);
  clean_up(fragment);
  Linkage linkage = link(fragment);
  ScalarShader vertex = compile_stage(vertex_spirv, vertex_name, models::ShaderStage::kVertex);
  drop_unread_outputs(vertex, fragment, linkage, points);
  linkage.extras = extras_of(vertex);
  clean_up(vertex);
  CompiledPipeline pipeline{emit_program(vertex, linkage, target), emit_program(fragment, linkage, target),
                            vertex.integer_inputs};
  models::prepare(pipeline.vertex);
  models::prepare(pipeline.fragment);
  return pipeline;
}

}  // namespace quadrille::pipeline
