/// Inputs and outputs: which slot each scalar of an interface variable is. [VK1.3 #interfaces-iointerfaces,
/// #interfaces-builtin-variables]
#include "pipeline/compiler/lowering.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

using models::Op;
using models::ShaderStage;
using models::SystemValue;
using Kind = spirv::Type::Kind;

constexpr std::uint32_t kMaxInterfaceScalars = 1024;

models::Interpolation interpolation_of(const spirv::Decorations& d) {
  using enum models::Interpolation;
  if (d.flat) return kFlat;
  if (d.no_perspective) return d.centroid ? kLinearCentroid : kLinear;
  return d.centroid ? kPerspectiveCentroid : kPerspective;
}

}  // namespace

void Lowering::declare_interface(const spirv::Variable& variable) {
  const bool output = variable.storage == spv::StorageClassOutput;
  const spirv::Decorations& d = module_.decorations(variable.id);
  if (module_.type(variable.type).scalars > kMaxInterfaceScalars)
    throw user_error("{}: interface variable {} has more than {} scalars", module_.shader,
                     module_.name(variable.id), kMaxInterfaceScalars);
  const bool of_fragment = !output && shader_.stage == ShaderStage::kFragment;
  shader_.by_sample |= of_fragment && follows_sample(variable, d);
  auto location = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.location));
  add_slots(slots_[variable.id], variable.type, d, location, output);
  if (!output || (!read_outputs_.contains(variable.id) && variable.initializer == 0 &&
                  module_.type(variable.type).kind != Kind::kArray))
    return;
  Values& shadow = memory_[variable.id];
  for (std::uint32_t k = 0; k < module_.type(variable.type).scalars; ++k)
    shadow.push_back(build_.new_variable());
  if (variable.initializer == 0) return;
  const Values initial = value(variable.initializer);
  for (std::uint32_t k = 0; k < initial.size(); ++k) {
    build_.assign(shadow[k], initial[k]);
    if (slots_[variable.id][k].kind == Slot::Kind::kUsed)
      build_.effect(Op::kOutput, initial[k], slots_[variable.id][k].imm);
  }
}

/// Does an input of a fragment shader make it run by sample? [VK1.3 #primsrast-sampleshading]
bool Lowering::follows_sample(const spirv::Variable& variable, const spirv::Decorations& d) const {
  if (d.sample || d.built_in == spv::BuiltInSampleId || d.built_in == spv::BuiltInSamplePosition) return true;
  const spirv::Type& type = module_.type(variable.type);
  if (type.kind != Kind::kStruct) return false;
  for (std::uint32_t k = 0; k < type.members.size(); ++k)
    if (module_.member_decorations(variable.type, k).sample) return true;
  return false;
}

void Lowering::add_slots(std::vector<Slot>& slots, Id type_id, const spirv::Decorations& inherited,
                         std::uint32_t& location, bool output) {
  const spirv::Type& type = module_.type(type_id);
  if (type.kind == Kind::kStruct) {
    for (std::uint32_t k = 0; k < type.members.size(); ++k) {
      spirv::Decorations d = module_.member_decorations(type_id, k);
      d.flat = d.flat || inherited.flat;
      d.no_perspective = d.no_perspective || inherited.no_perspective;
      d.centroid = d.centroid || inherited.centroid;
      if (d.location >= 0) location = static_cast<std::uint32_t>(d.location);
      add_slots(slots, type.members[k], d, location, output);
    }
    return;
  }
  if (inherited.built_in < 0 && (type.kind == Kind::kArray || type.kind == Kind::kMatrix)) {
    for (std::uint32_t k = 0; k < type.count; ++k)
      add_slots(slots, type.element, inherited, location, output);
    return;
  }
  const auto first = static_cast<std::uint32_t>(std::max<std::int64_t>(0, inherited.component));
  for (std::uint32_t k = 0; k < type.scalars; ++k)
    slots.push_back(inherited.built_in >= 0 ? built_in_slot(inherited.built_in, k, output)
                                            : location_slot(location, first + k, inherited, output));
  const Id scalar_type = type.kind == Kind::kVector ? type.element : type_id;
  const bool integers = shader_.stage == ShaderStage::kVertex && !output && inherited.built_in < 0 &&
                        module_.type(scalar_type).kind != Kind::kFloat;
  if (integers && location < kMaxAttributeLocations) shader_.integer_inputs |= 1u << location;
  const bool color = shader_.stage == ShaderStage::kFragment && output && inherited.built_in < 0;
  if (color && location < models::kMaxColorAttachments)
    shader_.color_kinds[location] = number_kind(scalar_type);
  ++location;
}

