/// GLSL.std.450: the built-in functions, expanded to ISA operations. The formulas and their grouping are
/// those of Mesa's SPIR-V reader. [Mesa vtn_glsl450]
#include "pipeline/compiler/lowering.h"
#include "pipeline/compiler/spirv_names.h"

#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille::pipeline {
namespace {

using models::Op;

constexpr float kPi = 3.14159265358979323846f;
constexpr float kHalfPi = 1.57079632679489661923f;
constexpr float kQuarterPi = 0.78539816339744830962f;
constexpr float kLog2E = 1.44269504088896340736f;
constexpr float kLn2 = 0.69314718055994530942f;
constexpr float kOne = 1.0f;

struct Direct {
  int function;
  Op op;
};
/// Functions that are one operation a component.
constexpr auto kDirect = std::to_array<Direct>({
    {GLSLstd450Round, Op::kFRoundEven}, {GLSLstd450RoundEven, Op::kFRoundEven},
    {GLSLstd450Trunc, Op::kFTrunc},     {GLSLstd450SAbs, Op::kIAbs},
    {GLSLstd450FSign, Op::kFSign},      {GLSLstd450SSign, Op::kISign},
    {GLSLstd450Floor, Op::kFFloor},     {GLSLstd450Ceil, Op::kFCeil},
    {GLSLstd450Fract, Op::kFFract},     {GLSLstd450Sin, Op::kFSin},
    {GLSLstd450Cos, Op::kFCos},         {GLSLstd450Exp2, Op::kFExp2},
    {GLSLstd450Log2, Op::kFLog2},       {GLSLstd450Sqrt, Op::kFSqrt},
    {GLSLstd450InverseSqrt, Op::kFRsq}, {GLSLstd450FMin, Op::kFMin},
    {GLSLstd450NMin, Op::kFMin},        {GLSLstd450UMin, Op::kUMin},
    {GLSLstd450SMin, Op::kIMin},        {GLSLstd450FMax, Op::kFMax},
    {GLSLstd450NMax, Op::kFMax},        {GLSLstd450UMax, Op::kUMax},
    {GLSLstd450SMax, Op::kIMax},
});

/// One component of a built-in function.
class Functions {
 public:
  explicit Functions(ScalarBuilder& build) : b_(build) {}

  Value lit(float v) const { return literal(v); }
  Value exp(Value x) { return b_.emit(Op::kFExp2, b_.fmul(x, lit(kLog2E))); }
  Value log(Value x) { return b_.fmul(b_.emit(Op::kFLog2, x), lit(kLn2)); }
  Value sqrt(Value x) { return b_.emit(Op::kFSqrt, x); }
  Value sign(Value x) { return b_.emit(Op::kFSign, x); }
  Value less(Value a, Value b) { return b_.emit(Op::kFLt, a, b); }
  Value zero_one(Value condition) { return b_.select(condition, lit(kOne), lit(0.0f)); }

