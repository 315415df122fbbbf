#include "pipeline/compiler/spirv_spec_constants.h"

#include <algorithm>
#include <array>

namespace quadrille::pipeline::spirv {
namespace {

using Word = std::uint32_t;
using Words = std::vector<Word>;

std::int32_t as_signed(Word w) { return static_cast<std::int32_t>(w); }
Word truth(bool b) { return b ? 0xffffffffu : 0u; }

/// Divisions that SPIR-V leaves undefined give zero.
std::optional<Word> divide(Word op, Word a, Word b) {
  const bool overflows = a == 0x80000000u && b == 0xffffffffu;
  const std::int64_t x = as_signed(a), y = as_signed(b);
  switch (op) {
    case spv::OpUDiv: return b == 0 ? 0 : a / b;
    case spv::OpUMod: return b == 0 ? 0 : a % b;
    case spv::OpSDiv: return b == 0 ? 0 : overflows ? a : static_cast<Word>(x / y);
    case spv::OpSRem: return b == 0 ? 0 : static_cast<Word>(x % y);
    case spv::OpSMod:
      return b == 0 ? 0 : static_cast<Word>(x % y != 0 && (x % y < 0) != (y < 0) ? x % y + y : x % y);
    default: return std::nullopt;
  }
}

std::optional<Word> compare(Word op, Word a, Word b) {
  switch (op) {
    case spv::OpLogicalOr: return a | b;
    case spv::OpLogicalAnd: return a & b;
    case spv::OpIEqual:
    case spv::OpLogicalEqual: return truth(a == b);
    case spv::OpINotEqual:
    case spv::OpLogicalNotEqual: return truth(a != b);
    case spv::OpULessThan: return truth(a < b);
    case spv::OpULessThanEqual: return truth(a <= b);
    case spv::OpUGreaterThan: return truth(a > b);
    case spv::OpUGreaterThanEqual: return truth(a >= b);
    case spv::OpSLessThan: return truth(as_signed(a) < as_signed(b));
    case spv::OpSLessThanEqual: return truth(as_signed(a) <= as_signed(b));
    case spv::OpSGreaterThan: return truth(as_signed(a) > as_signed(b));
    case spv::OpSGreaterThanEqual: return truth(as_signed(a) >= as_signed(b));
    default: return divide(op, a, b);
  }
}

std::optional<Word> binary(Word op, Word a, Word b) {
  switch (op) {
    case spv::OpIAdd: return a + b;
    case spv::OpISub: return a - b;
    case spv::OpIMul: return a * b;
    case spv::OpShiftLeftLogical: return a << (b & 31u);
    case spv::OpShiftRightLogical: return a >> (b & 31u);
    case spv::OpShiftRightArithmetic: return static_cast<Word>(as_signed(a) >> (b & 31u));
    case spv::OpBitwiseOr: return a | b;
    case spv::OpBitwiseAnd: return a & b;
    case spv::OpBitwiseXor: return a ^ b;
    default: return compare(op, a, b);
  }
}

std::optional<Word> unary(Word op, Word a) {
  switch (op) {
    case spv::OpSConvert:
    case spv::OpUConvert:
    case spv::OpFConvert: return a;  // between 32 bits and 32 bits
    case spv::OpSNegate: return 0u - a;
    case spv::OpNot:
    case spv::OpLogicalNot: return ~a;
    default: return std::nullopt;
  }
}

std::optional<Words> select(const Words& condition, const Words& yes, const Words& no) {
  if (yes.size() != no.size() || (condition.size() != 1 && condition.size() != yes.size()))
    return std::nullopt;
  Words result;
  for (std::size_t k = 0; k < yes.size(); ++k)
    result.push_back(condition[condition.size() == 1 ? 0 : k] != 0 ? yes[k] : no[k]);
  return result;
}

std::optional<Words> shuffle(const Words& first, const Words& second, std::span<const Word> components) {
  Words both = first, result;
  both.insert(both.end(), second.begin(), second.end());
  for (const Word at : components) result.push_back(at < both.size() ? both[at] : 0);  // all ones: undefined
  return result;
}

/// Every operand has one word or as many as the result.
std::optional<Words> componentwise(Word op, std::span<const Words> in, std::uint32_t scalars) {
  if (in.empty() || in.size() > 2 ||
      std::ranges::any_of(in, [&](const Words& w) { return w.size() != scalars; }))
    return std::nullopt;
  Words result;
  for (std::uint32_t k = 0; k < scalars; ++k) {
    const std::optional<Word> word = in.size() == 1 ? unary(op, in[0][k]) : binary(op, in[0][k], in[1][k]);
    if (!word) return std::nullopt;
    result.push_back(*word);
  }
  return result;
}

bool is_vector(const Module& module, Id id) {
  return module.type(module.constant_type(id)).kind == Type::Kind::kVector;
}

/// Of a vector: elements of other composites take as many words as their types say, which nobody needed yet.
std::optional<Words> extract(const Module& module, Id composite, std::span<const Word> path) {
  const Words& words = *module.constant(composite);
  if (!is_vector(module, composite) || path.size() != 1 || path[0] >= words.size()) return std::nullopt;
  return Words{words[path[0]]};
}
std::optional<Words> insert(const Module& module, Id object, Id composite, std::span<const Word> path) {
  Words words = *module.constant(composite);
  if (!is_vector(module, composite) || path.size() != 1 || path[0] >= words.size()) return std::nullopt;
  words[path[0]] = module.constant(object)->at(0);
  return words;
}

}  // namespace

std::optional<Words> evaluate_spec_constant(const Module& module, std::span<const Word> operands,
                                            std::uint32_t scalars) {
  if (operands.empty()) return std::nullopt;
  const Word op = operands[0];
  const std::span<const Word> after = operands.subspan(1);
  const std::size_t ids = op == spv::OpCompositeExtract                                ? 1
                          : op == spv::OpCompositeInsert || op == spv::OpVectorShuffle ? 2
                                                                                       : after.size();
  if (after.size() < std::max<std::size_t>(1, ids)) return std::nullopt;
  std::vector<Words> in;
  for (const Id id : after.first(ids)) {
    const Words* const words = module.constant(id);
    if (words == nullptr || words->empty()) return std::nullopt;
    in.push_back(*words);
  }
  if (op == spv::OpSelect) return in.size() == 3 ? select(in[0], in[1], in[2]) : std::nullopt;
  if (op == spv::OpVectorShuffle) return shuffle(in[0], in[1], after.subspan(ids));
  if (op == spv::OpCompositeExtract) return extract(module, after[0], after.subspan(ids));
  if (op == spv::OpCompositeInsert) return insert(module, after[0], after[1], after.subspan(ids));
  return componentwise(op, in, scalars);
}

}  // namespace quadrille::pipeline::spirv
