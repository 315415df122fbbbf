/// Decoding the module's variables: inputs, outputs, built-ins, uniform blocks, push constants, textures.
#include <spirv/unified1/spirv.hpp>

#include "models/base/descriptor_binding.h"
#include "models/reference/decode.h"

namespace quadrille::models::reference {
namespace {

ScalarKind scalar_kind(TypeKind kind) {
  return kind == TypeKind::kFloat ? ScalarKind::kFloat
         : kind == TypeKind::kInt ? ScalarKind::kInt
                                  : ScalarKind::kBool;
}

/// A member's location, component and interpolation, where the variable as a whole does not say.
Decorations inherit(Decorations member, const Decorations& whole) {
  if (member.component == kNoNumber) member.component = whole.component;
  member.flat = member.flat || whole.flat;
  member.no_perspective = member.no_perspective || whole.no_perspective;
  member.index = std::max(member.index, whole.index);
  member.centroid = member.centroid || whole.centroid;
  member.sample = member.sample || whole.sample;
  return member;
}

}  // namespace

void Decoder::variable(const SpirvInstruction& in) {
  check_type(in.type);
  const SpirvType& pointer = module_.type(in.type);
  const Decorations& decorations = module_.decorations[in.result];
  Value v = {Value::Kind::kPointer, pointer.element, kNoSlot, kNoSlot, false};
  switch (pointer.storage) {
    case spv::StorageClassInput:
    case spv::StorageClassOutput: {
      const bool input = pointer.storage == spv::StorageClassInput;
      v.slot = allocate(cells(pointer.element));
      v.read_only = input;
      interface_scalars(input ? program_.inputs : program_.outputs, decorations, pointer.element, v.slot,
                        decorations.location, input);
      if (!input) initialised_.push_back(in);
      break;
    }
    case spv::StorageClassPrivate:
      v.slot = allocate(cells(pointer.element));
      initialised_.push_back(in);
      break;
    case spv::StorageClassUniform:
    case spv::StorageClassPushConstant: uniform_variable(in, v); break;
    case spv::StorageClassUniformConstant: texture_variable(in, v); break;
    default:
      unsupported(
          "a variable that is not an input, output, private, uniform block, push constant or combined image "
          "sampler");
  }
  globals_[in.result] = v;
}

/// A block, or an array of blocks, each with a binding of its own.
void Decoder::uniform_variable(const SpirvInstruction& in, Value& v) {
  const Decorations& decorations = module_.decorations[in.result];
  const SpirvType& type = module_.type(v.type);
  const bool array = type.kind == TypeKind::kArray;
  v.slot = allocate(cells(v.type));
  v.read_only = true;
  UniformScalar place;
  place.push = module_.type(in.type).storage == spv::StorageClassPushConstant;
  place.set = decorations.set, place.slot = v.slot;
  const Id block = array ? type.element : v.type;
  for (std::uint32_t i = 0; i < (array ? type.count : 1); ++i) {
    place.binding = element_binding(decorations.binding, i);
    block_scalars(place, block, decorations);
    place.slot += cells(block);
  }
}

void Decoder::texture_variable(const SpirvInstruction& in, Value& v) {
  const SpirvType& type = module_.type(v.type);
  if (type.kind == TypeKind::kArray) v.count = type.count;
  const TypeKind kind = type.kind == TypeKind::kArray ? module_.type(type.element).kind : type.kind;
  const Decorations& place = module_.decorations[in.result];
  if (kind == TypeKind::kSampler) {
    v.kind = Value::Kind::kSampler;
    v.slot = place.set;
    v.offset = place.binding;
    return;
  }
  if (kind != TypeKind::kSampledImage && kind != TypeKind::kImage)
    unsupported("a descriptor that is not an image, a sampler, both in one, or a uniform block");
  v.kind = Value::Kind::kTexture;
  v.slot = static_cast<Slot>(program_.textures.size());
  for (std::uint32_t i = 0; i < v.count; ++i)
    program_.textures.push_back({place.set, element_binding(place.binding, i), kind == TypeKind::kImage});
}

/// Lists the scalars of an input or output. Each scalar or vector (so each column, array element and member)
/// takes a location of its own. [VK1.3 #interfaces-iointerfaces-locations]
void Decoder::interface_scalars(std::vector<Port>& ports, const Decorations& decorations, Id type, Slot slot,
                                std::uint32_t location, bool input) {
  const SpirvType& t = module_.type(type);
  if (decorations.builtin != kNoNumber) return builtin(decorations.builtin, slot, t.cells, input);
  if (t.cells == 0) return;
  if (t.kind == TypeKind::kStruct) {
    for (std::uint32_t i = 0; i < t.members.size(); ++i) {
      const Decorations member = inherit(module_.member(type, i), decorations);
      if (member.location != kNoNumber) location = member.location;
      const std::size_t before = ports.size();
      interface_scalars(ports, member, t.members[i], slot, location, input);
      slot += cells(t.members[i]);
      if (ports.size() != before) location = ports.back().location + 1;
    }
  } else if (t.kind == TypeKind::kArray || t.kind == TypeKind::kMatrix) {
    const std::uint32_t each = cells(t.element);
    for (std::uint32_t i = 0; i < t.count; ++i) {
      const std::size_t before = ports.size();
      interface_scalars(ports, decorations, t.element, slot + i * each, location, input);
      if (ports.size() != before) location = ports.back().location + 1;
    }
  } else {
    program_.by_sample |= input && decorations.sample;
    const ScalarKind kind = scalar_kind(module_.scalar_of(type).kind);
    const auto interpolation = decorations.flat             ? Interpolation::kFlat
                               : decorations.no_perspective ? Interpolation::kLinear
                                                            : Interpolation::kPerspective;
    const std::uint32_t component = decorations.component == kNoNumber ? 0 : decorations.component;
    for (std::uint32_t i = 0; i < t.cells; ++i)
      ports.push_back(
          {location, component + i, slot + i, kind, interpolation, decorations.index, decorations.centroid});
  }
}

void Decoder::builtin(std::uint32_t which, Slot slot, std::uint32_t cells, bool input) {
  BuiltinSlots& b = program_.builtins;
  switch (which) {
    case spv::BuiltInPosition: b.position = slot; return;
    case spv::BuiltInVertexIndex: b.vertex_index = slot; return;
    case spv::BuiltInInstanceIndex: b.instance_index = slot; return;
    case spv::BuiltInFragCoord: b.frag_coord = slot; return;
    case spv::BuiltInFrontFacing: b.front_facing = slot; return;
    case spv::BuiltInPrimitiveId: b.primitive_id = slot; return;
    case spv::BuiltInFragDepth: b.frag_depth = slot; return;
    case spv::BuiltInPointSize: b.point_size = slot; return;
    case spv::BuiltInPointCoord: b.point_coord = slot; return;
    case spv::BuiltInSampleId: b.sample_id = slot, program_.by_sample = true; return;
    case spv::BuiltInSamplePosition: b.sample_position = slot, program_.by_sample = true; return;
    case spv::BuiltInSampleMask: (input ? b.sample_mask_in : b.sample_mask) = slot; return;
    case spv::BuiltInClipDistance: b.clip_distance = slot, b.clip_distances = cells; return;
    case spv::BuiltInViewportIndex:
      if (input) unsupported("gl_ViewportIndex in a fragment shader");
      b.viewport_index = slot;
      return;
    case spv::BuiltInCullDistance: b.cull_distance = slot, b.cull_distances = cells; return;
    default:
      unsupported(
          "a built-in other than Position, PointSize, ViewportIndex, ClipDistance, CullDistance, "
          "VertexIndex, "
          "InstanceIndex, "
          "FragCoord, FrontFacing, PrimitiveId, PointCoord, SampleId, SamplePosition, SampleMask and "
          "FragDepth");
  }
}

/// Lists the scalars of a block by its layout decorations. `layout` are those of the variable or member that
/// has this type. [VK1.3 #interfaces-resources-layout]
void Decoder::block_scalars(UniformScalar place, Id type, const Decorations& layout) {
  const SpirvType& t = module_.type(type);
  if (t.cells == 0) return;
  const std::uint32_t base = place.byte_offset;
  if (t.kind == TypeKind::kStruct) {
    for (std::uint32_t i = 0; i < t.members.size(); ++i) {
      const Decorations member = module_.member(type, i);
      place.byte_offset = base + member.offset;
      block_scalars(place, t.members[i], member);
      place.slot += cells(t.members[i]);
    }
  } else if (t.kind == TypeKind::kArray) {
    for (std::uint32_t i = 0; i < t.count; ++i) {
      place.byte_offset = base + i * module_.decorations[type].array_stride;
      block_scalars(place, t.element, layout);
      place.slot += cells(t.element);
    }
  } else {
    const std::uint32_t rows = t.kind == TypeKind::kMatrix ? cells(t.element) : t.cells;
    place.kind = scalar_kind(module_.scalar_of(type).kind);
    for (std::uint32_t i = 0; i < t.cells; ++i) {
      const std::uint32_t column = i / rows, row = i % rows;
      const std::uint32_t stride = t.kind == TypeKind::kMatrix ? layout.matrix_stride : 0;
      place.byte_offset = base + (layout.row_major ? row * stride + column * 4 : column * stride + row * 4);
      program_.uniforms.push_back(place);
      ++place.slot;
    }
  }
}

}  // namespace quadrille::models::reference