  Value pow(Value x, Value y) {
    if (y.is_literal(lit(1.0f).bits)) return x;
    if (y.is_literal(lit(2.0f).bits)) return b_.fmul(x, x);
    if (y.is_literal(lit(4.0f).bits)) {
      const Value square = b_.fmul(x, x);
      return b_.fmul(square, square);
    }
    if (x.is_literal(lit(2.0f).bits)) return b_.emit(Op::kFExp2, y);
    return b_.emit(Op::kFExp2, b_.fmul(b_.emit(Op::kFLog2, x), y));
  }
  /// Mesa's polynomial, of which acos is made.
  Value rough_asin(Value x, float p0, float p1) {
    const Value a = b_.fabs(x);
    const Value inner = b_.fmad(a, lit(p1), lit(p0));
    const Value tail = b_.fmad(a, b_.fmad(a, inner, lit(kQuarterPi - 1.0f)), lit(kHalfPi));
    return b_.fmul(sign(x), b_.fsub(lit(kHalfPi), b_.fmul(sqrt(b_.fsub(lit(kOne), a)), tail)));
  }
  /// Up to a half r + r z P(z) with z = r r; beyond it by the half angle, asin(a) = pi/2 - 2 asin(sqrt((1 -
  /// a) / 2)). Within 2 units in the last place: an error that does not shrink with x would add up where
  /// results are fed back. P is a fit at Chebyshev's nodes of z in [0, 1/4].
  Value asin(Value x) {
    constexpr std::array<float, 5> kTerms{0.16666673f, 0.07498809f, 0.0450107f, 0.026494281f, 0.038206443f};
    const Value a = b_.fabs(x), half = lit(0.5f), small = less(a, half);
    const Value z = b_.select(small, b_.fmul(a, a), b_.fmul(b_.fsub(lit(kOne), a), half));
    const Value r = b_.select(small, a, sqrt(z));
    Value sum = lit(kTerms.back());
    for (std::size_t k = kTerms.size() - 1; k-- > 0;) sum = b_.fmad(sum, z, lit(kTerms[k]));
    const Value arc = b_.fmad(b_.fmul(r, z), sum, r);
    return b_.fmul(sign(x), b_.select(small, arc, b_.fmad(arc, lit(-2.0f), lit(kHalfPi))));
  }
  Value atan(Value y_over_x) {
    constexpr std::array<float, 6> kTerms{0.9999793128310355f,  -0.3326756418091246f, 0.1938924977115610f,
                                          -0.1173503194786851f, 0.0536813784310406f,  -0.0121323213173444f};
    const Value a = b_.fabs(y_over_x), one = lit(kOne);
    const Value x = b_.fdiv(b_.fmin(a, one), b_.fmax(a, one));
    const Value square = b_.fmul(x, x);
    Value power = x, sum = b_.fmul(x, lit(kTerms[0]));
    for (std::size_t k = 1; k < kTerms.size(); ++k) {
      power = k == 1 ? b_.fmul(square, x) : b_.fmul(power, square);
      sum = b_.fadd(sum, b_.fmul(power, lit(kTerms[k])));
    }
    sum = b_.fadd(sum, b_.fmul(zero_one(less(one, a)), b_.fmad(sum, lit(-2.0f), lit(kHalfPi))));
    return b_.fmul(sum, sign(y_over_x));
  }
  Value atan2(Value y, Value x) {
    const Value flip = b_.emit(Op::kFLe, x, lit(0.0f));
    const Value s = b_.select(flip, b_.fabs(x), y), t = b_.select(flip, y, b_.fabs(x));
    const Value scale = b_.select(b_.emit(Op::kFLe, lit(1e18f), b_.fabs(t)), lit(0.25f), lit(kOne));
    const Value reciprocal = b_.emit(Op::kFRcp, b_.fmul(t, scale));
    const Value s_over_t = b_.fmul(b_.fmul(s, scale), reciprocal);
    const Value tangent = b_.select(b_.emit(Op::kFEq, b_.fabs(x), b_.fabs(y)), lit(kOne), b_.fabs(s_over_t));
    const Value arc = b_.fadd(b_.fmul(zero_one(flip), lit(kHalfPi)), atan(tangent));
    return b_.select(less(b_.fmin(y, reciprocal), lit(0.0f)), b_.fneg(arc), arc);
  }
  Value tanh(Value x) {
    const Value e = exp(b_.fmul(b_.fmin(x, lit(10.0f)), lit(2.0f)));
    return b_.fdiv(b_.fsub(e, lit(kOne)), b_.fadd(e, lit(kOne)));
  }
  Value asinh(Value x) { return b_.fmul(sign(x), log(b_.fadd(b_.fabs(x), sqrt(b_.fmad(x, x, lit(kOne)))))); }
  Value smoothstep(Value low, Value high, Value x) {
    const Value t = b_.fclamp(b_.fdiv(b_.fsub(x, low), b_.fsub(high, low)), lit(0.0f), lit(kOne));
    return b_.fmul(t, b_.fmul(t, b_.fsub(lit(3.0f), b_.fmul(lit(2.0f), t))));
  }
  /// x (1 - t) + y t; a constant x of one (or minus one) is expanded as (y t - t) + 1.
  Value mix(Value x, Value y, Value t, bool all_one, bool all_minus_one) {
    if (all_one) return b_.fadd(b_.fsub(b_.fmul(y, t), t), x);
    if (all_minus_one) return b_.fadd(b_.fadd(b_.fmul(y, t), t), x);
    return b_.fadd(b_.fmul(x, b_.fsub(lit(kOne), t)), b_.fmul(y, t));
  }
  /// x 2^e, as two exact scalings so that e may exceed the exponent range.
  Value ldexp(Value x, Value e) {
    e = b_.emit(Op::kIMin, b_.emit(Op::kIMax, e, literal(static_cast<std::uint32_t>(-252))), literal(254u));
    const Value half = b_.emit(Op::kShrS, e, literal(1u));
    const auto power = [&](Value k) { return b_.emit(Op::kShl, b_.iadd(k, literal(127u)), literal(23u)); };
    return b_.fmul(b_.fmul(x, power(half)), power(b_.emit(Op::kISub, e, half)));
  }
  /// Fraction and whole part, both with the sign of x.
  std::pair<Value, Value> modf(Value x) {
    return {b_.fmul(sign(x), b_.emit(Op::kFFract, b_.fabs(x))),
            b_.fmul(sign(x), b_.emit(Op::kFFloor, b_.fabs(x)))};
  }
  /// Significand in [0.5, 1) and exponent.
  std::pair<Value, Value> frexp(Value x) {
    const Value magnitude = b_.emit(Op::kAnd, x, literal(0x7fffffffu)),
                is_zero = b_.emit(Op::kFEq, b_.fabs(x), lit(0.0f));
    const Value exponent =
        b_.iadd(b_.emit(Op::kShrU, magnitude, literal(23u)),
                b_.select(is_zero, literal(0u), literal(static_cast<std::uint32_t>(-126))));
    const Value significand = b_.emit(Op::kOr, b_.emit(Op::kAnd, x, literal(0x807fffffu)),
                                      b_.select(is_zero, literal(0u), literal(0x3f000000u)));
    return {significand, exponent};
  }
  /// Number of the only bit that is set: the exponent of its float. `none` where no bit is.
  Value bit_number(Value bit) {
    const Value exponent = b_.emit(Op::kShrU, b_.emit(Op::kU2F, bit), literal(23u));
    return b_.select(b_.emit(Op::kIEq, bit, literal(0u)), literal(0xffffffffu),
                     b_.iadd(exponent, literal(static_cast<std::uint32_t>(-127))));
  }
  Value find_lowest(Value x) { return bit_number(b_.emit(Op::kAnd, x, b_.emit(Op::kISub, literal(0u), x))); }
  /// Without the bit below the highest one, rounding to a float cannot carry into the next exponent; the bits
  /// below only change the significand.
  Value find_highest(Value x) {
    return bit_number(b_.emit(Op::kAnd, x, b_.emit(Op::kNot, b_.emit(Op::kShrU, x, literal(1u)))));
  }
  Value find_highest_signed(Value x) {
    return find_highest(b_.emit(Op::kXor, x, b_.emit(Op::kShrS, x, literal(31u))));
  }

