#include "pipeline/compiler/builder.h"

#include "models/base/error.h"
#include "models/shader/op_table.h"
#include "pipeline/compiler/fold.h"

#include <utility>

namespace quadrille::pipeline {
namespace {

using models::Op;
using models::Operand;

constexpr std::uint32_t kSignBit = 0x80000000u;
constexpr std::uint32_t kOne = 0x3f800000u;

bool commutes(Op op) {
  return op == Op::kFAdd || op == Op::kFMul || op == Op::kFEq || op == Op::kFNe || op == Op::kIAdd ||
         op == Op::kIMul || op == Op::kIMin || op == Op::kIMax || op == Op::kUMin || op == Op::kUMax ||
         op == Op::kAnd || op == Op::kOr || op == Op::kXor || op == Op::kIEq || op == Op::kINe;
}

std::uint64_t pack(Value value) {
  return static_cast<std::uint64_t>(value.bits) | static_cast<std::uint64_t>(value.kind) << 32 |
         static_cast<std::uint64_t>(value.modifiers) << 40;
}

Value integer_identity(Op op, Value a, Value b) {
  const bool zero = b.is_literal(0), ones = b.is_literal(kTrue), one = b.is_literal(1);
  if (zero && (op == Op::kIAdd || op == Op::kISub || op == Op::kOr || op == Op::kXor || op == Op::kShl ||
               op == Op::kShrU || op == Op::kShrS))
    return a;
  if (zero && (op == Op::kAnd || op == Op::kIMul)) return b;
  if (ones && op == Op::kAnd) return a;
  if (ones && op == Op::kOr) return b;
  if (one && (op == Op::kIMul || op == Op::kIDiv || op == Op::kUDiv)) return a;
  if (a == b && (op == Op::kAnd || op == Op::kOr || op == Op::kIMin || op == Op::kIMax || op == Op::kUMin ||
                 op == Op::kUMax))
    return a;
  return {};
}

}  // namespace

bool takes_modifiers(Op op, int operand) { return (models::op_info(op).modifiable >> operand & 1) != 0; }

std::size_t ScalarBuilder::KeyHash::operator()(const Key& key) const {
  const auto& [op, flags, imm, a, b, c] = key;
  std::uint64_t hash = static_cast<std::uint64_t>(op) | static_cast<std::uint64_t>(flags) << 8 |
                       static_cast<std::uint64_t>(imm) << 16;
  for (const std::uint64_t part : {a, b, c}) hash = (hash ^ part) * 0x9e3779b97f4a7c15ull ^ hash >> 29;
  return static_cast<std::size_t>(hash ^ hash >> 32);
}

std::uint32_t ScalarBuilder::new_register(bool variable) {
  shader_.variable.push_back(variable);
  return static_cast<std::uint32_t>(shader_.variable.size() - 1);
}

Value ScalarBuilder::new_variable() { return {Value::Kind::kRegister, 0, new_register(true)}; }

void ScalarBuilder::assign(Value variable, Value value) {
  ScalarInstruction move;
  move.op = Op::kMov;
  move.dst = variable.bits;
  move.a = value;
  shader_.code.push_back(move);
}

Value ScalarBuilder::read(Value variable) {
  ScalarInstruction move;
  move.op = Op::kMov;
  move.dst = new_register(false);
  move.a = variable;
  shader_.code.push_back(move);
  return {Value::Kind::kRegister, 0, move.dst};
}

void ScalarBuilder::close_scope() {
  for (const Key& key : undo_.back()) known_.erase(key);
  undo_.pop_back();
}

Value ScalarBuilder::fneg(Value a) {
  if (a.is_literal()) return literal(a.bits ^ kSignBit);
  a.modifiers ^= Operand::kNegate;
  return a;
}

Value ScalarBuilder::fabs(Value a) {
  if (a.is_literal()) return literal(a.bits & ~kSignBit);
  a.modifiers = Operand::kAbsolute;
  return a;
}

/// The same value without modifiers, for operations that read bits.
Value ScalarBuilder::plain(Value value) {
  const std::uint8_t modifiers = std::exchange(value.modifiers, std::uint8_t{0});
  if (modifiers == 0) return value;
  if (modifiers == Operand::kNegate) return emit(Op::kXor, value, literal(kSignBit));
  if (modifiers == Operand::kAbsolute) return emit(Op::kAnd, value, literal(~kSignBit));
  return emit(Op::kOr, value, literal(kSignBit));
}

/// Exact identities only: x * 1, x + -0, selections and integer ones. x * 0 and x + 0 stay, for NaN, infinity
/// and signed zero.
Value ScalarBuilder::simplify(Op op, Value a, Value b, Value c) const {
  if (op == Op::kSelect) {
    if (a.is_literal()) return a.bits != 0 ? b : c;
    return b == c ? b : Value{};
  }
  if (op == Op::kFMul && b.is_literal(kOne)) return a;
  if (op == Op::kFDiv && b.is_literal(kOne)) return a;
  if (op == Op::kFAdd && b.is_literal(kSignBit)) return a;
  return integer_identity(op, a, b);
}

Value ScalarBuilder::emit(Op op, Value a, Value b, Value c, std::uint16_t imm, std::uint8_t flags) {
  if (!takes_modifiers(op, 0)) a = plain(a);
  if (!takes_modifiers(op, 1)) b = plain(b);
  if (!takes_modifiers(op, 2)) c = plain(c);
  if (commutes(op) && (a.is_literal() || (!b.is_literal() && pack(b) < pack(a)))) std::swap(a, b);
  const auto known = [](Value value) { return value.is_literal() || value.kind == Value::Kind::kNone; };
  if (flags == 0 && a.is_literal() && known(b) && known(c))
    if (const auto folded = fold(op, a.bits, b.bits, c.bits)) return literal(*folded);
  if (flags == 0)
    if (const Value simple = simplify(op, a, b, c); simple.kind != Value::Kind::kNone) return simple;
  return lookup_or_append({op, flags, imm, 0, a, b, c}, 1);
}

Value ScalarBuilder::emit_wide(Op op, Value a, Value b, Value c, std::uint16_t imm) {
  if (!takes_modifiers(op, 0)) a = plain(a);
  return lookup_or_append({op, 0, imm, 0, a, b, c}, models::destination_count(op));
}

Value ScalarBuilder::lookup_or_append(const ScalarInstruction& instruction, int results) {
  const Key key{instruction.op,      instruction.flags,   instruction.imm,
                pack(instruction.a), pack(instruction.b), pack(instruction.c)};
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  ScalarInstruction appended = instruction;
  appended.dst = new_register(false);
  for (int i = 1; i < results; ++i) new_register(false);
  definition_[appended.dst] = shader_.code.size();
  shader_.code.push_back(appended);
  const Value value{Value::Kind::kRegister, 0, appended.dst};
  known_.emplace(key, value);
  undo_.back().push_back(key);
  return value;
}

void ScalarBuilder::effect(Op op, Value a, std::uint16_t imm, Value b) {
  ScalarInstruction instruction;
  instruction.op = op;
  instruction.imm = imm;
  instruction.a = takes_modifiers(op, 0) ? a : plain(a);
  instruction.b = plain(b);
  shader_.code.push_back(instruction);
}

Value ScalarBuilder::emit_anew(Op op, std::uint16_t imm, Value a, Value b, Value c) {
  const std::uint32_t result = new_register(false);
  shader_.code.push_back({op, 0, imm, result, plain(a), plain(b), plain(c)});
  return {Value::Kind::kRegister, 0, result};
}

Value ScalarBuilder::fclamp(Value x, Value lo, Value hi) {
  if (!x.is_literal() && lo.is_literal(0) && hi.is_literal(kOne))
    return emit(Op::kMov, x, {}, {}, 0, models::Instruction::kSaturate);
  return fmin(fmax(x, lo), hi);
}

Value ScalarBuilder::invert(Value condition) {
  if (condition.is_register()) {
    if (const auto found = definition_.find(condition.bits); found != definition_.end()) {
      const ScalarInstruction& source = shader_.code[found->second];
      switch (static_cast<int>(source.op)) {
        case static_cast<int>(Op::kNot): return source.a;
        case static_cast<int>(Op::kFEq): return emit(Op::kFNe, source.a, source.b);
        case static_cast<int>(Op::kFNe): return emit(Op::kFEq, source.a, source.b);
        case static_cast<int>(Op::kIEq): return emit(Op::kINe, source.a, source.b);
        case static_cast<int>(Op::kINe): return emit(Op::kIEq, source.a, source.b);
        case static_cast<int>(Op::kILt): return emit(Op::kILe, source.b, source.a);
        case static_cast<int>(Op::kILe): return emit(Op::kILt, source.b, source.a);
        case static_cast<int>(Op::kULt): return emit(Op::kULe, source.b, source.a);
        case static_cast<int>(Op::kULe): return emit(Op::kULt, source.b, source.a);
        default: break;
      }
    }
  }
  return emit(Op::kNot, condition);
}

}  // namespace quadrille::pipeline
