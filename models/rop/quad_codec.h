/// Four pixels of a colour attachment or texture, decoded to numbers and encoded again: linear values, floats
/// as they are, and of integers their bits.
#pragma once

#include "models/base/format.h"
#include "models/rop/srgb.h"

#include <immintrin.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace quadrille::models {

/// Four pixels, component-major: red, green, blue, alpha.
struct QuadColor {
  __m128 component[4];
  __m128& operator[](std::size_t c) { return component[c]; }
  const __m128& operator[](std::size_t c) const { return component[c]; }
};

/// Four pixels as they are stored, word-major: lane i of word w is word w of pixel i. Pixels of less than
/// four bytes are the low bits of word 0.
struct QuadWords {
  __m128i word[4];
};

/// 0..1; NaN becomes 0 because max returns its second operand when one is NaN.
inline __m128 saturate(__m128 v) { return _mm_min_ps(_mm_max_ps(v, _mm_setzero_ps()), _mm_set1_ps(1.0f)); }

[[nodiscard]] constexpr std::uint32_t most_of(const ComponentBits& component) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << component.bits) - 1);
}

/// Swaps words and pixels.
inline void transpose(QuadWords& quad) {
  const __m128i a = _mm_unpacklo_epi32(quad.word[0], quad.word[1]),
                b = _mm_unpackhi_epi32(quad.word[0], quad.word[1]),
                c = _mm_unpacklo_epi32(quad.word[2], quad.word[3]),
                d = _mm_unpackhi_epi32(quad.word[2], quad.word[3]);
  quad = {{_mm_unpacklo_epi64(a, c), _mm_unpackhi_epi64(a, c), _mm_unpacklo_epi64(b, d),
           _mm_unpackhi_epi64(b, d)}};
}

/// Four neighbours of `bytes` each (1, 2, 4, 8 or 16). Words that they lack are 0.
inline QuadWords load_quad(const std::byte* at, int bytes) {
  const __m128i zero = _mm_setzero_si128();
  const auto load = [at](int i) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at) + i); };
  if (bytes == 4) return {{load(0), zero, zero, zero}};
  if (bytes == 8) {
    const __m128i low = _mm_shuffle_epi32(load(0), 0xd8), high = _mm_shuffle_epi32(load(1), 0xd8);
    return {{_mm_unpacklo_epi64(low, high), _mm_unpackhi_epi64(low, high), zero, zero}};
  }
  if (bytes == 16) {
    QuadWords quad{{load(0), load(1), load(2), load(3)}};
    transpose(quad);
    return quad;
  }
  if (bytes == 2)
    return {{_mm_cvtepu16_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at))), zero, zero, zero}};
  std::int32_t four = 0;
  std::memcpy(&four, at, sizeof four);
  return {{_mm_cvtepu8_epi32(_mm_cvtsi32_si128(four)), zero, zero, zero}};
}

inline void store_quad(std::byte* at, int bytes, QuadWords quad) {
  const auto store = [at](int i, __m128i v) { _mm_storeu_si128(reinterpret_cast<__m128i*>(at) + i, v); };
  if (bytes == 4) {
    store(0, quad.word[0]);
  } else if (bytes == 8) {
    store(0, _mm_unpacklo_epi32(quad.word[0], quad.word[1]));
    store(1, _mm_unpackhi_epi32(quad.word[0], quad.word[1]));
  } else if (bytes == 16) {
    transpose(quad);
    for (int i = 0; i < 4; ++i) store(i, quad.word[i]);
  } else {
    const __m128i halves = _mm_packus_epi32(quad.word[0], quad.word[0]);
    const std::int64_t packed = _mm_cvtsi128_si64(bytes == 2 ? halves : _mm_packus_epi16(halves, halves));
    std::memcpy(at, &packed, 4 * static_cast<std::size_t>(bytes));
  }
}

