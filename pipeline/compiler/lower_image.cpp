/// Textures and derivatives: which textures and samplers there are, what is asked of them. [VK1.3 #textures]
///
/// What the ISA has an operation for (a plane, sampled by its level, a bias or the quad) takes that. All else
/// becomes a kTexOp with its words packed three by three.
#include "pipeline/compiler/lowering.h"
#include "pipeline/compiler/spirv_names.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace quadrille::pipeline {
namespace {

using models::LevelFrom;
using models::Op;
using models::TextureAsk;
using models::TextureOperation;
using models::ViewKind;
using Kind = spirv::Type::Kind;

/// What a shader sees of an image of this type, if it can be sampled here.
std::optional<ViewKind> view_kind(const spirv::Type& image) {
  if (image.kind != Kind::kImage || !image.sampled) return std::nullopt;
  if (image.multisampled) {
    if (image.dim != spv::Dim2D) return std::nullopt;
    return image.arrayed ? ViewKind::k2DMultisampledArray : ViewKind::k2DMultisampled;
  }
  switch (image.dim) {
    case spv::Dim1D: return image.arrayed ? ViewKind::k1DArray : ViewKind::k1D;
    case spv::Dim2D: return image.arrayed ? ViewKind::k2DArray : ViewKind::k2D;
    case spv::DimCube: return image.arrayed ? ViewKind::kCubeArray : ViewKind::kCube;
    case spv::Dim3D:
      if (!image.arrayed) return ViewKind::k3D;
      break;
    default: break;
  }
  return std::nullopt;
}

/// Does the instruction divide the coordinates by their last?
bool is_projective(spv::Op op) {
  return op == spv::OpImageSampleProjImplicitLod || op == spv::OpImageSampleProjExplicitLod ||
         op == spv::OpImageSampleProjDrefImplicitLod || op == spv::OpImageSampleProjDrefExplicitLod;
}
bool compares(spv::Op op) {
  return op == spv::OpImageSampleDrefImplicitLod || op == spv::OpImageSampleDrefExplicitLod ||
         op == spv::OpImageSampleProjDrefImplicitLod || op == spv::OpImageSampleProjDrefExplicitLod ||
         op == spv::OpImageDrefGather;
}
bool is_implicit(spv::Op op) {
  return op == spv::OpImageSampleImplicitLod || op == spv::OpImageSampleProjImplicitLod ||
         op == spv::OpImageSampleDrefImplicitLod || op == spv::OpImageSampleProjDrefImplicitLod ||
         op == spv::OpImageQueryLod;
}

/// The first of them; all are in registers side by side.
Values registers(Value first, std::uint32_t count) {
  Values all;
  for (std::uint32_t k = 0; k < count; ++k) all.push_back({Value::Kind::kRegister, 0, first.bits + k});
  return all;
}

void append(Values& words, const Values& more) { words.insert(words.end(), more.begin(), more.end()); }

}  // namespace

models::NumberKind Lowering::number_kind(Id scalar) const {
  const spirv::Type& type = module_.type(scalar);
  if (type.kind != Kind::kInt) return models::NumberKind::kFloat;
  return type.is_signed ? models::NumberKind::kSint : models::NumberKind::kUint;
}

void Lowering::declare_texture(const spirv::Variable& variable) {
  const spirv::Type& type = module_.type(variable.type);
  const spirv::Decorations& d = module_.decorations(variable.id);
  const auto set = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.set)),
             place = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.binding));
  if (type.kind == Kind::kSampler) {
    samplers_[variable.id] = {set, place};
    return;
  }
  const bool combined = type.kind == Kind::kSampledImage;
  const spirv::Type& image = combined ? module_.type(type.element) : type;
  const std::optional<ViewKind> view = view_kind(image);
  if (!view)
    throw user_error(
        "{}", module_.at_use(
                  variable.id,
                  fmt::format("resource {} is not a sampler, a texture or both in one (of floats or "
                              "integers, 1D, 2D, 3D, cube and arrays of them, or 2D of several samples), "
                              "the only kinds supported; declare it as a sampler2D or the like",
                              module_.name(variable.id))));
  models::TextureBinding binding{set, place, number_kind(image.element), *view};
  if (!combined) binding.sampler_binding = models::kNoSampler;
  textures_[variable.id] = texture_index(binding);
}