Lowering::Slot Lowering::built_in_slot(std::int64_t built_in, std::uint32_t component, bool output) const {
  Slot slot;
  const auto use = [&](std::uint32_t imm) {
    slot.kind = Slot::Kind::kUsed;
    slot.imm = static_cast<std::uint16_t>(imm);
    return slot;
  };
  const auto system = [&](SystemValue v) {
    slot.system = true;
    return use(static_cast<std::uint32_t>(v) + component);
  };
  const auto distance = [&](std::uint32_t first) {
    return component < models::kMaxUserDistances ? use(first + component) : slot;
  };
  const bool vertex = shader_.stage == ShaderStage::kVertex;
  switch (built_in) {
    case spv::BuiltInPosition: return vertex && output ? use(component) : slot;
    case spv::BuiltInPointSize: return vertex && output ? use(kRawPointSize) : slot;
    case spv::BuiltInClipDistance: return vertex && output ? distance(kRawClipDistance) : slot;
    case spv::BuiltInCullDistance: return vertex && output ? distance(kRawCullDistance) : slot;
    case spv::BuiltInViewportIndex: return vertex && output ? use(kRawViewportIndex) : slot;
    case spv::BuiltInVertexIndex: return vertex ? system(SystemValue::kVertexIndex) : slot;
    case spv::BuiltInInstanceIndex: return vertex ? system(SystemValue::kInstanceIndex) : slot;
    case spv::BuiltInFragCoord: return vertex ? slot : system(SystemValue::kFragCoordX);
    case spv::BuiltInFrontFacing: return vertex ? slot : system(SystemValue::kFrontFacing);
    case spv::BuiltInPrimitiveId: return vertex ? slot : system(SystemValue::kPrimitiveId);
    case spv::BuiltInPointCoord: return vertex ? slot : system(SystemValue::kPointCoordX);
    case spv::BuiltInSampleId: return vertex ? slot : system(SystemValue::kSampleId);
    case spv::BuiltInSamplePosition: return vertex ? slot : system(SystemValue::kSamplePositionX);
    case spv::BuiltInSampleMask:
      if (vertex || component > 0) return slot;  // a pixel has no more samples than bits of one word
      return output ? use(models::kSampleMaskOutput) : system(SystemValue::kSampleMask);
    case spv::BuiltInFragDepth: return !vertex && output ? use(models::kDepthOutput) : slot;
    default: return slot;
  }
}

Lowering::Slot Lowering::location_slot(std::uint32_t location, std::uint32_t component,
                                       const spirv::Decorations& d, bool output) {
  Slot slot;
  if (component > 3) return slot;
  const bool vertex = shader_.stage == ShaderStage::kVertex;
  const bool color = !vertex && output;
  const std::uint32_t limit = color               ? models::kMaxColorAttachments
                              : vertex && !output ? kMaxAttributeLocations
                                                  : kMaxLocations;
  if (location >= limit) return slot;
  if (color && d.index > 0) {
    if (location != 0 || d.index != 1) return slot;
    shader_.second_source = true;
    location = 1;
  }
  slot.kind = Slot::Kind::kUsed;
  slot.imm = static_cast<std::uint16_t>(4 * location + component +
                                        (vertex && output ? models::kFirstVaryingOutput : 0u));
  slot.interpolation = interpolation_of(d);
  return slot;
}

Value Lowering::load_input(Id variable, std::uint32_t place, const spirv::Instruction& i) {
  const Slot& slot = slots_[variable].at(place);
  if (slot.kind != Slot::Kind::kUsed)
    throw unsupported(
        i, fmt::format("input {} (a built-in, or a location beyond the limit)", module_.name(variable)));
  if (shader_.stage == ShaderStage::kVertex || slot.system)
    return build_.emit(Op::kInput, {}, {}, {}, slot.imm);
  shader_.varyings[slot.imm] = slot.interpolation;
  return build_.emit(Op::kInterp, {}, {}, {}, slot.imm);
}

void Lowering::store_output(const Pointer& p, std::uint32_t place, Value v, const spirv::Instruction& i) {
  const Slot& slot = slots_[p.variable].at(place);
  if (slot.kind == Slot::Kind::kRefused)
    throw unsupported(i, fmt::format("output {} (only colour locations 0 to 7, gl_FragDepth, gl_SampleMask, "
                                     "gl_Position, gl_PointSize, gl_ViewportIndex, clip and cull "
                                     "distances and varyings are written)",
                                     module_.name(p.variable)));
  build_.effect(Op::kOutput, v, slot.imm);
}

}  // namespace quadrille::pipeline
