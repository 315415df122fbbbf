/// Emits scalar code: folds literals, numbers values (an expression computed in an enclosing scope is not
/// computed again) and carries float negation and absolute value as operand modifiers.
#pragma once

#include "pipeline/compiler/ir.h"

#include <bit>
#include <tuple>
#include <unordered_map>

namespace quadrille::pipeline {

[[nodiscard]] inline Value literal(std::uint32_t bits) { return {Value::Kind::kLiteral, 0, bits}; }
[[nodiscard]] inline Value literal(float value) { return literal(std::bit_cast<std::uint32_t>(value)); }
[[nodiscard]] inline Value uniform_word(std::uint32_t block, std::uint32_t word) {
  return {Value::Kind::kUniform, 0, block << 16 | word};
}
inline constexpr std::uint32_t kTrue = 0xffffffffu;

class ScalarBuilder {
 public:
  explicit ScalarBuilder(ScalarShader& shader) : shader_(shader) {}

  /// A pure operation: folded, found or emitted.
  Value emit(models::Op op, Value a, Value b = {}, Value c = {}, std::uint16_t imm = 0,
             std::uint8_t flags = 0);
  /// A pure operation with several results (textures): the first of its consecutive registers.
  Value emit_wide(models::Op op, Value a, Value b, Value c, std::uint16_t imm);
  /// An operation with an effect and no result.
  void effect(models::Op op, Value a = {}, std::uint16_t imm = 0, Value b = {});
  /// An operation whose result depends on when it is done: never found again.
  Value emit_anew(models::Op op, std::uint16_t imm, Value a = {}, Value b = {}, Value c = {});

  /// A register that may be assigned many times.
  Value new_variable();
  void assign(Value variable, Value value);
  /// A copy of a variable's present value.
  Value read(Value variable);

  /// Values emitted in a scope are forgotten at its end: other lanes or paths may not have computed them.
  void open_scope() { undo_.push_back({}); }
  void close_scope();

  Value fadd(Value a, Value b) { return emit(models::Op::kFAdd, a, b); }
  Value fsub(Value a, Value b) { return fadd(a, fneg(b)); }
  Value fmul(Value a, Value b) { return emit(models::Op::kFMul, a, b); }
  Value fdiv(Value a, Value b) { return emit(models::Op::kFDiv, a, b); }
  /// a * b + c, rounded twice.
  Value fmad(Value a, Value b, Value c) { return fadd(fmul(a, b), c); }
  Value fmin(Value a, Value b) { return emit(models::Op::kFMin, a, b); }
  Value fmax(Value a, Value b) { return emit(models::Op::kFMax, a, b); }
  /// min(max(x, lo), hi); a clamp to [0, 1] is one saturating operation.
  Value fclamp(Value x, Value lo, Value hi);
  Value fneg(Value a);
  Value fabs(Value a);
  Value iadd(Value a, Value b) { return emit(models::Op::kIAdd, a, b); }
  Value select(Value condition, Value yes, Value no) { return emit(models::Op::kSelect, condition, yes, no); }
  /// Logical not of a comparison's result.
  Value invert(Value condition);

 private:
  using Key =
      std::tuple<models::Op, std::uint8_t, std::uint16_t, std::uint64_t, std::uint64_t, std::uint64_t>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  std::uint32_t new_register(bool variable);
  Value plain(Value value);
  Value simplify(models::Op op, Value a, Value b, Value c) const;
  Value lookup_or_append(const ScalarInstruction& instruction, int results);

  ScalarShader& shader_;
  std::unordered_map<Key, Value, KeyHash> known_;
  std::vector<std::vector<Key>> undo_{{}};
  std::unordered_map<std::uint32_t, std::size_t> definition_;  ///< register -> place in the code
};

/// Whether this operand of `op` may be negated or made absolute.
[[nodiscard]] bool takes_modifiers(models::Op op, int operand);

}  // namespace quadrille::pipeline