  /// Nearest half float, to even; its 16 bits.
  Value to_half(Value x) {
    const Value magnitude = b_.emit(Op::kAnd, x, literal(0x7fffffffu));
    const Value sign_bit = b_.emit(Op::kAnd, b_.emit(Op::kShrU, x, literal(16u)), literal(0x8000u));
    const Value special =
        b_.select(b_.emit(Op::kULt, literal(0x7f800000u), magnitude), literal(0x7e00u), literal(0x7c00u));
    const Value tiny = b_.emit(Op::kISub, b_.fadd(magnitude, lit(0.5f)), literal(0x3f000000u));
    const Value odd = b_.emit(Op::kAnd, b_.emit(Op::kShrU, magnitude, literal(13u)), literal(1u));
    const Value normal =
        b_.emit(Op::kShrU, b_.iadd(b_.iadd(magnitude, literal(0xc8000fffu)), odd), literal(13u));
    const Value finite = b_.select(b_.emit(Op::kULt, magnitude, literal(0x38800000u)), tiny, normal);
    return b_.emit(Op::kOr, b_.select(b_.emit(Op::kULe, literal(0x47800000u), magnitude), special, finite),
                   sign_bit);
  }
  Value from_half(Value bits) {
    const Value shifted = b_.emit(Op::kShl, b_.emit(Op::kAnd, bits, literal(0x7fffu)), literal(13u));
    const Value exponent = b_.emit(Op::kAnd, shifted, literal(0x0f800000u));
    const Value biased = b_.iadd(shifted, literal(112u << 23));
    const Value special = b_.iadd(biased, literal(112u << 23));
    const Value tiny = b_.fsub(b_.iadd(biased, literal(1u << 23)), literal(113u << 23));
    const Value finite = b_.select(b_.emit(Op::kIEq, exponent, literal(0u)), tiny, biased);
    const Value magnitude = b_.select(b_.emit(Op::kIEq, exponent, literal(0x0f800000u)), special, finite);
    return b_.emit(Op::kOr, magnitude,
                   b_.emit(Op::kShl, b_.emit(Op::kAnd, bits, literal(0x8000u)), literal(16u)));
  }
  /// `bits` wide fields from the least significant end; floats clamped to [-1 or 0, 1] and scaled.
  Value pack_norm(const Values& v, std::uint32_t bits, bool is_signed) {
    const float scale = static_cast<float>((1u << (is_signed ? bits - 1 : bits)) - 1);
    Value word = literal(0u);
    for (std::uint32_t k = 0; k < v.size(); ++k) {
      const Value clamped = b_.fclamp(v[k], lit(is_signed ? -1.0f : 0.0f), lit(kOne));
      const Value rounded = b_.emit(Op::kFRoundEven, b_.fmul(clamped, lit(scale)));
      const Value field =
          b_.emit(Op::kAnd, b_.emit(is_signed ? Op::kF2I : Op::kF2U, rounded), literal((1u << bits) - 1));
      word = b_.emit(Op::kOr, b_.emit(Op::kShl, field, literal(bits * k)), word);
    }
    return word;
  }
  Values unpack_norm(Value word, std::uint32_t bits, bool is_signed) {
    Values result;
    const float scale = static_cast<float>((1u << (is_signed ? bits - 1 : bits)) - 1);
    for (std::uint32_t k = 0; k < 32 / bits; ++k) {
      const Value top = b_.emit(Op::kShl, word, literal(32 - bits * (k + 1)));
      if (is_signed) {
        const Value v = b_.fdiv(b_.emit(Op::kI2F, b_.emit(Op::kShrS, top, literal(32 - bits))), lit(scale));
        result.push_back(b_.fmin(lit(kOne), b_.fmax(lit(-1.0f), v)));
      } else {
        result.push_back(b_.fdiv(b_.emit(Op::kU2F, b_.emit(Op::kShrU, top, literal(32 - bits))), lit(scale)));
      }
    }
    return result;
  }

