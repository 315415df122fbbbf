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

bool Decoder::texture_instruction(Frame& frame, const SpirvInstruction& in) {
  switch (in.op) {
    case spv::OpImageSampleImplicitLod: sample(frame, in, true); return true;
    case spv::OpImageSampleExplicitLod: sample(frame, in, false); return true;
    case spv::OpImage: frame.values[in.result] = value(frame, in.words[0]); return true;
    case spv::OpImageQuerySizeLod:
      emit(query_size, 2, define(frame, in).slot, {kNoSlot, value(frame, in.words[1]).slot}).imm[0] =
          value(frame, in.words[0]).slot;
      return true;
    case spv::OpImageQueryLevels:
      emit(query_levels, 1, define(frame, in).slot, {}).imm[0] = value(frame, in.words[0]).slot;
      return true;
    default: return false;
  }
}

void Decoder::sample(Frame& frame, const SpirvInstruction& in, bool implicit) {
  if (implicit && stage_ != traces::ShaderStage::kFragment)
    unsupported("sampling with an implicit level of detail outside a fragment shader");
  const std::uint32_t operands = in.words.size() > 2 ? in.words[2] : 0;
  const std::uint32_t allowed = implicit ? spv::ImageOperandsBiasMask : spv::ImageOperandsLodMask;
  if ((operands & ~allowed) != 0) unsupported("image operands other than bias and lod");
  const Slot level = operands != 0 ? value(frame, in.words[3]).slot : kNoSlot;
  const Slot dst = define(frame, in).slot;
  emit(implicit ? sample_implicit : sample_explicit, 4, dst, {value(frame, in.words[1]).slot, level}).imm[0] =
      value(frame, in.words[0]).slot;
}

}  // namespace quadrille::models::reference
