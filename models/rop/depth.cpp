#include "models/rop/depth.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille::models {
namespace {

template <int predicate>
std::uint64_t compare(const float stored[64], const float incoming[64]) {
  std::uint64_t passed = 0;
  for (int i = 0; i < 64; i += 8) {
    const __m256 result =
        _mm256_cmp_ps(_mm256_loadu_ps(incoming + i), _mm256_loadu_ps(stored + i), predicate);
    passed |= static_cast<std::uint64_t>(static_cast<std::uint32_t>(_mm256_movemask_ps(result))) << i;
  }
  return passed;
}

}  // namespace

std::uint64_t depth_test(CompareOp op, const float stored[64], const float incoming[64], std::uint64_t mask) {
  switch (op) {
    case CompareOp::kNever: return 0;
    case CompareOp::kLess: return mask & compare<_CMP_LT_OQ>(stored, incoming);
    case CompareOp::kEqual: return mask & compare<_CMP_EQ_OQ>(stored, incoming);
    case CompareOp::kLessOrEqual: return mask & compare<_CMP_LE_OQ>(stored, incoming);
    case CompareOp::kGreater: return mask & compare<_CMP_GT_OQ>(stored, incoming);
    case CompareOp::kNotEqual: return mask & compare<_CMP_NEQ_UQ>(stored, incoming);
    case CompareOp::kGreaterOrEqual: return mask & compare<_CMP_GE_OQ>(stored, incoming);
    case CompareOp::kAlways: return mask;
  }
  return 0;
}

void depth_write(float stored[64], const float incoming[64], std::uint64_t mask) {
  const __m256i lane_bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  for (int i = 0; i < 64; i += 8) {
    const __m256i bits = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask >> i & 0xff)), lane_bits);
    _mm256_maskstore_ps(stored + i, _mm256_cmpeq_epi32(bits, lane_bits), _mm256_loadu_ps(incoming + i));
  }
}

float tile_max(const float depths[64]) {
  float greatest = -std::numeric_limits<float>::infinity();
  bool ordered = true;
  for (int i = 0; i < 64; ++i) {
    ordered &= !std::isnan(depths[i]);
    greatest = std::max(greatest, depths[i]);
  }
  return ordered ? greatest : std::numeric_limits<float>::infinity();
}

}  // namespace quadrille::models
