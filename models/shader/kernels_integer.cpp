/// Integer and bitwise operations. Division has no vector form on the host and goes lane by lane; it never
/// traps.
#include "models/shader/kernels.h"

namespace quadrille::models {
namespace {

struct IAdd : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return a + b; }
};
struct ISub : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return a - b; }
};
struct IMul : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_mullo_epi32(a.v, b.v)}; }
};
struct IMin : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_min_epi32(a.v, b.v)}; }
};
struct IMax : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_max_epi32(a.v, b.v)}; }
};
struct UMin : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_min_epu32(a.v, b.v)}; }
};
struct UMax : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_max_epu32(a.v, b.v)}; }
};
struct IAbs : IntegerOperation<1> {
  static Words apply(Words a) { return {_mm256_abs_epi32(a.v)}; }
};
struct ISign : IntegerOperation<1> {
  static Words apply(Words a) { return {_mm256_sign_epi32(splat_word(1).v, a.v)}; }
};
struct And : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return a & b; }
};
struct Or : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return a | b; }
};
struct Xor : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return a ^ b; }
};
struct Not : IntegerOperation<1> {
  static Words apply(Words a) { return ~a; }
};
inline Words shift_count(Words b) { return b & splat_word(31); }
struct Shl : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_sllv_epi32(a.v, shift_count(b).v)}; }
};
struct ShrU : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_srlv_epi32(a.v, shift_count(b).v)}; }
};
struct ShrS : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return {_mm256_srav_epi32(a.v, shift_count(b).v)}; }
};
struct ILt : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return greater_signed(b, a); }
};
struct ILe : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return ~greater_signed(a, b); }
};
struct IEq : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return equal(a, b); }
};
struct INe : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return ~equal(a, b); }
};
/// Unsigned order is signed order with the top bits flipped.
inline Words ordered(Words a) { return a ^ splat_word(0x80000000u); }
struct ULt : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return greater_signed(ordered(b), ordered(a)); }
};
struct ULe : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return ~greater_signed(ordered(a), ordered(b)); }
};

/// Applies a scalar function of two words to eight lanes.
template <class Scalar>
Words lane_by_lane(Words a, Words b, Scalar scalar) {
  alignas(32) std::array<std::uint32_t, kGroupLanes> left, right;
  store(left.data(), a);
  store(right.data(), b);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = scalar(left[i], right[i]);
  return load_words(left.data());
}

/// Quotient and remainder in 64 bits, where INT_MIN / -1 fits; a zero divisor gives all ones and the
/// dividend.
inline std::int64_t widen(std::uint32_t x) { return static_cast<std::int32_t>(x); }
inline std::uint32_t signed_quotient(std::uint32_t a, std::uint32_t b) {
  return b == 0 ? ~0u : static_cast<std::uint32_t>(widen(a) / widen(b));
}
inline std::uint32_t signed_remainder(std::uint32_t a, std::uint32_t b) {
  return b == 0 ? a : static_cast<std::uint32_t>(widen(a) % widen(b));
}
/// The remainder with the sign of the divisor.
inline std::uint32_t signed_modulo(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t r = signed_remainder(a, b);
  const bool differs = b != 0 && r != 0 && ((r ^ b) & 0x80000000u) != 0;
  return differs ? r + b : r;
}
struct IDiv : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return lane_by_lane(a, b, signed_quotient); }
};
struct IRem : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return lane_by_lane(a, b, signed_remainder); }
};
struct IMod : IntegerOperation<2> {
  static Words apply(Words a, Words b) { return lane_by_lane(a, b, signed_modulo); }
};
struct UDiv : IntegerOperation<2> {
  static Words apply(Words a, Words b) {
    return lane_by_lane(a, b, [](std::uint32_t x, std::uint32_t y) { return y == 0 ? ~0u : x / y; });
  }
};
struct UMod : IntegerOperation<2> {
  static Words apply(Words a, Words b) {
    return lane_by_lane(a, b, [](std::uint32_t x, std::uint32_t y) { return y == 0 ? x : x % y; });
  }
};

}  // namespace

Kernel integer_kernel(Op op, const KernelShape& shape) {
  if (op == Op::kIAdd) return kernel_of<IAdd>(shape);
  if (op == Op::kISub) return kernel_of<ISub>(shape);
  if (op == Op::kIMul) return kernel_of<IMul>(shape);
  if (op == Op::kIDiv) return kernel_of<IDiv>(shape);
  if (op == Op::kIMod) return kernel_of<IMod>(shape);
  if (op == Op::kIRem) return kernel_of<IRem>(shape);
  if (op == Op::kUDiv) return kernel_of<UDiv>(shape);
  if (op == Op::kUMod) return kernel_of<UMod>(shape);
  if (op == Op::kIMin) return kernel_of<IMin>(shape);
  if (op == Op::kIMax) return kernel_of<IMax>(shape);
  if (op == Op::kUMin) return kernel_of<UMin>(shape);
  if (op == Op::kUMax) return kernel_of<UMax>(shape);
  if (op == Op::kIAbs) return kernel_of<IAbs>(shape);
  if (op == Op::kISign) return kernel_of<ISign>(shape);
  if (op == Op::kAnd) return kernel_of<And>(shape);
  if (op == Op::kOr) return kernel_of<Or>(shape);
  if (op == Op::kXor) return kernel_of<Xor>(shape);
  if (op == Op::kNot) return kernel_of<Not>(shape);
  if (op == Op::kShl) return kernel_of<Shl>(shape);
  if (op == Op::kShrU) return kernel_of<ShrU>(shape);
  if (op == Op::kShrS) return kernel_of<ShrS>(shape);
  if (op == Op::kILt) return kernel_of<ILt>(shape);
  if (op == Op::kILe) return kernel_of<ILe>(shape);
  if (op == Op::kIEq) return kernel_of<IEq>(shape);
  if (op == Op::kINe) return kernel_of<INe>(shape);
  if (op == Op::kULt) return kernel_of<ULt>(shape);
  if (op == Op::kULe) return kernel_of<ULe>(shape);
  return {};
}

}  // namespace quadrille::models