 private:
  ScalarBuilder& b_;
};

}  // namespace

void Lowering::glsl450(const spirv::Instruction& i) {
  if (!module_.glsl_imports.contains(i.operands[0]))
    throw unsupported(i, "an extended instruction set other than GLSL.std.450");
  const auto function = static_cast<int>(i.operands[1]);
  if (function == GLSLstd450InterpolateAtCentroid || function == GLSLstd450InterpolateAtSample) {
    spirv::Instruction plain = i;  // one sample a pixel, at its centre
    plain.operands = i.operands.subspan(2, 1);
    return load(plain);
  }
  std::vector<Values> in;
  const bool by_pointer = function == GLSLstd450Modf || function == GLSLstd450Frexp;
  for (const Id id : i.operands.subspan(2, i.operands.size() - 2 - (by_pointer ? 1 : 0))) {
    if (pointers_.contains(id)) throw unsupported(i, spirv::name_of(i));
    in.push_back(value(id));
  }
  if (in.empty()) throw unsupported(i, spirv::name_of(i));
  Functions f(build_);
  auto& b = build_;
  const auto each = [&](auto&& compute) {
    Values result;
    for (std::size_t k = 0; k < in[0].size(); ++k) {
      const auto at = [&](std::size_t n) {
        return n < in.size() ? in[n][std::min(k, in[n].size() - 1)] : Value{};
      };
      result.push_back(compute(at(0), at(1), at(2)));
    }
    define(i, std::move(result));
  };
  const auto scaled = [&](const Values& v, Value by) {
    Values result;
    for (const Value x : v) result.push_back(b.fmul(x, by));
    return result;
  };
  const auto difference = [&](const Values& x, const Values& y) {
    Values result;
    for (std::size_t k = 0; k < x.size(); ++k) result.push_back(b.fsub(x[k], y[k]));
    return result;
  };
  const auto length = [&](const Values& v) { return v.size() == 1 ? b.fabs(v[0]) : f.sqrt(dot(v, v)); };
  if (const auto* found = std::find_if(kDirect.begin(), kDirect.end(),
                                       [&](const Direct& row) { return row.function == function; });
      found != kDirect.end())
    return each([&](Value x, Value y, Value) { return b.emit(found->op, x, y); });
  switch (function) {
    case GLSLstd450FAbs: return each([&](Value x, Value, Value) { return b.fabs(x); });
    case GLSLstd450Radians:
      return each([&](Value x, Value, Value) { return b.fmul(x, f.lit(kPi / 180.0f)); });
    case GLSLstd450Degrees:
      return each([&](Value x, Value, Value) { return b.fmul(x, f.lit(57.29577951308232f)); });
    case GLSLstd450Tan:
      return each([&](Value x, Value, Value) { return b.fdiv(b.emit(Op::kFSin, x), b.emit(Op::kFCos, x)); });
    case GLSLstd450Asin: return each([&](Value x, Value, Value) { return f.asin(x); });
    case GLSLstd450Acos:
      return each([&](Value x, Value, Value) {
        return b.fsub(f.lit(kHalfPi), f.rough_asin(x, 0.08132463f, -0.02363318f));
      });
    case GLSLstd450Atan: return each([&](Value x, Value, Value) { return f.atan(x); });
    case GLSLstd450Atan2: return each([&](Value y, Value x, Value) { return f.atan2(y, x); });
    case GLSLstd450Sinh:
      return each(
          [&](Value x, Value, Value) { return b.fmul(f.lit(0.5f), b.fsub(f.exp(x), f.exp(b.fneg(x)))); });
    case GLSLstd450Cosh:
      return each(
          [&](Value x, Value, Value) { return b.fmul(f.lit(0.5f), b.fadd(f.exp(x), f.exp(b.fneg(x)))); });
    case GLSLstd450Tanh: return each([&](Value x, Value, Value) { return f.tanh(x); });
    case GLSLstd450Asinh: return each([&](Value x, Value, Value) { return f.asinh(x); });
    case GLSLstd450Acosh:
      return each(
          [&](Value x, Value, Value) { return f.log(b.fadd(x, f.sqrt(b.fsub(b.fmul(x, x), f.lit(kOne))))); });
    case GLSLstd450Atanh:
      return each([&](Value x, Value, Value) {
        return b.fmul(f.lit(0.5f), f.log(b.fdiv(b.fadd(f.lit(kOne), x), b.fsub(f.lit(kOne), x))));
      });
    case GLSLstd450Pow: return each([&](Value x, Value y, Value) { return f.pow(x, y); });
    case GLSLstd450Exp: return each([&](Value x, Value, Value) { return f.exp(x); });
    case GLSLstd450Log: return each([&](Value x, Value, Value) { return f.log(x); });
    case GLSLstd450FClamp:
    case GLSLstd450NClamp:
      return each([&](Value x, Value low, Value high) { return b.fclamp(x, low, high); });
    case GLSLstd450UClamp:
      return each(
          [&](Value x, Value low, Value high) { return b.emit(Op::kUMin, b.emit(Op::kUMax, x, low), high); });
    case GLSLstd450SClamp:
      return each(
          [&](Value x, Value low, Value high) { return b.emit(Op::kIMin, b.emit(Op::kIMax, x, low), high); });
    case GLSLstd450FMix: {
      const auto all = [&](float v) {
        return std::all_of(in[0].begin(), in[0].end(), [&](Value x) { return x.is_literal(f.lit(v).bits); });
      };
      const bool one = all(1.0f), minus_one = all(-1.0f);
      return each([&](Value x, Value y, Value t) { return f.mix(x, y, t, one, minus_one); });
    }
    case GLSLstd450Step:
      return each([&](Value edge, Value x, Value) { return f.zero_one(b.emit(Op::kFLe, edge, x)); });
    case GLSLstd450SmoothStep:
      return each([&](Value low, Value high, Value x) { return f.smoothstep(low, high, x); });
    case GLSLstd450Fma: return each([&](Value x, Value y, Value z) { return b.fmad(x, y, z); });
    case GLSLstd450Ldexp: return each([&](Value x, Value e, Value) { return f.ldexp(x, e); });
    case GLSLstd450Modf:
    case GLSLstd450ModfStruct:
    case GLSLstd450Frexp:
    case GLSLstd450FrexpStruct: {
      Values first, second;
      for (const Value x : in[0]) {
        const auto [one, two] =
            function == GLSLstd450Modf || function == GLSLstd450ModfStruct ? f.modf(x) : f.frexp(x);
        first.push_back(one);
        second.push_back(two);
      }
      if (by_pointer) store_values(pointer(i.operands.back(), i), second, i);
      else first.insert(first.end(), second.begin(), second.end());
      return define(i, std::move(first));
    }
    case GLSLstd450Length: return define(i, {length(in[0])});
    case GLSLstd450Distance: return define(i, {length(difference(in[0], in[1]))});
    case GLSLstd450Normalize: {
      if (in[0].size() == 1) return each([&](Value x, Value, Value) { return f.sign(x); });
      return define(i, scaled(in[0], b.emit(Op::kFRsq, dot(in[0], in[0]))));
    }
    case GLSLstd450Cross: {
      const Values &x = in[0], &y = in[1];
      Values result;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t n = (k + 1) % 3, m = (k + 2) % 3;
        result.push_back(b.fsub(b.fmul(x[n], y[m]), b.fmul(x[m], y[n])));
      }
      return define(i, std::move(result));
    }
    case GLSLstd450FaceForward: {
      const Value facing = f.less(dot(in[2], in[1]), f.lit(0.0f));
      return each([&](Value n, Value, Value) { return b.select(facing, n, b.fneg(n)); });
    }
    case GLSLstd450Reflect:
      return define(i, difference(in[0], scaled(scaled(in[1], dot(in[0], in[1])), f.lit(2.0f))));
    case GLSLstd450Refract: {
      const Value n_dot_i = dot(in[1], in[0]), eta = in[2][0];
      const Value k =
          b.fsub(f.lit(kOne), b.fmul(eta, b.fmul(eta, b.fsub(f.lit(kOne), b.fmul(n_dot_i, n_dot_i)))));
      const Value along = b.fadd(b.fmul(eta, n_dot_i), f.sqrt(k));
      const Value total = f.less(k, f.lit(0.0f));
      return each([&](Value incident, Value normal, Value) {
        return b.select(total, f.lit(0.0f), b.fsub(b.fmul(eta, incident), b.fmul(along, normal)));
      });
    }
    case GLSLstd450Determinant:
      return define(i, {determinant(in[0], in[0].size() == 4 ? 2 : in[0].size() == 9 ? 3 : 4)});
    case GLSLstd450MatrixInverse:
      return define(i, inverse(in[0], in[0].size() == 4 ? 2 : in[0].size() == 9 ? 3 : 4));
    case GLSLstd450PackUnorm4x8: return define(i, {f.pack_norm(in[0], 8, false)});
    case GLSLstd450PackSnorm4x8: return define(i, {f.pack_norm(in[0], 8, true)});
    case GLSLstd450PackUnorm2x16: return define(i, {f.pack_norm(in[0], 16, false)});
    case GLSLstd450PackSnorm2x16: return define(i, {f.pack_norm(in[0], 16, true)});
    case GLSLstd450UnpackUnorm4x8: return define(i, f.unpack_norm(in[0][0], 8, false));
    case GLSLstd450UnpackSnorm4x8: return define(i, f.unpack_norm(in[0][0], 8, true));
    case GLSLstd450UnpackUnorm2x16: return define(i, f.unpack_norm(in[0][0], 16, false));
    case GLSLstd450UnpackSnorm2x16: return define(i, f.unpack_norm(in[0][0], 16, true));
    case GLSLstd450PackHalf2x16:
      return define(
          i, {b.emit(Op::kOr, b.emit(Op::kShl, f.to_half(in[0][1]), literal(16u)), f.to_half(in[0][0]))});
    case GLSLstd450UnpackHalf2x16:
      return define(i, {f.from_half(in[0][0]), f.from_half(b.emit(Op::kShrU, in[0][0], literal(16u)))});
    case GLSLstd450FindILsb: return each([&](Value x, Value, Value) { return f.find_lowest(x); });
    case GLSLstd450FindUMsb: return each([&](Value x, Value, Value) { return f.find_highest(x); });
    case GLSLstd450FindSMsb: return each([&](Value x, Value, Value) { return f.find_highest_signed(x); });
    default: throw unsupported(i, spirv::name_of(i));
  }
}

}  // namespace quadrille::pipeline