std::uint16_t Lowering::texture_index(const models::TextureBinding& binding) {
  const auto found = std::find(shader_.textures.begin(), shader_.textures.end(), binding);
  const auto index = static_cast<std::uint16_t>(found - shader_.textures.begin());
  if (found == shader_.textures.end()) shader_.textures.push_back(binding);
  return index;
}

std::uint16_t Lowering::texture_of(Id image, const spirv::Instruction& i) const {
  const auto texture = textures_.find(image);
  if (texture == textures_.end()) throw unsupported(i, "an operation on what is not a texture variable");
  return texture->second;
}

/// The same of a question that has no answer for several samples a texel. The validator refuses all else that
/// such a texture is not fetched or measured by.
std::uint16_t Lowering::texture_of_one_sample(Id image, const spirv::Instruction& i) const {
  const std::uint16_t texture = texture_of(image, i);
  if (models::is_multisampled(shader_.textures[texture].view))
    throw unsupported(i, fmt::format("{} of a texture of several samples", spirv::name_of(i)));
  return texture;
}

/// A texture with a sampler of its own.
void Lowering::combine(const spirv::Instruction& i) {
  const auto sampler = samplers_.find(i.operands[1]);
  if (sampler == samplers_.end()) throw unsupported(i, "a sampler that is not a variable");
  models::TextureBinding binding = shader_.textures[texture_of(i.operands[0], i)];
  binding.sampler_set = sampler->second.first;
  binding.sampler_binding = sampler->second.second;
  textures_[i.result] = texture_index(binding);
}

