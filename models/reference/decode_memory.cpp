/// Decoding pointers, loads and stores, and the taking apart and putting together of composites. Most of it
/// costs nothing at run time: an element of a value or variable is just another slot.
#include <algorithm>
#include <spirv/unified1/spirv.hpp>

#include "models/base/descriptor_binding.h"
#include "models/reference/decode.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {

bool Decoder::memory_instruction(Frame& frame, const SpirvInstruction& in) {
  switch (in.op) {
    case spv::OpVariable: local_variable(frame, in); return true;
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain: access_chain(frame, in); return true;
    case spv::OpLoad: frame.values[in.result] = load(value(frame, in.words[0])); return true;
    case spv::OpStore: store(value(frame, in.words[0]), value(frame, in.words[1])); return true;
    case spv::OpCopyMemory: store(value(frame, in.words[0]), load(value(frame, in.words[1]))); return true;
    default: return false;
  }
}

void Decoder::local_variable(Frame& frame, const SpirvInstruction& in) {
  check_type(in.type);
  const Id type = module_.type(in.type).element;
  const Slot slot = allocate(cells(type));
  if (in.words.size() > 1) {
    copy(slot, value(frame, in.words[1]).slot, cells(type));
  } else {
    zero(slot, cells(type));  // undefined by the rules; zero makes every run alike
  }
  frame.values[in.result] = {Value::Kind::kPointer, type, slot, kNoSlot, false};
}

void Decoder::access_chain(Frame& frame, const SpirvInstruction& in) {
  Value pointer = value(frame, in.words[0]);
  if (pointer.kind == Value::Kind::kTexture || pointer.kind == Value::Kind::kSampler) {
    if (in.words.size() != 2) unsupported("an array of arrays of descriptors");
    choose_descriptor(frame, pointer, in.words[1]);
    frame.values[in.result] = pointer;
    return;
  }
  if (pointer.kind != Value::Kind::kPointer) unsupported("an access chain into this kind of value");
  for (std::size_t i = 1; i < in.words.size(); ++i) step_into(frame, pointer, in.words[i]);
  frame.values[in.result] = pointer;
}

/// One of an array of textures or samplers. An index beyond its end counts as the last.
void Decoder::choose_descriptor(Frame& frame, Value& descriptors, Id index) {
  const SpirvType& t = module_.type(descriptors.type);
  if (t.kind != TypeKind::kArray) unsupported("an access chain into a descriptor");
  descriptors.type = t.element;
  if (!is_constant(index)) {
    descriptors.index = allocate(1);
    emit(scale_index, 1, descriptors.index, {value(frame, index).slot, kNoSlot}).imm = {t.count, 1};
    return;
  }
  const std::uint32_t chosen = std::min(constant_words_.at(index), t.count - 1);
  if (descriptors.kind == Value::Kind::kTexture) descriptors.slot += chosen;
  else descriptors.offset = element_binding(descriptors.offset, chosen);
  descriptors.count = 1;
}

void Decoder::step_into(Frame& frame, Value& pointer, Id index) {
  const SpirvType& t = module_.type(pointer.type);
  if (t.kind == TypeKind::kStruct) {
    const std::uint32_t member = constant_word(index, "a struct member index that is not a constant");
    for (std::uint32_t i = 0; i < member; ++i) pointer.slot += cells(t.members[i]);
    pointer.type = t.members[member];
    return;
  }
  const std::uint32_t stride = cells(t.element);
  if (is_constant(index)) {
    pointer.slot += std::min(constant_words_.at(index), t.count - 1) * stride;
  } else {
    dynamic_step(pointer, value(frame, index).slot, t.count, stride);
  }
  pointer.type = t.element;
}

void Decoder::dynamic_step(Value& pointer, Slot index, std::uint32_t count, std::uint32_t stride) {
  const Slot offset = allocate(1);
  emit(scale_index, 1, offset, {index, pointer.offset}).imm = {count, stride};
  pointer.offset = offset;
}

