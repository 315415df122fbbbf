/// Decoding instructions on textures.
#include <spirv/unified1/spirv.hpp>

#include "models/base/descriptor_binding.h"
#include "models/reference/decode.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

bool is_projective(std::uint32_t op) {
  return op == spv::OpImageSampleProjImplicitLod || op == spv::OpImageSampleProjExplicitLod ||
         op == spv::OpImageSampleProjDrefImplicitLod || op == spv::OpImageSampleProjDrefExplicitLod;
}

bool is_implicit(std::uint32_t op) {
  return op == spv::OpImageSampleImplicitLod || op == spv::OpImageSampleProjImplicitLod ||
         op == spv::OpImageSampleDrefImplicitLod || op == spv::OpImageSampleProjDrefImplicitLod ||
         op == spv::OpImageQueryLod;
}

bool compares(std::uint32_t op) {
  return op == spv::OpImageSampleDrefImplicitLod || op == spv::OpImageSampleDrefExplicitLod ||
         op == spv::OpImageSampleProjDrefImplicitLod || op == spv::OpImageSampleProjDrefExplicitLod ||
         op == spv::OpImageDrefGather;
}

}  // namespace

bool Decoder::texture_instruction(Frame& frame, const SpirvInstruction& in) {
  using Kind = TextureInstruction::Kind;
  switch (in.op) {
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleExplicitLod:
    case spv::OpImageSampleProjImplicitLod:
    case spv::OpImageSampleProjExplicitLod: ask_texture(frame, in, Kind::kSample, 2); return true;
    case spv::OpImageSampleDrefImplicitLod:
    case spv::OpImageSampleDrefExplicitLod:
    case spv::OpImageSampleProjDrefImplicitLod:
    case spv::OpImageSampleProjDrefExplicitLod: ask_texture(frame, in, Kind::kSample, 3); return true;
    case spv::OpImageFetch: ask_texture(frame, in, Kind::kFetch, 2); return true;
    case spv::OpImageGather:
    case spv::OpImageDrefGather: ask_texture(frame, in, Kind::kGather, 3); return true;
    case spv::OpImageQueryLod: ask_texture(frame, in, Kind::kQueryLod, 2); return true;
    case spv::OpImage: frame.values[in.result] = value(frame, in.words[0]); return true;
    case spv::OpSampledImage: combine(frame, in); return true;
    case spv::OpImageQuerySize:
    case spv::OpImageQuerySizeLod:
    case spv::OpImageQuerySamples:
    case spv::OpImageQueryLevels: query(frame, in); return true;
    default: return false;
  }
}

/// A texture with a sampler of its own is one more texture; of arrays, each pair is.
void Decoder::combine(Frame& frame, const SpirvInstruction& in) {
  Value texture = value(frame, in.words[0]);
  const Value sampler = value(frame, in.words[1]);
  if (texture.kind != Value::Kind::kTexture || sampler.kind != Value::Kind::kSampler)
    unsupported("a texture or sampler that is not a variable");
  const auto first = static_cast<Slot>(program_.textures.size());
  for (std::uint32_t t = 0; t < texture.count; ++t) {
    TextureUse use = program_.textures[texture.slot + t];
    use.sampler_set = sampler.slot;
    for (std::uint32_t s = 0; s < sampler.count; ++s) {
      use.sampler_binding = element_binding(sampler.offset, s);
      program_.textures.push_back(use);
    }
  }
  texture.slot = first;
  if (texture.index == kNoSlot) {
    texture.index = sampler.index;
  } else {
    const Slot pair = allocate(1);
    emit(scale_index, 1, pair, {texture.index, sampler.index}).imm = {texture.count, sampler.count};
    texture.index = pair;
  }
  texture.count *= sampler.count;
  frame.values[in.result] = texture;
}

void Decoder::query(Frame& frame, const SpirvInstruction& in) {
  const Value texture = value(frame, in.words[0]);
  const Slot level = in.op == spv::OpImageQuerySizeLod ? value(frame, in.words[1]).slot : kNoSlot;
  const Handler handler = in.op == spv::OpImageQueryLevels    ? query_levels
                          : in.op == spv::OpImageQuerySamples ? query_samples
                                                              : query_size;
  emit(handler, cells(in.type), define(frame, in).slot, {texture.index, level}).imm[0] = texture.slot;
}

void Decoder::ask_texture(Frame& frame, const SpirvInstruction& in, TextureInstruction::Kind kind,
                          std::size_t mask_at) {
  if (is_implicit(in.op) && stage_ != traces::ShaderStage::kFragment)
    unsupported("sampling with an implicit level of detail outside a fragment shader");
  TextureInstruction ask;
  ask.kind = kind;
  ask.texture = value(frame, in.words[0]).slot;
  ask.index = value(frame, in.words[0]).index;
  const Value& coordinates = value(frame, in.words[1]);
  ask.coordinates = coordinates.slot;
  ask.coordinate_cells = cells(coordinates.type);
  ask.projective = is_projective(in.op);
  if (compares(in.op)) ask.reference = value(frame, in.words[2]).slot;
  else if (kind == TextureInstruction::Kind::kGather)
    ask.component = constant_word(in.words[2], "the component of a gather");
  image_operands(frame, in, mask_at, ask);
  const Slot dst = define(frame, in).slot;
  emit(ask_texture_lanes, cells(in.type), dst, {}).imm[0] =
      static_cast<std::uint32_t>(program_.texture_instructions.size());
  program_.texture_instructions.push_back(std::move(ask));
}

void Decoder::image_operands(Frame& frame, const SpirvInstruction& in, std::size_t mask_at,
                             TextureInstruction& ask) {
  if (in.words.size() <= mask_at) return;
  const std::uint32_t mask = in.words[mask_at];
  std::size_t next = mask_at + 1;
  const auto has = [mask](std::uint32_t bit) { return (mask & bit) != 0; };
  const auto slot = [&] { return value(frame, in.words.at(next++)).slot; };
  const auto numbers = [&](std::vector<std::int32_t>& list) {
    const Value& constant = value(frame, in.words.at(next++));
    for (std::uint32_t k = 0; k < cells(constant.type); ++k)
      list.push_back(static_cast<std::int32_t>(program_.initial[constant.slot + k].u(0)));
  };
  if (has(spv::ImageOperandsBiasMask)) ask.bias = slot();
  if (has(spv::ImageOperandsLodMask)) ask.level = slot();
  if (has(spv::ImageOperandsGradMask)) {
    ask.gradient_x = slot();
    ask.gradient_y = slot();
  }
  if (has(spv::ImageOperandsConstOffsetMask)) {
    std::vector<std::int32_t> offset;
    numbers(offset);
    for (std::size_t k = 0; k < offset.size(); ++k) ask.offset.at(k) = offset[k];
  }
  if (has(spv::ImageOperandsOffsetMask)) ask.offsets = slot();
  if (has(spv::ImageOperandsConstOffsetsMask)) numbers(ask.four_offsets);
  if (has(spv::ImageOperandsSampleMask)) ask.sample = slot();
  constexpr std::uint32_t kKnown = 0x7f;
  if ((mask & ~kKnown) != 0) unsupported("image operands of a least level");
}

}  // namespace quadrille::models::reference
