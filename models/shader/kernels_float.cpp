/// Float operations at full rate, comparisons, conversions, derivatives, and the moves that treat bits as
/// floats.
#include "models/shader/kernels.h"

namespace quadrille::models {
namespace {

struct Mov : FloatOperation<1> {
  static Words apply(Words a) { return a; }
};
struct FAdd : FloatOperation<2> {
  static Floats apply(Floats a, Floats b) { return ordered_add(a, b); }
};
struct FMul : FloatOperation<2> {
  static Floats apply(Floats a, Floats b) { return ordered_multiply(a, b); }
};
struct FMad : FloatOperation<3> {
  static Floats apply(Floats a, Floats b, Floats c) { return ordered_add(ordered_multiply(a, b), c); }
};
struct Fma : FloatOperation<3> {
  static Floats apply(Floats a, Floats b, Floats c) { return ordered_fused(a, b, c); }
};
/// The machine instruction gives its second operand when either is NaN; that is right but for a NaN in the
/// second.
struct FMin : FloatOperation<2> {
  static Lanes apply(Floats a, Floats b) {
    return choose(compare<_CMP_UNORD_Q>(b, b), a, Floats{_mm256_min_ps(a.v, b.v)});
  }
};
struct FMax : FloatOperation<2> {
  static Lanes apply(Floats a, Floats b) {
    return choose(compare<_CMP_UNORD_Q>(b, b), a, Floats{_mm256_max_ps(a.v, b.v)});
  }
};
template <int kRounding>
struct FRound : FloatOperation<1> {
  static Floats apply(Floats a) { return round_to<kRounding>(a); }
};
struct FFract : FloatOperation<1> {
  static Floats apply(Floats a) { return a - round_to<_MM_FROUND_TO_NEG_INF>(a); }
};
struct FSign : FloatOperation<1> {
  static Words apply(Floats a) {
    const Words one = as_words(splat(1.0f)), minus_one = as_words(splat(-1.0f));
    return (compare<_CMP_GT_OQ>(a, splat(0.0f)) & one) | (compare<_CMP_LT_OQ>(a, splat(0.0f)) & minus_one);
  }
};

template <int kPredicate>
struct FCompare : FloatTest<2> {
  static Words apply(Floats a, Floats b) { return compare<kPredicate>(a, b); }
};

/// Truncation saturates; the machine instruction gives 0x80000000 outside the range.
struct F2I : FloatTest<1> {
  static Words apply(Floats a) {
    const Words value = to_integers(a);
    const Words too_large = compare<_CMP_GE_OQ>(a, splat(0x1p31f));
    const Words ordered = compare<_CMP_ORD_Q>(a, a);
    return static_cast<Words>(choose(too_large, splat_word(0x7fffffffu), value)) & ordered;
  }
};
struct F2U : FloatTest<1> {
  static Words apply(Floats a) {
    const Words positive = compare<_CMP_GT_OQ>(a, splat(0.0f));  // false on NaN
    const Words high = compare<_CMP_GE_OQ>(a, splat(0x1p31f));
    const Words too_large = compare<_CMP_GE_OQ>(a, splat(0x1p32f));
    const Words upper = to_integers(a - splat(0x1p31f)) ^ splat_word(0x80000000u);
    const Words value = choose(high, upper, to_integers(a));
    return (value | too_large) & positive;
  }
};

struct ToFloat {
  static constexpr int kSources = 1;
  // the checker allows no modifier; the shape index needs its place
  static constexpr bool kModifiable = true, kSaturable = true;
};
struct I2F : ToFloat {
  static Floats apply(Words a) { return to_floats(a); }
};
/// Both halves convert exactly and their sum is rounded once.
struct U2F : ToFloat {
  static Floats apply(Words a) {
    return to_floats(shift_right<16>(a)) * splat(65536.0f) + to_floats(a & splat_word(0xffffu));
  }
};

struct Select : FloatOperation<3> {
  static Lanes apply(Words a, Lanes b, Lanes c) { return choose(equal(a, splat_word(0)), c, b); }
};

/// Differences inside each 128-bit half, which is a quad: (0,0) (1,0) (0,1) (1,1).
template <int kFrom, int kTo>
struct Derivative : FloatOperation<1> {
  static Floats apply(Floats a) {
    return Floats{_mm256_permute_ps(a.v, kTo)} - Floats{_mm256_permute_ps(a.v, kFrom)};
  }
};
using DdxFine = Derivative<_MM_SHUFFLE(2, 2, 0, 0), _MM_SHUFFLE(3, 3, 1, 1)>;
using DdyFine = Derivative<_MM_SHUFFLE(1, 0, 1, 0), _MM_SHUFFLE(3, 2, 3, 2)>;
using DdxCoarse = Derivative<_MM_SHUFFLE(0, 0, 0, 0), _MM_SHUFFLE(1, 1, 1, 1)>;
using DdyCoarse = Derivative<_MM_SHUFFLE(0, 0, 0, 0), _MM_SHUFFLE(2, 2, 2, 2)>;

}  // namespace

Kernel float_kernel(Op op, const KernelShape& shape) {
  if (op == Op::kMov) return kernel_of<Mov>(shape);
  if (op == Op::kFAdd) return kernel_of<FAdd>(shape);
  if (op == Op::kFMul) return kernel_of<FMul>(shape);
  if (op == Op::kFMad) return kernel_of<FMad>(shape);
  if (op == Op::kFma) return kernel_of<Fma>(shape);
  if (op == Op::kFMin) return kernel_of<FMin>(shape);
  if (op == Op::kFMax) return kernel_of<FMax>(shape);
  if (op == Op::kFFloor) return kernel_of<FRound<_MM_FROUND_TO_NEG_INF>>(shape);
  if (op == Op::kFCeil) return kernel_of<FRound<_MM_FROUND_TO_POS_INF>>(shape);
  if (op == Op::kFTrunc) return kernel_of<FRound<_MM_FROUND_TO_ZERO>>(shape);
  if (op == Op::kFRoundEven) return kernel_of<FRound<_MM_FROUND_TO_NEAREST_INT>>(shape);
  if (op == Op::kFFract) return kernel_of<FFract>(shape);
  if (op == Op::kFSign) return kernel_of<FSign>(shape);
  if (op == Op::kFLt) return kernel_of<FCompare<_CMP_LT_OQ>>(shape);
  if (op == Op::kFLe) return kernel_of<FCompare<_CMP_LE_OQ>>(shape);
  if (op == Op::kFEq) return kernel_of<FCompare<_CMP_EQ_OQ>>(shape);
  if (op == Op::kFNe) return kernel_of<FCompare<_CMP_NEQ_UQ>>(shape);
  if (op == Op::kF2I) return kernel_of<F2I>(shape);
  if (op == Op::kF2U) return kernel_of<F2U>(shape);
  if (op == Op::kI2F) return kernel_of<I2F>(shape);
  if (op == Op::kU2F) return kernel_of<U2F>(shape);
  if (op == Op::kSelect) return kernel_of<Select>(shape);
  if (op == Op::kDdxFine) return kernel_of<DdxFine>(shape);
  if (op == Op::kDdyFine) return kernel_of<DdyFine>(shape);
  if (op == Op::kDdxCoarse) return kernel_of<DdxCoarse>(shape);
  if (op == Op::kDdyCoarse) return kernel_of<DdyCoarse>(shape);
  return {};
}

}  // namespace quadrille::models
