/// Textures and derivatives: combined 2D image samplers, of floats or integers. [VK1.3 #textures]
#include "pipeline/compiler/lowering.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

using models::Op;
using Kind = spirv::Type::Kind;

}  // namespace

models::NumberKind Lowering::number_kind(Id scalar) const {
  const spirv::Type& type = module_.type(scalar);
  if (type.kind != Kind::kInt) return models::NumberKind::kFloat;
  return type.is_signed ? models::NumberKind::kSint : models::NumberKind::kUint;
}

void Lowering::declare_texture(const spirv::Variable& variable) {
  const spirv::Type& type = module_.type(variable.type);
  if (type.kind != Kind::kSampledImage || module_.type(type.element).count != 2)
    throw user_error(
        "{}", module_.at_use(variable.id, fmt::format("resource {} is not a combined 2D image sampler "
                                                      "(sampler2D, isampler2D or usampler2D), the only "
                                                      "kinds supported",
                                                      module_.name(variable.id))));
  const spirv::Decorations& d = module_.decorations(variable.id);
  const models::TextureBinding binding{static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.set)),
                                       static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.binding)),
                                       number_kind(module_.type(type.element).element)};
  const auto found = std::find(shader_.textures.begin(), shader_.textures.end(), binding);
  textures_[variable.id] = static_cast<std::uint16_t>(found - shader_.textures.begin());
  if (found == shader_.textures.end()) shader_.textures.push_back(binding);
}

bool Lowering::image(const spirv::Instruction& i) {
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpImage:
      if (const auto found = textures_.find(i.operands[0]); found != textures_.end())
        textures_[i.result] = std::uint16_t{found->second};
      return true;
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleExplicitLod: sample(i, false); return true;
    case spv::OpImageSampleProjImplicitLod:
    case spv::OpImageSampleProjExplicitLod: sample(i, true); return true;
    case spv::OpImageQuerySizeLod: image_size(i); return true;
    case spv::OpDPdx:
    case spv::OpDPdy:
    case spv::OpFwidth:
    case spv::OpDPdxFine:
    case spv::OpDPdyFine:
    case spv::OpFwidthFine:
    case spv::OpDPdxCoarse:
    case spv::OpDPdyCoarse:
    case spv::OpFwidthCoarse: derivative(i); return true;
    default: return false;
  }
}

void Lowering::sample(const spirv::Instruction& i, bool projective) {
  const auto texture = textures_.find(i.operands[0]);
  if (texture == textures_.end()) throw unsupported(i, "sampling what is not a sampler2D variable");
  Values at = value(i.operands[1]);
  if (projective)
    for (std::size_t k = 0; k < 2; ++k) at[k] = build_.fdiv(at[k], at.back());
  const std::uint32_t mask = i.operands.size() > 2 ? i.operands[2] : 0;
  if ((mask & ~static_cast<std::uint32_t>(spv::ImageOperandsBiasMask | spv::ImageOperandsLodMask)) != 0)
    throw unsupported(i, "sampling with gradients, offsets or a minimum level (textureGrad, textureOffset)");
  const bool bias = (mask & spv::ImageOperandsBiasMask) != 0, lod = (mask & spv::ImageOperandsLodMask) != 0;
  const bool is_implicit = i.op == spv::OpImageSampleImplicitLod || i.op == spv::OpImageSampleProjImplicitLod;
  if (is_implicit && shader_.stage == models::ShaderStage::kVertex)
    throw unsupported(i, "implicit level of detail in a vertex shader (use textureLod)");
  const Op op = lod ? Op::kTexLod : bias ? Op::kTexBias : Op::kTexImplicit;
  const Value first =
      build_.emit_wide(op, at[0], at[1], bias || lod ? scalar(i.operands[3]) : Value{}, texture->second);
  Values result;
  for (std::uint32_t k = 0; k < 4; ++k) result.push_back({Value::Kind::kRegister, 0, first.bits + k});
  define(i, std::move(result));
}

void Lowering::image_size(const spirv::Instruction& i) {
  const auto texture = textures_.find(i.operands[0]);
  if (texture == textures_.end()) throw unsupported(i, "the size of what is not a sampler2D variable");
  const Value first = build_.emit_wide(Op::kTexSize, scalar(i.operands[1]), {}, {}, texture->second);
  define(i, {first, {Value::Kind::kRegister, 0, first.bits + 1}});
}

/// Plain derivatives are the fine ones: the difference along the lane's own row or column of the quad.
void Lowering::derivative(const spirv::Instruction& i) {
  const bool coarse = i.op == spv::OpDPdxCoarse || i.op == spv::OpDPdyCoarse || i.op == spv::OpFwidthCoarse;
  const Op dx = coarse ? Op::kDdxCoarse : Op::kDdxFine, dy = coarse ? Op::kDdyCoarse : Op::kDdyFine;
  const bool only_x = i.op == spv::OpDPdx || i.op == spv::OpDPdxFine || i.op == spv::OpDPdxCoarse;
  const bool only_y = i.op == spv::OpDPdy || i.op == spv::OpDPdyFine || i.op == spv::OpDPdyCoarse;
  Values result;
  for (const Value v : Values(value(i.operands[0]))) {
    if (only_x) result.push_back(build_.emit(dx, v));
    else if (only_y) result.push_back(build_.emit(dy, v));
    else result.push_back(build_.fadd(build_.fabs(build_.emit(dx, v)), build_.fabs(build_.emit(dy, v))));
  }
  define(i, std::move(result));
}

}  // namespace quadrille::pipeline