Value Decoder::load(const Value& pointer) {
  if (pointer.kind == Value::Kind::kTexture || pointer.kind == Value::Kind::kSampler) return pointer;
  if (pointer.read_only && pointer.offset == kNoSlot)
    return {Value::Kind::kCells, pointer.type, pointer.slot, kNoSlot, false};
  const Value result = new_value(pointer.type);
  if (pointer.offset == kNoSlot) {
    copy(result.slot, pointer.slot, cells(pointer.type));
  } else {
    emit(gather_cells, cells(pointer.type), result.slot, {pointer.slot, pointer.offset});
  }
  return result;
}

void Decoder::store(const Value& pointer, const Value& stored) {
  if (pointer.offset == kNoSlot) {
    copy(pointer.slot, stored.slot, cells(pointer.type));
  } else {
    emit(scatter_cells, cells(pointer.type), pointer.slot, {stored.slot, pointer.offset});
  }
}

bool Decoder::composite_instruction(Frame& frame, const SpirvInstruction& in) {
  switch (in.op) {
    case spv::OpCompositeConstruct: construct(frame, in); return true;
    case spv::OpCompositeExtract:
      frame.values[in.result] = element(value(frame, in.words[0]), std::span(in.words).subspan(1));
      return true;
    case spv::OpCompositeInsert: insert(frame, in); return true;
    case spv::OpVectorShuffle: shuffle(frame, in); return true;
    case spv::OpCopyObject:
    case spv::OpCopyLogical: {
      Value same = value(frame, in.words[0]);
      if (same.kind == Value::Kind::kCells) same.type = in.type;
      frame.values[in.result] = same;
      return true;
    }
    case spv::OpUndef: {
      const Value& undefined = define(frame, in);
      zero(undefined.slot, cells(in.type));
      return true;
    }
    case spv::OpVectorExtractDynamic:
      emit(extract_dynamic, cells(value(frame, in.words[0]).type), define(frame, in).slot,
           {value(frame, in.words[0]).slot, value(frame, in.words[1]).slot});
      return true;
    case spv::OpVectorInsertDynamic: {
      const Slot dst = define(frame, in).slot;
      const Value& vector = value(frame, in.words[0]);
      copy(dst, vector.slot, cells(in.type));
      emit(insert_dynamic, cells(in.type), dst,
           {value(frame, in.words[1]).slot, value(frame, in.words[2]).slot});
      return true;
    }
    default: return false;
  }
}

Value Decoder::element(Value composite, std::span<const std::uint32_t> literals) const {
  for (const std::uint32_t literal : literals) {
    const SpirvType& t = module_.type(composite.type);
    if (t.kind == TypeKind::kStruct) {
      for (std::uint32_t i = 0; i < literal; ++i) composite.slot += cells(t.members[i]);
      composite.type = t.members[literal];
    } else {
      composite.slot += literal * cells(t.element);
      composite.type = t.element;
    }
  }
  return composite;
}

void Decoder::construct(Frame& frame, const SpirvInstruction& in) {
  Slot at = define(frame, in).slot;
  for (const Id part : in.words) {
    const Value& v = value(frame, part);
    copy(at, v.slot, cells(v.type));
    at += cells(v.type);
  }
}

void Decoder::insert(Frame& frame, const SpirvInstruction& in) {
  const Value result = define(frame, in);
  copy(result.slot, value(frame, in.words[1]).slot, cells(in.type));
  const Value place = element(result, std::span(in.words).subspan(2));
  copy(place.slot, value(frame, in.words[0]).slot, cells(place.type));
}

void Decoder::shuffle(Frame& frame, const SpirvInstruction& in) {
  const Slot dst = define(frame, in).slot;
  const Value& a = value(frame, in.words[0]);
  const Value& b = value(frame, in.words[1]);
  const std::uint32_t split = cells(a.type);
  for (std::uint32_t i = 0; i < cells(in.type); ++i) {
    const std::uint32_t pick = in.words[2 + i];
    if (pick == kNoNumber) continue;  // undefined component
    copy(dst + i, pick < split ? a.slot + pick : b.slot + (pick - split), 1);
  }
}

}  // namespace quadrille::models::reference