bool Lowering::image(const spirv::Instruction& i) {
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpImage:
      if (const auto found = textures_.find(i.operands[0]); found != textures_.end())
        textures_[i.result] = std::uint16_t{found->second};
      return true;
    case spv::OpSampledImage: combine(i); return true;
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleExplicitLod:
    case spv::OpImageSampleProjImplicitLod:
    case spv::OpImageSampleProjExplicitLod:
    case spv::OpImageSampleDrefImplicitLod:
    case spv::OpImageSampleDrefExplicitLod:
    case spv::OpImageSampleProjDrefImplicitLod:
    case spv::OpImageSampleProjDrefExplicitLod: sample(i); return true;
    case spv::OpImageFetch: fetch(i); return true;
    case spv::OpImageGather:
    case spv::OpImageDrefGather: gather(i); return true;
    case spv::OpImageQueryLod: query_lod(i); return true;
    case spv::OpImageQuerySize:
    case spv::OpImageQuerySizeLod: image_size(i); return true;
    case spv::OpImageQuerySamples: levels_or_samples(i, texture_of(i.operands[0], i)); return true;
    case spv::OpImageQueryLevels: levels_or_samples(i, texture_of_one_sample(i.operands[0], i)); return true;
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

std::array<std::int8_t, 3> Lowering::constant_offset(Id id, const spirv::Instruction& i) const {
  const std::vector<std::uint32_t>* words = module_.constant(id);
  if (words == nullptr || words->size() > 3) throw unsupported(i, "a constant offset that is not known");
  std::array<std::int8_t, 3> offset{};
  for (std::size_t k = 0; k < words->size(); ++k) {
    const auto value = static_cast<std::int32_t>((*words)[k]);
    if (value < std::numeric_limits<std::int8_t>::min() || value > std::numeric_limits<std::int8_t>::max())
      throw unsupported(i, "an offset of more than 127 texels");
    offset.at(k) = static_cast<std::int8_t>(value);
  }
  return offset;
}

/// `mask_at`: place of the mask that says which there are; they follow in the order of its bits.
Lowering::ImageOperands Lowering::image_operands(const spirv::Instruction& i, std::size_t mask_at) {
  ImageOperands operands;
  if (i.operands.size() <= mask_at) return operands;
  const std::uint32_t mask = i.operands[mask_at];
  std::size_t next = mask_at + 1;
  const auto has = [mask](std::uint32_t bit) { return (mask & bit) != 0; };
  if (has(spv::ImageOperandsBiasMask)) operands.bias = value(i.operands[next++]);
  if (has(spv::ImageOperandsLodMask)) operands.lod = value(i.operands[next++]);
  if (has(spv::ImageOperandsGradMask)) {
    operands.gradients = value(i.operands[next++]);
    append(operands.gradients, Values(value(i.operands[next++])));
  }
  if (has(spv::ImageOperandsConstOffsetMask)) operands.offset = constant_offset(i.operands[next++], i);
  if (has(spv::ImageOperandsOffsetMask)) operands.offsets = value(i.operands[next++]);
  if (has(spv::ImageOperandsConstOffsetsMask)) {
    const std::vector<std::uint32_t>* words = module_.constant(i.operands[next++]);
    if (words == nullptr || words->size() != 8) throw unsupported(i, "four offsets that are not known");
    operands.four_offsets = *words;
  }
  if (has(spv::ImageOperandsSampleMask)) operands.sample = value(i.operands[next++]);
  // Bias, level, gradients, offsets of three kinds, and a sample's number.
  constexpr std::uint32_t kKnown = (std::uint32_t{spv::ImageOperandsSampleMask} << 1) - 1;
  if ((mask & ~kKnown) != 0) throw unsupported(i, "a least level (textureClamp)");
  return operands;
}

Values Lowering::ask(const spirv::Instruction& i, const TextureOperation& operation, const Values& words) {
  const ViewKind view = shader_.textures[operation.texture].view;
  if (words.size() > models::kMaxTextureWords)
    throw unsupported(i, fmt::format("a texture operation of {} words (at most {})", words.size(),
                                     models::kMaxTextureWords));
  if (words.size() != static_cast<std::size_t>(models::word_count(operation, view)))
    throw unsupported(i, "coordinates of another size than the texture's");
  auto& operations = shader_.texture_operations;
  const auto found = std::find(operations.begin(), operations.end(), operation);
  const auto index = static_cast<std::uint16_t>(found - operations.begin());
  if (found == operations.end()) operations.push_back(operation);
  Value packed[3] = {literal(0u), literal(0u), literal(0u)};
  for (std::size_t k = 0; 3 * k < words.size(); ++k) {
    const auto word = [&](std::size_t w) { return w < words.size() ? words[w] : literal(0u); };
    const Value a = word(3 * k), b = word(3 * k + 1), c = word(3 * k + 2);
    packed[k] = a.is_literal() && a == b && b == c ? a : build_.emit_wide(Op::kPack, a, b, c, 0);
  }
  const bool quad = operation.level == LevelFrom::kQuad || operation.level == LevelFrom::kBias;
  return registers(
      build_.emit_wide(quad ? Op::kTexOpQuad : Op::kTexOp, packed[0], packed[1], packed[2], index), 4);
}

void Lowering::sample(const spirv::Instruction& i) {
  TextureOperation operation;
  operation.texture = texture_of(i.operands[0], i);
  operation.compare = compares(i.op);
  if (is_implicit(i.op) && shader_.stage == models::ShaderStage::kVertex)
    throw unsupported(i, "implicit level of detail in a vertex shader (use textureLod)");
  const ViewKind view = shader_.textures[operation.texture].view;
  Values words = value(i.operands[1]);
  Values reference;
  if (operation.compare) reference.push_back(scalar(i.operands[2]));
  if (is_projective(i.op)) {
    const Value last = words.back();
    for (Values* const numbers : {&words, &reference})
      for (Value& number : *numbers) number = build_.fdiv(number, last);
  }
  words.resize(static_cast<std::size_t>(models::coordinate_count(view)), literal(0u));
  const ImageOperands operands = image_operands(i, operation.compare ? 3 : 2);
  if (!operands.four_offsets.empty()) throw unsupported(i, "four offsets of one sample");
  operation.level = !operands.lod.empty()         ? LevelFrom::kLevel
                    : !operands.gradients.empty() ? LevelFrom::kGradients
                    : !operands.bias.empty()      ? LevelFrom::kBias
                                                  : LevelFrom::kQuad;
  operation.offset = operands.offset;
  operation.offsets = !operands.offsets.empty();
  const bool plain = view == ViewKind::k2D && !operation.compare && !operation.offsets &&
                     operation.offset == TextureOperation{}.offset &&
                     operation.level != LevelFrom::kGradients;
  if (plain) {
    const Op op = operation.level == LevelFrom::kLevel  ? Op::kTexLod
                  : operation.level == LevelFrom::kBias ? Op::kTexBias
                                                        : Op::kTexImplicit;
    const Values& level = operation.level == LevelFrom::kLevel ? operands.lod : operands.bias;
    const Value first =
        build_.emit_wide(op, words[0], words[1], level.empty() ? Value{} : level[0], operation.texture);
    return define(i, registers(first, 4));
  }
  append(words, reference);
  for (const Values* const more : {&operands.lod, &operands.gradients, &operands.bias, &operands.offsets})
    append(words, *more);
  const Values result = ask(i, operation, words);
  define(i, operation.compare ? Values{result[0]} : result);
}

void Lowering::fetch(const spirv::Instruction& i) {
  TextureOperation operation;
  operation.texture = texture_of(i.operands[0], i);
  operation.ask = TextureAsk::kFetch;
  const ImageOperands operands = image_operands(i, 2);
  Values words = value(i.operands[1]);
  append(words, !operands.sample.empty() ? operands.sample
                : operands.lod.empty()   ? Values{literal(0u)}
                                         : operands.lod);
  append(words, operands.offsets);
  operation.offset = operands.offset;
  operation.offsets = !operands.offsets.empty();
  define(i, ask(i, operation, words));
}

/// With four offsets each component is the upper left texel of a gather of its own.
void Lowering::gather(const spirv::Instruction& i) {
  TextureOperation operation;
  operation.texture = texture_of(i.operands[0], i);
  operation.ask = TextureAsk::kGather;
  operation.compare = compares(i.op);
  const ImageOperands operands = image_operands(i, 3);
  Values words = value(i.operands[1]);
  if (operation.compare) {
    words.push_back(scalar(i.operands[2]));
  } else {
    const Value component = scalar(i.operands[2]);
    if (!component.is_literal() || component.bits > 3)
      throw unsupported(i, "a component to gather that is not known");
    operation.component = static_cast<std::uint8_t>(component.bits);
  }
  words.push_back(literal(0u));  // of the finest level
  operation.offset = operands.offset;
  if (operands.four_offsets.empty()) {
    append(words, operands.offsets);
    operation.offsets = !operands.offsets.empty();
    return define(i, ask(i, operation, words));
  }
  Values result;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      operation.offset.at(axis) = static_cast<std::int8_t>(operands.four_offsets[2 * k + axis]);
    result.push_back(ask(i, operation, words)[3]);
  }
  define(i, std::move(result));
}