/// Halves in the low 16 bits of each lane.
inline __m128 from_half(__m128i codes) { return _mm_cvtph_ps(_mm_packus_epi32(codes, codes)); }
inline __m128i to_half(__m128 v) {
  return _mm_cvtepu16_epi32(_mm_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
}

/// An unsigned float of five bits of exponent and so many of mantissa, rounded to nearest, ties to even. What
/// is negative is 0, what is finite and too large the greatest finite value. [VK1.3 #fundamentals-fp11]
[[nodiscard]] std::uint32_t encode_ufloat(float value, int mantissa_bits);

/// A power of two, of an exponent that a float can have.
inline __m128 power_of_two(__m128i exponent) {
  return _mm_castsi128_ps(_mm_slli_epi32(_mm_add_epi32(exponent, _mm_set1_epi32(127)), 23));
}

/// Its bits, extended to 32 by zeros or by the sign.
inline __m128i decode_integer(__m128i word, const ComponentBits& component) {
  const __m128i high = _mm_sll_epi32(word, _mm_cvtsi32_si128(32 - component.bits - component.shift % 32));
  const __m128i down = _mm_cvtsi32_si128(32 - component.bits);
  const bool is_signed = component.numeric == Numeric::kSint || component.numeric == Numeric::kSnorm;
  return is_signed ? _mm_sra_epi32(high, down) : _mm_srl_epi32(high, down);
}

inline __m128 decode_component(const QuadWords& quad, const ComponentBits& component) {
  const __m128i word = quad.word[component.shift / 32];
  if (component.numeric == Numeric::kFloat && component.bits == 32) return _mm_castsi128_ps(word);
  if (number_kind(component.numeric) != NumberKind::kFloat)
    return _mm_castsi128_ps(decode_integer(word, component));
  if (component.numeric == Numeric::kSnorm) {
    const __m128 most = _mm_set1_ps(static_cast<float>(most_of(component) / 2));
    const __m128 value = _mm_div_ps(_mm_cvtepi32_ps(decode_integer(word, component)), most);
    return _mm_max_ps(value, _mm_set1_ps(-1.0f));
  }
  const __m128i code = _mm_and_si128(_mm_srl_epi32(word, _mm_cvtsi32_si128(component.shift % 32)),
                                     _mm_set1_epi32(static_cast<int>(most_of(component))));
  if (component.numeric == Numeric::kSrgb) return _mm_i32gather_ps(kSrgbToLinear.data(), code, 4);
  if (component.numeric == Numeric::kFloat) return from_half(code);
  // As a half without a sign: the same exponent, and zeros behind the mantissa.
  if (component.numeric == Numeric::kUfloat)
    return from_half(_mm_sll_epi32(code, _mm_cvtsi32_si128(15 - component.bits)));
  if (component.numeric == Numeric::kSharedExponent)
    return _mm_mul_ps(_mm_cvtepi32_ps(code),
                      power_of_two(_mm_sub_epi32(_mm_srli_epi32(word, 27), _mm_set1_epi32(24))));
  return _mm_div_ps(_mm_cvtepi32_ps(code), _mm_set1_ps(static_cast<float>(most_of(component))));
}

/// Components that the format lacks are (0, 0, 0, 1).
inline QuadColor decode_quad(const FormatInfo& format, const QuadWords& quad) {
  const bool integers = number_kind(format.numeric) != NumberKind::kFloat;
  const __m128 one = integers ? _mm_castsi128_ps(_mm_set1_epi32(1)) : _mm_set1_ps(1.0f);
  QuadColor color{{_mm_setzero_ps(), _mm_setzero_ps(), _mm_setzero_ps(), one}};
  for (std::size_t c = 0; c < format.channels; ++c) color[c] = decode_component(quad, format.component[c]);
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

/// A number as its component's code; what fits into 0..1 alone must be there. Of an integer: its low bits.
inline __m128i encode_component(__m128 v, const ComponentBits& component) {
  if (number_kind(component.numeric) != NumberKind::kFloat)
    return _mm_and_si128(_mm_castps_si128(v), _mm_set1_epi32(static_cast<int>(most_of(component))));
  if (component.numeric == Numeric::kSrgb) return encode_srgb(v);
  if (component.numeric == Numeric::kFloat) return component.bits == 32 ? _mm_castps_si128(v) : to_half(v);
  if (component.numeric == Numeric::kUfloat) {
    alignas(16) float value[4];
    alignas(16) std::uint32_t code[4];
    _mm_store_ps(value, v);
    for (int i = 0; i < 4; ++i) code[i] = encode_ufloat(value[i], component.bits - 5);
    return _mm_load_si128(reinterpret_cast<const __m128i*>(code));
  }
  return _mm_cvtps_epi32(_mm_mul_ps(v, _mm_set1_ps(static_cast<float>(most_of(component)))));
}

inline QuadWords encode_quad(const FormatInfo& format, const QuadColor& color) {
  const __m128i zero = _mm_setzero_si128();
  QuadWords quad{{zero, zero, zero, zero}};
  for (std::size_t c = 0; c < format.channels; ++c) {
    const ComponentBits& component = format.component[c];
    __m128i& word = quad.word[component.shift / 32];
    word = _mm_or_si128(
        word, _mm_sll_epi32(encode_component(color[c], component), _mm_cvtsi32_si128(component.shift % 32)));
  }
  return quad;
}

}  // namespace quadrille::models
