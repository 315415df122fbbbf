/// Storage buffers: loads, stores and atomic operations by byte offset. [VK1.3 #descriptorsets-storagebuffer]
#include "pipeline/compiler/lowering.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

using models::Op;
using Kind = spirv::Type::Kind;

/// The operation that an instruction does to its word with operand 3, or kNop.
Op atomic_op(const spirv::Instruction& i) {
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpAtomicIAdd: return Op::kAtomicAdd;
    case spv::OpAtomicSMin: return Op::kAtomicIMin;
    case spv::OpAtomicUMin: return Op::kAtomicUMin;
    case spv::OpAtomicSMax: return Op::kAtomicIMax;
    case spv::OpAtomicUMax: return Op::kAtomicUMax;
    case spv::OpAtomicAnd: return Op::kAtomicAnd;
    case spv::OpAtomicOr: return Op::kAtomicOr;
    case spv::OpAtomicXor: return Op::kAtomicXor;
    case spv::OpAtomicExchange: return Op::kAtomicExchange;
    default: return Op::kNop;
  }
}

}  // namespace

void Lowering::declare_buffer(const spirv::Variable& variable) {
  if (module_.type(variable.type).kind != Kind::kStruct)
    throw user_error("{}",
                     module_.at_use(variable.id, fmt::format("buffer {} is an array of buffers, which is not "
                                                             "supported (declare each by itself)",
                                                             module_.name(variable.id))));
  const spirv::Decorations& d = module_.decorations(variable.id);
  const models::BufferBinding binding{static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.set)),
                                      static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.binding))};
  const auto found = std::find(shader_.buffers.begin(), shader_.buffers.end(), binding);
  buffers_[variable.id] = static_cast<std::uint16_t>(found - shader_.buffers.begin());
  if (found == shader_.buffers.end()) shader_.buffers.push_back(binding);
}

std::uint16_t Lowering::buffer_of(const Pointer& p, const spirv::Instruction& i) const {
  const auto found = buffers_.find(p.variable);
  if (found == buffers_.end()) throw unsupported(i, "an atomic operation on what is no buffer");
  return found->second;
}

Value Lowering::byte_offset(const Pointer& p, const spirv::Instruction& i) {
  const bool aligned = p.offset % 4 == 0 && std::ranges::all_of(p.dynamic, [](const Index& index) {
                         return index.stride % 4 == 0;
                       });
  if (!aligned) throw unsupported(i, "a block layout that is not a multiple of 4 bytes");
  return build_.iadd(dynamic_offset(p, 1), literal(p.offset));
}

Value Lowering::load_word(const Pointer& p, const spirv::Instruction& i) {
  return build_.emit_anew(Op::kLoadBuffer, buffer_of(p, i), byte_offset(p, i));
}

void Lowering::store_words(const Pointer& p, const Values& values, const spirv::Instruction& i) {
  std::size_t next = 0;
  visit_words(p, i, [&](const Pointer& word) {
    build_.effect(Op::kStoreBuffer, byte_offset(word, i), buffer_of(word, i), values.at(next++));
  });
}

void Lowering::atomic(const spirv::Instruction& i, Op op, Value operand, Value comparator) {
  const Pointer& p = pointer(i.operands[0], i);
  const Value old = build_.emit_anew(op, buffer_of(p, i), byte_offset(p, i), operand, comparator);
  if (i.result != 0) define(i, {old});
}

/// Elements of the array at the end of a buffer.
void Lowering::array_length(const spirv::Instruction& i) {
  const Pointer& p = pointer(i.operands[0], i);
  const spirv::Type& block = module_.type(p.type);
  const std::uint32_t member = i.operands[1];
  if (block.kind != Kind::kStruct || member >= block.members.size())
    throw unsupported(i, "the length of what is no array of a buffer");
  const auto offset = static_cast<std::uint32_t>(
      std::max<std::int64_t>(0, module_.member_decorations(p.type, member).offset));
  const auto stride = static_cast<std::uint32_t>(
      std::max<std::int64_t>(1, module_.decorations(block.members[member]).array_stride));
  const Value size = build_.emit_anew(Op::kBufferSize, buffer_of(p, i));
  const Value within = build_.emit(Op::kISub, build_.emit(Op::kUMax, size, literal(offset)), literal(offset));
  define(i, {build_.emit(Op::kUDiv, within, literal(stride))});
}

bool Lowering::storage(const spirv::Instruction& i) {
  if (const Op op = atomic_op(i); op != Op::kNop) {
    atomic(i, op, scalar(i.operands[3]));
    return true;
  }
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpAtomicIIncrement: atomic(i, Op::kAtomicAdd, literal(1u)); return true;
    case spv::OpAtomicIDecrement: atomic(i, Op::kAtomicAdd, literal(~0u)); return true;
    case spv::OpAtomicISub:
      atomic(i, Op::kAtomicAdd, build_.emit(Op::kISub, literal(0u), scalar(i.operands[3])));
      return true;
    case spv::OpAtomicLoad: atomic(i, Op::kAtomicOr, literal(0u)); return true;
    case spv::OpAtomicStore: atomic(i, Op::kAtomicExchange, scalar(i.operands[3])); return true;
    case spv::OpAtomicCompareExchange:
      atomic(i, Op::kAtomicCompareExchange, scalar(i.operands[4]), scalar(i.operands[5]));
      return true;
    case spv::OpArrayLength: array_length(i); return true;
    // Other invocations of a pass may not see what one wrote, so there is nothing to order.
    case spv::OpMemoryBarrier: return true;
    default: return false;
  }
}

}  // namespace quadrille::pipeline
