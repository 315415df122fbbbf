/// Transcendental functions on eight lanes: our own, so that every machine and compiler gives the same bits.
/// Only + - * /, fused multiply-add, conversions and integer operations, each correctly rounded by IEEE 754.
///
/// Each function reduces its argument exactly, evaluates a polynomial and puts the result together.
/// Coefficients are near-minimax fits (Chebyshev interpolation in 40 digits, rounded to fp32); the relative
/// error each leaves is noted. tests/models/shader/vector_math_test.cpp measures the whole against double
/// precision. What Vulkan asks: [VK1.3 #spirvenv-precision-operation].
#pragma once

#include "models/shader/lanes.h"

#include <limits>

namespace quadrille::models {

/// 2^x. At most 1 ULP. Overflow gives infinity, underflow a denormal or zero, NaN gives NaN.
inline Floats exp2(Floats x) {
  // The range is clamped (NaN passes: min and max return their second operand); 2^-160 is zero and 2^129
  // infinite.
  const Floats clamped{_mm256_min_ps(splat(129.0f).v, _mm256_max_ps(splat(-160.0f).v, x.v))};
  const Floats whole = round_to<_MM_FROUND_TO_NEAREST_INT>(clamped);
  const Floats f = clamped - whole;   // exact, in [-1/2, 1/2]
  Floats p = splat(0x1.44138ap-13f);  // 2^f = 1 + f p(f), 8e-9
  p = fused(p, f, splat(0x1.5f0890p-10f));
  p = fused(p, f, splat(0x1.3b2a54p-7f));
  p = fused(p, f, splat(0x1.c6af6cp-5f));
  p = fused(p, f, splat(0x1.ebfbe0p-3f));
  p = fused(p, f, splat(0x1.62e430p-1f));
  p = fused(p, f, splat(1.0f));
  // 2^whole as two factors, both normal; the first product is exact, so a denormal result is rounded once.
  const Words n = to_integers(whole);
  const Words half{_mm256_srai_epi32(n.v, 1)};
  const Words bias = splat_word(127);
  return p * as_floats(shift_left<23>(half + bias)) * as_floats(shift_left<23>(n - half + bias));
}

/// log2 x. At most 1 ULP. log2(+-0) = -infinity, log2(infinity) = infinity, negative arguments and NaN give
/// NaN.
inline Floats log2(Floats x) {
  const Words tiny = compare<_CMP_LT_OQ>(x, splat(0x1p-126f));  // denormals are scaled into the normal range
  const Floats normal = choose(tiny, x * splat(0x1p24f), x);
  // m in [sqrt(1/2), sqrt(2)): the exponent is taken after an offset that moves its border from 1 to
  // sqrt(1/2).
  const Words offset = as_words(normal) - splat_word(0x3f3504f3);
  const Floats e =
      to_floats(Words{_mm256_srai_epi32(offset.v, 23)}) - as_floats(tiny & as_words(splat(24.0f)));
  const Floats m = as_floats((offset & splat_word(0x007fffff)) + splat_word(0x3f3504f3));
  // ln m = 2 atanh(s) = 2 s + s r with f = m - 1, s = f / (2 + f), z = s^2 <= 0.0295, r = 2 z l(z), 3e-9.
  // Written as f - h + s (h + r) with h = f^2 / 2, the leading term is exact and the rounding of s counts
  // little. log2 m = ln m / ln 2, 1 / ln 2 in two parts.
  const Floats f = m - splat(1.0f);
  const Floats s = f / (m + splat(1.0f));
  const Floats z = s * s;
  Floats l = splat(0x1.2eebdap-2f);
  l = fused(l, z, splat(0x1.997c10p-2f));
  l = fused(l, z, splat(0x1.55555cp-1f));
  const Floats h = f * f * splat(0.5f);
  const Floats tail = fused(s, fused(z, l, h), splat(0.0f) - h);
  const Floats log2_m =
      fused(f, splat(0x1.715476p+0f), fused(tail, splat(0x1.715476p+0f), f * splat(0x1.4ae0c0p-26f)));
  const Floats finite = log2_m + e;
  const Floats infinity = splat(std::numeric_limits<float>::infinity());
  const Words passes = compare<_CMP_NLT_UQ>(x, infinity);  // infinity and NaN
  const Words negative = compare<_CMP_LT_OQ>(x, splat(0.0f));
  const Words zero = compare<_CMP_EQ_OQ>(x, splat(0.0f));
  Lanes result = choose(passes, x, finite);
  result = choose(zero, splat(-std::numeric_limits<float>::infinity()), result);
  return choose(negative, splat(std::numeric_limits<float>::quiet_NaN()), result);
}

/// An angle as quarter turns and a remainder in about [-pi/4, pi/4].
struct ReducedAngle {
  Words quarter;  ///< modulo 2^32
  Floats rest;
};

/// Reduction in double precision with pi/2 in two parts. Magnitudes of 2^40 and more, where neighbouring
/// values are thousands of turns apart, count as 0.
inline ReducedAngle reduce_angle(Floats magnitude) {
  const auto half = [](__m128 four, __m128i& quarter, __m128& rest) {
    const __m256d x = _mm256_cvtps_pd(four);
    const __m256d n = _mm256_round_pd(_mm256_mul_pd(x, _mm256_set1_pd(0x1.45f306dc9c883p-1)),
                                      _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
    const __m256d r = _mm256_fnmadd_pd(n, _mm256_set1_pd(0x1.921fb54442d18p+0), x);
    rest = _mm256_cvtpd_ps(_mm256_fnmadd_pd(n, _mm256_set1_pd(0x1.1a62633145c07p-54), r));
    // n < 2^41: adding 2^52 leaves its integer value in the low bits of the significand.
    const __m256i integer = _mm256_castpd_si256(_mm256_add_pd(n, _mm256_set1_pd(0x1p52)));
    const __m256i low = _mm256_permutevar8x32_epi32(integer, _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
    quarter = _mm256_castsi256_si128(low);
  };
  const Floats x = as_floats(as_words(magnitude) & ~compare<_CMP_GE_OQ>(magnitude, splat(0x1p40f)));
  __m128i quarter_low, quarter_high;
  __m128 rest_low, rest_high;
  half(_mm256_castps256_ps128(x.v), quarter_low, rest_low);
  half(_mm256_extractf128_ps(x.v, 1), quarter_high, rest_high);
  return {{_mm256_set_m128i(quarter_high, quarter_low)}, {_mm256_set_m128(rest_high, rest_low)}};
}

/// sin (quarter even) or cos (odd) of the remainder, negated in the other half turn.
inline Floats sine_of(const ReducedAngle& angle, Words quarter) {
  const Floats r = angle.rest;
  const Floats z = r * r;
  Floats s = splat(-0x1.9ac856p-13f);  // sin r = r + r z s(z), 1e-8
  s = fused(s, z, splat(0x1.110c26p-7f));
  s = fused(s, z, splat(-0x1.555552p-3f));
  const Floats sine = fused(r * z, s, r);
  Floats c = splat(0x1.9bd786p-16f);  // cos r = 1 - z / 2 + z^2 c(z), 1e-9
  c = fused(c, z, splat(-0x1.6c12d0p-10f));
  c = fused(c, z, splat(0x1.555554p-5f));
  const Floats cosine = fused(z * z, c, fused(z, splat(-0.5f), splat(1.0f)));
  const Words odd = equal(quarter & splat_word(1), splat_word(1));
  const Words sign = shift_left<30>(quarter & splat_word(2));
  return as_floats(static_cast<Words>(choose(odd, cosine, sine)) ^ sign);
}

/// Infinity and NaN have no angle: NaN.
inline Floats undefined_for_infinite(Floats x, Floats result) {
  const Floats difference = x - x;  // zero, or NaN
  return choose(compare<_CMP_UNORD_Q>(difference, difference), difference, result);
}

/// sin x, x in radians. At most 2 ULP for |x| < 2^40.
inline Floats sin(Floats x) {
  const Words sign = as_words(x) & splat_word(0x80000000u);
  const ReducedAngle angle = reduce_angle(as_floats(as_words(x) ^ sign));
  return undefined_for_infinite(x, as_floats(as_words(sine_of(angle, angle.quarter)) ^ sign));
}

/// cos x, x in radians. At most 2 ULP for |x| < 2^40.
inline Floats cos(Floats x) {
  const ReducedAngle angle = reduce_angle(as_floats(as_words(x) & splat_word(0x7fffffffu)));
  return undefined_for_infinite(x, sine_of(angle, angle.quarter + splat_word(1)));
}

}  // namespace quadrille::models
