/// Four pixels of a colour attachment, decoded to linear values and encoded again.
#pragma once

#include "models/base/format.h"
#include "models/rop/srgb.h"

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// Four pixels, component-major: red, green, blue, alpha.
struct QuadColor {
  __m128 component[4];
  __m128& operator[](std::size_t c) { return component[c]; }
  const __m128& operator[](std::size_t c) const { return component[c]; }
};

/// 0..1; NaN becomes 0 because max returns its second operand when one is NaN.
inline __m128 saturate(__m128 v) { return _mm_min_ps(_mm_max_ps(v, _mm_setzero_ps()), _mm_set1_ps(1.0f)); }

[[nodiscard]] constexpr std::uint32_t most_of(const ComponentBits& component) {
  return (1u << component.bits) - 1;
}

inline __m128 decode_component(__m128i pixels, const ComponentBits& component) {
  const auto most = static_cast<int>(most_of(component));
  const __m128i code =
      _mm_and_si128(_mm_srl_epi32(pixels, _mm_cvtsi32_si128(component.shift)), _mm_set1_epi32(most));
  if (component.numeric == Numeric::kSrgb) return _mm_i32gather_ps(kSrgbToLinear.data(), code, 4);
  return _mm_div_ps(_mm_cvtepi32_ps(code), _mm_set1_ps(static_cast<float>(most)));
}

inline QuadColor decode_quad(const FormatInfo& format, __m128i pixels) {
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = decode_component(pixels, format.component[c]);
  return color;
}

/// v in 0..1. Looks up the code at the bottom of the value's bucket and compares with the one threshold that
/// the bucket may hold.
inline __m128i encode_srgb(__m128 v) {
  const __m128 least = _mm_castsi128_ps(_mm_set1_epi32(static_cast<int>(kSrgbFirstBucket << 16)));
  const __m128i bucket = _mm_sub_epi32(_mm_srli_epi32(_mm_castps_si128(_mm_max_ps(v, least)), 16),
                                       _mm_set1_epi32(kSrgbFirstBucket));
  const __m128i code = _mm_i32gather_epi32(kSrgbBucketCode.data(), bucket, 4);
  const __m128 threshold = _mm_i32gather_ps(kSrgbThreshold.data(), code, 4);
  return _mm_sub_epi32(code, _mm_castps_si128(_mm_cmpge_ps(v, threshold)));
}

inline __m128i encode_component(__m128 v, const ComponentBits& component) {
  if (component.numeric == Numeric::kSrgb) return encode_srgb(v);
  return _mm_cvtps_epi32(_mm_mul_ps(v, _mm_set1_ps(static_cast<float>(most_of(component)))));
}

inline __m128i encode_quad(const FormatInfo& format, const QuadColor& color) {
  __m128i pixels = _mm_setzero_si128();
  for (std::size_t c = 0; c < 4; ++c) {
    const ComponentBits& component = format.component[c];
    pixels = _mm_or_si128(
        pixels, _mm_sll_epi32(encode_component(color[c], component), _mm_cvtsi32_si128(component.shift)));
  }
  return pixels;
}

}  // namespace quadrille::models
