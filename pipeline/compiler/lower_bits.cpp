/// Operations on the bits of integers, of shifts and masks: the machine has none of its own.
/// [VK1.3, SPIR-V #BitInstructions]
#include "pipeline/compiler/lowering.h"

namespace quadrille::pipeline {
namespace {

using models::Op;

/// Emits them, word by word. Shifts take the low five bits of their distance.
class Bits {
 public:
  explicit Bits(ScalarBuilder& build) : b_(build) {}

  /// Sums of two, four and eight bits, and then all of them.
  Value count(Value x) {
    x = b_.emit(Op::kISub, x, masked(b_.emit(Op::kShrU, x, literal(1u)), 0x55555555u));
    x = b_.emit(Op::kIAdd, masked(x, 0x33333333u), masked(b_.emit(Op::kShrU, x, literal(2u)), 0x33333333u));
    x = masked(b_.emit(Op::kIAdd, x, b_.emit(Op::kShrU, x, literal(4u))), 0x0f0f0f0fu);
    return b_.emit(Op::kShrU, b_.emit(Op::kIMul, x, literal(0x01010101u)), literal(24u));
  }

  /// Neighbours change places: bits, pairs, and so on up to halves.
  Value reverse(Value x) {
    x = exchange(x, 1, 0x55555555u);
    x = exchange(x, 2, 0x33333333u);
    x = exchange(x, 4, 0x0f0f0f0fu);
    x = exchange(x, 8, 0x00ff00ffu);
    return exchange(x, 16, 0x0000ffffu);
  }

  Value extract_unsigned(Value x, Value offset, Value bits) {
    return b_.emit(Op::kAnd, b_.emit(Op::kShrU, x, offset), low_bits(bits));
  }

  Value extract_signed(Value x, Value offset, Value bits) {
    const Value above = b_.emit(Op::kISub, literal(32u), bits);
    const Value high = b_.emit(Op::kShl, x, b_.emit(Op::kISub, above, offset));
    return b_.emit(Op::kAnd, b_.emit(Op::kShrS, high, above), some(bits));
  }

  Value insert(Value x, Value inserted, Value offset, Value bits) {
    const Value place = b_.emit(Op::kShl, low_bits(bits), offset);
    const Value kept = b_.emit(Op::kAnd, x, b_.emit(Op::kNot, place));
    return b_.emit(Op::kOr, kept, b_.emit(Op::kAnd, b_.emit(Op::kShl, inserted, offset), place));
  }

 private:
  Value masked(Value x, std::uint32_t mask) { return b_.emit(Op::kAnd, x, literal(mask)); }
  Value exchange(Value x, std::uint32_t distance, std::uint32_t low) {
    const Value up = b_.emit(Op::kShl, masked(x, low), literal(distance));
    return b_.emit(Op::kOr, up, masked(b_.emit(Op::kShrU, x, literal(distance)), low));
  }
  /// All ones where there is a bit at all.
  Value some(Value bits) { return b_.emit(Op::kINe, bits, literal(0u)); }
  Value low_bits(Value bits) {
    const Value ones = b_.emit(Op::kShrU, literal(~0u), b_.emit(Op::kISub, literal(32u), bits));
    return b_.emit(Op::kAnd, ones, some(bits));
  }

  ScalarBuilder& b_;
};

}  // namespace

bool Lowering::bit_operation(const spirv::Instruction& i) {
  Bits bits(build_);
  const auto each = [&](auto&& function) {
    const Values words = value(i.operands[0]);
    Values result;
    for (std::size_t k = 0; k < words.size(); ++k) result.push_back(function(words[k], k));
    define(i, std::move(result));
    return true;
  };
  const auto number = [&](std::size_t operand) { return value(i.operands[operand])[0]; };
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpBitCount: return each([&](Value x, std::size_t) { return bits.count(x); });
    case spv::OpBitReverse: return each([&](Value x, std::size_t) { return bits.reverse(x); });
    case spv::OpBitFieldUExtract:
      return each([&](Value x, std::size_t) { return bits.extract_unsigned(x, number(1), number(2)); });
    case spv::OpBitFieldSExtract:
      return each([&](Value x, std::size_t) { return bits.extract_signed(x, number(1), number(2)); });
    case spv::OpBitFieldInsert:
      return each([&](Value x, std::size_t k) {
        return bits.insert(x, value(i.operands[1])[k], number(2), number(3));
      });
    default: return false;
  }
}

}  // namespace quadrille::pipeline
