/// Arithmetic, comparisons and the taking apart and putting together of composites, scalar by scalar.
#include "pipeline/compiler/lowering.h"

#include <algorithm>
#include <array>

namespace quadrille::pipeline {
namespace {

using models::Op;

struct Mapped {
  spv::Op from;
  Op to;
  bool swapped = false, inverted = false;
};

constexpr auto kMapped = std::to_array<Mapped>({
    {spv::OpFAdd, Op::kFAdd},
    {spv::OpFMul, Op::kFMul},
    {spv::OpFDiv, Op::kFDiv},
    {spv::OpIAdd, Op::kIAdd},
    {spv::OpISub, Op::kISub},
    {spv::OpIMul, Op::kIMul},
    {spv::OpUDiv, Op::kUDiv},
    {spv::OpSDiv, Op::kIDiv},
    {spv::OpUMod, Op::kUMod},
    {spv::OpSRem, Op::kIRem},
    {spv::OpSMod, Op::kIMod},
    {spv::OpShiftRightLogical, Op::kShrU},
    {spv::OpShiftRightArithmetic, Op::kShrS},
    {spv::OpShiftLeftLogical, Op::kShl},
    {spv::OpBitwiseOr, Op::kOr},
    {spv::OpBitwiseXor, Op::kXor},
    {spv::OpBitwiseAnd, Op::kAnd},
    {spv::OpNot, Op::kNot},
    {spv::OpLogicalOr, Op::kOr},
    {spv::OpLogicalAnd, Op::kAnd},
    {spv::OpLogicalNotEqual, Op::kXor},
    {spv::OpLogicalEqual, Op::kXor, false, true},
    {spv::OpConvertFToU, Op::kF2U},
    {spv::OpConvertFToS, Op::kF2I},
    {spv::OpConvertSToF, Op::kI2F},
    {spv::OpConvertUToF, Op::kU2F},
    {spv::OpIEqual, Op::kIEq},
    {spv::OpINotEqual, Op::kINe},
    {spv::OpUGreaterThan, Op::kULt, true},
    {spv::OpSGreaterThan, Op::kILt, true},
    {spv::OpUGreaterThanEqual, Op::kULe, true},
    {spv::OpSGreaterThanEqual, Op::kILe, true},
    {spv::OpULessThan, Op::kULt},
    {spv::OpSLessThan, Op::kILt},
    {spv::OpULessThanEqual, Op::kULe},
    {spv::OpSLessThanEqual, Op::kILe},
    {spv::OpFOrdEqual, Op::kFEq},
    {spv::OpFUnordNotEqual, Op::kFNe},
    {spv::OpFOrdLessThan, Op::kFLt},
    {spv::OpFOrdGreaterThan, Op::kFLt, true},
    {spv::OpFOrdLessThanEqual, Op::kFLe},
    {spv::OpFOrdGreaterThanEqual, Op::kFLe, true},
    {spv::OpFUnordLessThan, Op::kFLe, true, true},
    {spv::OpFUnordGreaterThan, Op::kFLe, false, true},
    {spv::OpFUnordLessThanEqual, Op::kFLt, true, true},
    {spv::OpFUnordGreaterThanEqual, Op::kFLt, false, true},
});

}  // namespace

/// One operation a scalar; unary operations have one operand.
void Lowering::elementwise(const spirv::Instruction& i, Op op, bool swapped, bool inverted) {
  const Values a = value(i.operands[0]);
  const Values b = i.operands.size() > 1 ? value(i.operands[1]) : Values(a.size());
  if (a.size() != b.size()) throw unsupported(i, "an operation on operands of different sizes");
  Values result;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Value v = swapped ? build_.emit(op, b[k], a[k]) : build_.emit(op, a[k], b[k]);
    result.push_back(inverted ? build_.emit(Op::kNot, v) : v);
  }
  define(i, std::move(result));
}

/// Products summed from the first component to the last, each step rounded.
Value Lowering::dot(const Values& a, const Values& b) {
  Value sum = build_.fmul(a[0], b[0]);
  for (std::size_t k = 1; k < a.size(); ++k) sum = build_.fadd(build_.fmul(a[k], b[k]), sum);
  return sum;
}

bool Lowering::arithmetic(const spirv::Instruction& i) {
  const auto found =
      std::find_if(kMapped.begin(), kMapped.end(), [&](const Mapped& row) { return row.from == i.op; });
  if (found != kMapped.end()) return elementwise(i, found->to, found->swapped, found->inverted), true;
  const auto each = [&](auto&& function) {
    const Values a = value(i.operands[0]);
    const Values b = i.operands.size() > 1 ? value(i.operands[1]) : Values{};
    Values result;
    for (std::size_t k = 0; k < a.size(); ++k)
      result.push_back(function(a[k], b.empty() ? Value{} : b[std::min(k, b.size() - 1)]));
    define(i, std::move(result));
    return true;
  };
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpFNegate: return each([&](Value a, Value) { return build_.fneg(a); });
    case spv::OpFSub: return each([&](Value a, Value b) { return build_.fsub(a, b); });
    case spv::OpSNegate: return each([&](Value a, Value) { return build_.emit(Op::kISub, literal(0u), a); });
    case spv::OpFRem:
      return each([&](Value a, Value b) {
        return build_.fsub(a, build_.fmul(b, build_.emit(Op::kFTrunc, build_.fdiv(a, b))));
      });
    case spv::OpFMod:
      return each([&](Value a, Value b) {
        return build_.fsub(a, build_.fmul(b, build_.emit(Op::kFFloor, build_.fdiv(a, b))));
      });
    case spv::OpVectorTimesScalar: return each([&](Value a, Value b) { return build_.fmul(a, b); });
    case spv::OpDot: return define(i, {dot(value(i.operands[0]), value(i.operands[1]))}), true;
    default: return false;
  }
}

