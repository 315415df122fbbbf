/// Eight lanes in a vector register: what the texture unit's address and level stages share.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace quadrille::models {

/// NaN and infinities become 0.
inline __m256 finite_or_zero(__m256 v) {
  const __m256 magnitude = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), v);
  const __m256 finite =
      _mm256_cmp_ps(magnitude, _mm256_castsi256_ps(_mm256_set1_epi32(0x7f800000)), _CMP_LT_OQ);
  return _mm256_and_ps(v, finite);
}

/// All ones in the lanes whose bit (0..7) is set.
inline __m256i lanes_of(std::uint32_t bits) {
  const __m256i lane_bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), lane_bits),
                            lane_bits);
}

/// The lanes' sign bits as bits 0..7.
inline std::uint32_t bits_of(__m256i lanes) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(lanes)));
}

inline __m256i load_lanes(const std::int32_t* p) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(p));
}
inline void store_lanes(std::int32_t* p, __m256i v) { _mm256_store_si256(reinterpret_cast<__m256i*>(p), v); }

}  // namespace quadrille::models
