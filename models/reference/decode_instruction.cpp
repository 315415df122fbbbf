/// Decoding arithmetic and texture instructions.
#include <spirv/unified1/spirv.hpp>

#include "models/reference/decode.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

bool has_no_effect(std::uint32_t op) { return op == spv::OpNop || op == spv::OpNoLine || op == spv::OpLine; }

Handler core_handler(std::uint32_t op) {
  for (const auto family : {float_handler, vector_handler, integer_handler}) {
    if (const Handler handler = family(op); handler != nullptr) return handler;
  }
  return nullptr;
}

}  // namespace

void Decoder::instruction(Frame& frame, const SpirvInstruction& in) {
  if (has_no_effect(in.op) || memory_instruction(frame, in) || composite_instruction(frame, in) ||
      texture_instruction(frame, in))
    return;
  if (in.op == spv::OpFunctionCall) return call(frame, in);
  if (in.op == spv::OpExtInst) return glsl_instruction(frame, in);
  if (in.op == spv::OpDemoteToHelperInvocation) {
    program_.discards = true;
    emit(kill_lanes, 1, kNoSlot, {});
    return;
  }
  const auto is_float = [this](Id type) { return module_.scalar_of(type).kind == TypeKind::kFloat; };
  const Handler handler = in.op == spv::OpBitcast
                              ? bitcast_handler(is_float(value(frame, in.words[0]).type), is_float(in.type))
                              : core_handler(in.op);
  if (handler == nullptr) unsupported_op(in.op);
  arithmetic(frame, in, handler, in.words, in.op == spv::OpSelect);
}

/// Emits an operation by the calling rule of handlers.h.
void Decoder::arithmetic(Frame& frame, const SpirvInstruction& in, Handler handler,
                         std::span<const std::uint32_t> operands, bool n_from_result) {
  const Slot dst = define(frame, in).slot;
  const Value& first = value(frame, operands[0]);
  const SpirvType& first_type = module_.type(first.type);
  const std::uint32_t n = n_from_result ? cells(in.type) : cells(first.type);
  Operation& o = emit(handler, n, dst, {});
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Value& operand = value(frame, operands[i]);
    if (operand.kind != Value::Kind::kCells) unsupported("arithmetic on pointers");
    o.src.at(i) = operand.slot;
    o.step.at(i) = cells(operand.type) == 1 && n > 1 ? 0 : 1;
  }
  o.imm = {cells(in.type), first_type.kind == TypeKind::kMatrix ? cells(first_type.element) : n};
}

}  // namespace quadrille::models::reference
