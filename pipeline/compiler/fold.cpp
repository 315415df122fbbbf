#include "pipeline/compiler/fold.h"

#include <bit>
#include <cmath>
#include <limits>

namespace quadrille::pipeline {
namespace {

using models::Op;
using Folded = std::optional<std::uint32_t>;

float f(std::uint32_t bits) { return std::bit_cast<float>(bits); }
std::uint32_t u(float value) { return std::bit_cast<std::uint32_t>(value); }
std::uint32_t mask(bool value) { return value ? 0xffffffffu : 0u; }
std::int32_t s(std::uint32_t bits) { return static_cast<std::int32_t>(bits); }
std::uint32_t w(std::int64_t value) { return static_cast<std::uint32_t>(value); }

/// Results that are NaN or denormal are left to the machine, so that its rules for them are written in one
/// place.
Folded plain(float value) {
  if (std::isnan(value) || (value != 0 && std::abs(value) < std::numeric_limits<float>::min()))
    return std::nullopt;
  return u(value);
}

Folded fold_float(Op op, float a, float b, float c) {
  if (std::isnan(a) || std::isnan(b) || std::isnan(c)) return std::nullopt;
  switch (static_cast<int>(op)) {
    case static_cast<int>(Op::kFAdd): return plain(a + b);
    case static_cast<int>(Op::kFMul): return plain(a * b);
    case static_cast<int>(Op::kFMad): {
      const float product = a * b;
      return plain(product + c);
    }
    case static_cast<int>(Op::kFMin): return a == b ? Folded{} : plain(a < b ? a : b);
    case static_cast<int>(Op::kFMax): return a == b ? Folded{} : plain(a > b ? a : b);
    case static_cast<int>(Op::kFFloor): return plain(std::floor(a));
    case static_cast<int>(Op::kFCeil): return plain(std::ceil(a));
    case static_cast<int>(Op::kFTrunc): return plain(std::trunc(a));
    case static_cast<int>(Op::kFDiv): return b == 0 ? Folded{} : plain(a / b);
    case static_cast<int>(Op::kFSqrt): return plain(std::sqrt(a));
    case static_cast<int>(Op::kFLt): return mask(a < b);
    case static_cast<int>(Op::kFLe): return mask(a <= b);
    case static_cast<int>(Op::kFEq): return mask(a == b);
    case static_cast<int>(Op::kFNe): return mask(a != b);
    default: return std::nullopt;
  }
}

Folded fold_integer(Op op, std::uint32_t a, std::uint32_t b) {
  switch (static_cast<int>(op)) {
    case static_cast<int>(Op::kIAdd): return a + b;
    case static_cast<int>(Op::kISub): return a - b;
    case static_cast<int>(Op::kIMul): return a * b;
    case static_cast<int>(Op::kUDiv): return b == 0 ? Folded{} : Folded{a / b};
    case static_cast<int>(Op::kUMod): return b == 0 ? Folded{} : Folded{a % b};
    case static_cast<int>(Op::kIDiv): return b == 0 ? Folded{} : Folded{w(std::int64_t{s(a)} / s(b))};
    case static_cast<int>(Op::kIMin): return s(a) < s(b) ? a : b;
    case static_cast<int>(Op::kIMax): return s(a) > s(b) ? a : b;
    case static_cast<int>(Op::kUMin): return a < b ? a : b;
    case static_cast<int>(Op::kUMax): return a > b ? a : b;
    case static_cast<int>(Op::kAnd): return a & b;
    case static_cast<int>(Op::kOr): return a | b;
    case static_cast<int>(Op::kXor): return a ^ b;
    case static_cast<int>(Op::kNot): return ~a;
    case static_cast<int>(Op::kShl): return a << (b & 31u);
    case static_cast<int>(Op::kShrU): return a >> (b & 31u);
    case static_cast<int>(Op::kShrS): return w(s(a) >> (b & 31u));
    case static_cast<int>(Op::kILt): return mask(s(a) < s(b));
    case static_cast<int>(Op::kILe): return mask(s(a) <= s(b));
    case static_cast<int>(Op::kIEq): return mask(a == b);
    case static_cast<int>(Op::kINe): return mask(a != b);
    case static_cast<int>(Op::kULt): return mask(a < b);
    case static_cast<int>(Op::kULe): return mask(a <= b);
    case static_cast<int>(Op::kI2F): return u(static_cast<float>(s(a)));
    case static_cast<int>(Op::kU2F): return u(static_cast<float>(a));
    default: return std::nullopt;
  }
}

}  // namespace

Folded fold(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (op == Op::kSelect) return a != 0 ? b : c;
  if (op >= Op::kFAdd && op <= Op::kFNe) return fold_float(op, f(a), f(b), f(c));
  return fold_integer(op, a, b);
}

}  // namespace quadrille::pipeline