/// The layer has no say in it.
void Lowering::query_lod(const spirv::Instruction& i) {
  TextureOperation operation;
  operation.texture = texture_of_one_sample(i.operands[0], i);
  operation.ask = TextureAsk::kQueryLod;
  operation.level = LevelFrom::kQuad;
  if (shader_.stage == models::ShaderStage::kVertex)
    throw unsupported(i, "implicit level of detail in a vertex shader (use textureLod)");
  Values words = value(i.operands[1]);
  words.resize(static_cast<std::size_t>(models::coordinate_count(shader_.textures[operation.texture].view)),
               literal(0u));
  Values result = ask(i, operation, words);
  result.resize(2);
  define(i, std::move(result));
}

/// Of several samples there is one level, which is not named.
void Lowering::image_size(const spirv::Instruction& i) {
  const std::uint16_t texture = texture_of(i.operands[0], i);
  const ViewKind view = shader_.textures[texture].view;
  const Value level = models::is_multisampled(view) ? literal(0u) : scalar(i.operands[1]);
  if (view == ViewKind::k2D || view == ViewKind::k2DMultisampled)
    return define(i, registers(build_.emit_wide(Op::kTexSize, level, {}, {}, texture), 2));
  const Values all = registers(build_.emit_wide(Op::kTexDims, level, {}, {}, texture), 4);
  const int sides = models::is_cube(view) ? 2 : models::place_dimensions(view);
  Values result(all.begin(), all.begin() + sides);
  if (models::is_array(view)) result.push_back(all[2]);
  define(i, std::move(result));
}

void Lowering::levels_or_samples(const spirv::Instruction& i, std::uint16_t texture) {
  define(i, {registers(build_.emit_wide(Op::kTexDims, literal(0u), {}, {}, texture), 4)[3]});
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