bool Lowering::comparison(const spirv::Instruction& i) {
  const auto each = [&](auto&& function) {
    const Values a = value(i.operands[0]);
    const Values b = i.operands.size() > 1 ? value(i.operands[1]) : a;
    Values result;
    for (std::size_t k = 0; k < a.size(); ++k) result.push_back(function(a[k], b[k]));
    define(i, std::move(result));
    return true;
  };
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpLogicalNot: return each([&](Value a, Value) { return build_.invert(a); });
    case spv::OpFOrdNotEqual:
      return each([&](Value a, Value b) {
        return build_.emit(Op::kOr, build_.emit(Op::kFLt, a, b), build_.emit(Op::kFLt, b, a));
      });
    case spv::OpFUnordEqual:
      return each([&](Value a, Value b) {
        return build_.emit(Op::kNot,
                           build_.emit(Op::kOr, build_.emit(Op::kFLt, a, b), build_.emit(Op::kFLt, b, a)));
      });
    case spv::OpIsNan: return each([&](Value a, Value) { return build_.emit(Op::kFNe, a, a); });
    case spv::OpIsInf:
      return each(
          [&](Value a, Value) { return build_.emit(Op::kFEq, build_.fabs(a), literal(0x7f800000u)); });
    case spv::OpAny:
    case spv::OpAll: {
      const Values a = value(i.operands[0]);
      Value all = a[0];
      for (std::size_t k = 1; k < a.size(); ++k)
        all = build_.emit(i.op == spv::OpAny ? Op::kOr : Op::kAnd, all, a[k]);
      return define(i, {all}), true;
    }
    case spv::OpSelect: {
      const Values condition = value(i.operands[0]), a = value(i.operands[1]), b = value(i.operands[2]);
      Values result;
      for (std::size_t k = 0; k < a.size(); ++k)
        result.push_back(build_.select(condition[std::min(k, condition.size() - 1)], a[k], b[k]));
      return define(i, std::move(result)), true;
    }
    default: return false;
  }
}

/// Offset in scalars of a member named by constant indices; `found` becomes its type.
std::uint32_t Lowering::composite_offset(Id type, std::span<const std::uint32_t> indices, Id& found,
                                         const spirv::Instruction& i) const {
  std::uint32_t offset = 0;
  for (const std::uint32_t index : indices) {
    const spirv::Type& t = module_.type(type);
    const bool is_struct = t.kind == spirv::Type::Kind::kStruct;
    if (index >= (is_struct ? t.members.size() : t.count))
      throw unsupported(i, "an index beyond the composite");
    if (is_struct)
      for (std::uint32_t k = 0; k < index; ++k) offset += module_.type(t.members[k]).scalars;
    else offset += index * module_.type(t.element).scalars;
    type = is_struct ? t.members[index] : t.element;
  }
  found = type;
  return offset;
}

bool Lowering::composite(const spirv::Instruction& i) {
  const auto at = [](const Values& values, std::size_t k) {
    return k < values.size() ? values[k] : literal(0u);
  };
  Id found = 0;
  Values result;
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpCopyObject:
    case spv::OpCopyLogical:
      if (const auto p = pointers_.find(i.operands[0]); p != pointers_.end())
        return pointers_[i.result] = Pointer(p->second), true;
      if (const auto t = textures_.find(i.operands[0]); t != textures_.end())
        return textures_[i.result] = std::uint16_t{t->second}, true;
      [[fallthrough]];
    case spv::OpBitcast: result = value(i.operands[0]); break;
    case spv::OpCompositeConstruct:
      for (const Id part : i.operands) {
        const Values& values = value(part);
        result.insert(result.end(), values.begin(), values.end());
      }
      break;
    case spv::OpCompositeExtract: {
      const Values& whole = value(i.operands[0]);
      const std::uint32_t offset =
          composite_offset(value_type(i.operands[0]), i.operands.subspan(1), found, i);
      for (std::uint32_t k = 0; k < module_.type(found).scalars; ++k) result.push_back(at(whole, offset + k));
      break;
    }
    case spv::OpCompositeInsert: {
      const Values part = value(i.operands[0]);
      result = value(i.operands[1]);
      const std::uint32_t offset = composite_offset(i.type, i.operands.subspan(2), found, i);
      for (std::size_t k = 0; k < part.size() && offset + k < result.size(); ++k)
        result[offset + k] = part[k];
      break;
    }
    case spv::OpVectorShuffle: {
      const Values a = value(i.operands[0]), b = value(i.operands[1]);
      for (const std::uint32_t k : i.operands.subspan(2))
        result.push_back(k < a.size() ? a[k] : at(b, k - a.size()));
      break;
    }
    case spv::OpVectorExtractDynamic: {
      const Values vector = value(i.operands[0]);
      const Value index = scalar(i.operands[1]);
      Value chosen = vector[0];
      for (std::uint32_t k = 1; k < vector.size(); ++k)
        chosen = build_.select(build_.emit(Op::kIEq, index, literal(k)), vector[k], chosen);
      result = {chosen};
      break;
    }
    case spv::OpVectorInsertDynamic: {
      const Values vector = value(i.operands[0]);
      const Value part = scalar(i.operands[1]), index = scalar(i.operands[2]);
      for (std::uint32_t k = 0; k < vector.size(); ++k)
        result.push_back(build_.select(build_.emit(Op::kIEq, index, literal(k)), part, vector[k]));
      break;
    }
    default: return false;
  }
  define(i, std::move(result));
  return true;
}

}  // namespace quadrille::pipeline
