/// The scalar ruler.
#include "tests/models/shader/scalar_model.h"

#include "tests/models/shader/warp_fixture.h"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace quadrille::models::test {
namespace {

std::uint32_t truth(bool holds) { return holds ? ~0u : 0u; }
std::int32_t sint(std::uint32_t x) { return static_cast<std::int32_t>(x); }
std::uint32_t uint(std::int64_t x) { return static_cast<std::uint32_t>(x); }

std::uint32_t to_int(float x) {
  if (std::isnan(x)) return 0;
  if (x >= 2147483648.0f) return 0x7fffffffu;
  if (x <= -2147483648.0f) return 0x80000000u;
  return uint(static_cast<std::int32_t>(x));
}
std::uint32_t to_uint(float x) {
  if (std::isnan(x) || x <= 0) return 0;
  if (x >= 4294967296.0f) return ~0u;
  return static_cast<std::uint32_t>(x);
}

float floats(Op op, float x, float y, float z) {
  if (op == Op::kFAdd) return x + y;
  if (op == Op::kFMul) return x * y;
  if (op == Op::kFMad) {
    const volatile float product = x * y;
    return product + z;
  }
  if (op == Op::kFma) return std::fma(x, y, z);
  if (op == Op::kFMin) return std::isnan(y) ? x : x < y ? x : y;
  if (op == Op::kFMax) return std::isnan(y) ? x : x > y ? x : y;
  if (op == Op::kFFloor) return std::floor(x);
  if (op == Op::kFCeil) return std::ceil(x);
  if (op == Op::kFTrunc) return std::trunc(x);
  if (op == Op::kFRoundEven) return std::nearbyint(x);
  if (op == Op::kFFract) return x - std::floor(x);
  if (op == Op::kFSign) return x > 0 ? 1.0f : x < 0 ? -1.0f : 0.0f;
  if (op == Op::kFDiv) return x / y;
  if (op == Op::kFRcp) return 1.0f / x;
  if (op == Op::kFRsq) return 1.0f / std::sqrt(x);
  if (op == Op::kFSqrt) return std::sqrt(x);
  if (op == Op::kFExp2) return static_cast<float>(std::exp2(static_cast<double>(x)));
  if (op == Op::kFLog2) return static_cast<float>(std::log2(static_cast<double>(x)));
  const double angle = std::fabs(x) >= 0x1p40f && std::isfinite(x) ? 0.0 : static_cast<double>(x);
  if (op == Op::kFSin) return static_cast<float>(std::sin(angle));
  return static_cast<float>(std::cos(angle));
}

std::uint32_t comparison(Op op, float x, float y) {
  if (op == Op::kFLt) return truth(x < y);
  if (op == Op::kFLe) return truth(x <= y);
  if (op == Op::kFEq) return truth(x == y);
  return truth(!(x == y));
}

std::uint32_t division(Op op, std::uint32_t a, std::uint32_t b) {
  const std::int64_t x = sint(a), y = sint(b);
  if (op == Op::kUDiv) return b == 0 ? ~0u : a / b;
  if (op == Op::kUMod) return b == 0 ? a : a % b;
  if (op == Op::kIDiv) return b == 0 ? ~0u : uint(x / y);
  if (op == Op::kIRem) return b == 0 ? a : uint(x % y);
  return b == 0 ? a
                : uint(x - y * static_cast<std::int64_t>(
                                   std::floor(static_cast<double>(x) / static_cast<double>(y))));
}

std::uint32_t integers(Op op, std::uint32_t a, std::uint32_t b) {
  if (op == Op::kIAdd) return a + b;
  if (op == Op::kISub) return a - b;
  if (op == Op::kIMul) return a * b;
  if (op == Op::kIMin) return sint(a) < sint(b) ? a : b;
  if (op == Op::kIMax) return sint(a) > sint(b) ? a : b;
  if (op == Op::kUMin) return a < b ? a : b;
  if (op == Op::kUMax) return a > b ? a : b;
  if (op == Op::kIAbs) return sint(a) < 0 ? 0u - a : a;
  if (op == Op::kISign) return uint(sint(a) > 0 ? 1 : sint(a) < 0 ? -1 : 0);
  if (op == Op::kAnd) return a & b;
  if (op == Op::kOr) return a | b;
  if (op == Op::kXor) return a ^ b;
  if (op == Op::kNot) return ~a;
  if (op == Op::kShl) return a << (b % 32);
  if (op == Op::kShrU) return a >> (b % 32);
  if (op == Op::kShrS) return uint(sint(a) >> (b % 32));
  if (op == Op::kILt) return truth(sint(a) < sint(b));
  if (op == Op::kILe) return truth(sint(a) <= sint(b));
  if (op == Op::kIEq) return truth(a == b);
  if (op == Op::kINe) return truth(a != b);
  if (op == Op::kULt) return truth(a < b);
  return truth(a <= b);
}

}  // namespace

bool has_scalar_model(Op op) { return op >= Op::kMov && op <= Op::kSelect; }

bool has_float_result(Op op) {
  return (op >= Op::kMov && op <= Op::kFCos) || op == Op::kI2F || op == Op::kU2F || op == Op::kSelect;
}

int allowed_ulps(Op op) {
  if (op == Op::kFExp2 || op == Op::kFLog2) return 1;
  return op == Op::kFSin || op == Op::kFCos ? 2 : 0;
}

std::uint32_t scalar_result(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const float x = as_float(a), y = as_float(b), z = as_float(c);
  if (op == Op::kMov) return a;
  if (op == Op::kSelect) return a != 0 ? b : c;
  if (op >= Op::kFAdd && op <= Op::kFCos) return bits_of(floats(op, x, y, z));
  if (op >= Op::kFLt && op <= Op::kFNe) return comparison(op, x, y);
  if (op >= Op::kIDiv && op <= Op::kUMod) return division(op, a, b);
  if (op == Op::kF2I) return to_int(x);
  if (op == Op::kF2U) return to_uint(x);
  if (op == Op::kI2F) return bits_of(static_cast<float>(sint(a)));
  if (op == Op::kU2F) return bits_of(static_cast<float>(a));
  return integers(op, a, b);
}

std::uint32_t scalar_modified(std::uint32_t bits, std::uint8_t modifiers) {
  if ((modifiers & Operand::kAbsolute) != 0) bits &= 0x7fffffffu;
  if ((modifiers & Operand::kNegate) != 0) bits ^= 0x80000000u;
  return bits;
}

std::uint32_t scalar_saturated(std::uint32_t bits) {
  const float x = as_float(bits);
  return bits_of(!(x > 0) ? 0.0f : x > 1 ? 1.0f : x);
}

std::int64_t ulps_between(std::uint32_t a, std::uint32_t b) {
  if (is_nan(a) || is_nan(b)) return is_nan(a) && is_nan(b) ? 0 : std::numeric_limits<std::int64_t>::max();
  const auto ordinal = [](std::uint32_t x) {
    return (x & 0x80000000u) != 0 ? -static_cast<std::int64_t>(x & 0x7fffffffu)
                                  : static_cast<std::int64_t>(x);
  };
  return std::abs(ordinal(a) - ordinal(b));
}

}  // namespace quadrille::models::test
