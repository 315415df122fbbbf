#include "models/texture/level_of_detail.h"

#include "models/texture/lanes.h"

#include <immintrin.h>

namespace quadrille::models {
namespace {

/// log2 of positive normal values to about 2e-7, exact at powers of two: x = m 2^e with m in [sqrt 1/2, sqrt
/// 2), and the series of 2 atanh t / ln 2, t = (m - 1) / (m + 1).
__m256 log2_positive(__m256 x) {
  const __m256i bits = _mm256_castps_si256(x);
  // Subtracting the bits of sqrt(1/2) makes the exponent field change at sqrt 2 rather than at 2.
  const __m256i root_half = _mm256_set1_epi32(0x3f3504f3);
  const __m256i exponent = _mm256_srai_epi32(_mm256_sub_epi32(bits, root_half), 23);
  const __m256 m = _mm256_castsi256_ps(_mm256_sub_epi32(bits, _mm256_slli_epi32(exponent, 23)));
  const __m256 one = _mm256_set1_ps(1.0f);
  const __m256 t = _mm256_div_ps(_mm256_sub_ps(m, one), _mm256_add_ps(m, one));
  const __m256 t2 = _mm256_mul_ps(t, t);
  const auto step = [t2](__m256 sum, float next) {
    return _mm256_add_ps(_mm256_mul_ps(sum, t2), _mm256_set1_ps(next));
  };
  constexpr float kScale = 2.885390082f;  // 2 / ln 2
  __m256 series = step(_mm256_set1_ps(kScale / 7.0f), kScale / 5.0f);
  series = step(step(series, kScale / 3.0f), kScale);
  return _mm256_add_ps(_mm256_cvtepi32_ps(exponent), _mm256_mul_ps(series, t));
}

/// The same, linear between powers of two: exponent plus fraction, read off the bits. Too low by up to
/// 0.0861. [P: Mitchell 1962, binary logarithms]
__m256 log2_piecewise_linear(__m256 x) {
  const __m256i bits = _mm256_castps_si256(x);
  const __m256 exponent =
      _mm256_cvtepi32_ps(_mm256_sub_epi32(_mm256_srli_epi32(bits, 23), _mm256_set1_epi32(128)));
  const __m256i mantissa =
      _mm256_or_si256(_mm256_and_si256(bits, _mm256_set1_epi32(0x007fffff)), _mm256_set1_epi32(0x3f800000));
  return _mm256_add_ps(exponent, _mm256_castsi256_ps(mantissa));
}

/// lambda_base of the eight quads. [VK1.3 #textures-scale-factor, isotropic]
__m256 quad_lambdas(const TextureLayout& layout, const LaneFloats& u, const LaneFloats& v, bool linear_log2) {
  const __m256i first_lane = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  const auto length_squared = [&](std::size_t neighbour) {
    const auto difference = [&](const LaneFloats& c, std::int32_t size) {
      const __m256 d = _mm256_sub_ps(_mm256_i32gather_ps(c.data() + neighbour, first_lane, 4),
                                     _mm256_i32gather_ps(c.data(), first_lane, 4));
      return _mm256_mul_ps(d, _mm256_set1_ps(static_cast<float>(size)));
    };
    const __m256 du = difference(u, layout.width[0]), dv = difference(v, layout.height[0]);
    return _mm256_add_ps(_mm256_mul_ps(du, du), _mm256_mul_ps(dv, dv));
  };
  const __m256 rho_squared = _mm256_max_ps(length_squared(1), length_squared(2));
  const __m256 limited =
      _mm256_max_ps(_mm256_min_ps(rho_squared, _mm256_set1_ps(1e30f)), _mm256_set1_ps(1e-30f));
  return _mm256_mul_ps(linear_log2 ? log2_piecewise_linear(limited) : log2_positive(limited),
                       _mm256_set1_ps(0.5f));
}

__m256 clamp(__m256 value, float low, float high) {
  return _mm256_min_ps(_mm256_max_ps(value, _mm256_set1_ps(low)), _mm256_set1_ps(high));
}

/// lambda of a group of eight lanes, before it is rounded. [VK1.3 #textures-level-of-detail-operation]
__m256 group_lambda(const SamplerState& sampler, const TextureRequest& request, __m256 quads, int group) {
  const __m256 operand = finite_or_zero(_mm256_load_ps(request.lod.data() + 8 * group));
  __m256 base, bias = _mm256_set1_ps(sampler.lod_bias);
  if (request.op == Op::kTexLod) {
    base = operand;
  } else {
    const __m256i owner =
        _mm256_add_epi32(_mm256_set1_epi32(2 * group), _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
    base = _mm256_permutevar8x32_ps(quads, owner);
    if (request.op == Op::kTexBias) bias = _mm256_add_ps(bias, operand);
  }
  const __m256 lambda = _mm256_add_ps(base, clamp(bias, -kMaxLodBias, kMaxLodBias));
  return clamp(clamp(lambda, sampler.min_lod, sampler.max_lod), -128.0f, 128.0f);
}

}  // namespace

__m256 unit_log2(__m256 x, const Precision& precision) {
  return precision.linear_log2 ? log2_piecewise_linear(x) : log2_positive(x);
}

__m256 biased_lambda(__m256 base, __m256 shader_bias, const SamplerState& sampler) {
  const __m256 bias = _mm256_add_ps(_mm256_set1_ps(sampler.lod_bias), shader_bias);
  const __m256 lambda = _mm256_add_ps(base, clamp(bias, -kMaxLodBias, kMaxLodBias));
  return clamp(clamp(lambda, sampler.min_lod, sampler.max_lod), -128.0f, 128.0f);
}

LaneLevels levels_of(const TextureLayout& layout, const SamplerState& sampler, const LaneFloats& lambdas,
                     const Precision& precision) {
  LaneLevels out;
  const auto steps = static_cast<float>(1 << precision.lod_bits);
  const auto coarsest = static_cast<float>(layout.levels - 1);
  for (int group = 0; group < 4; ++group) {
    const __m256 fixed = _mm256_mul_ps(_mm256_loadu_ps(lambdas.data() + 8 * group), _mm256_set1_ps(steps));
    const __m256 lambda = _mm256_mul_ps(_mm256_round_ps(fixed, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC),
                                        _mm256_set1_ps(1.0f / steps));
    const __m256 d = clamp(lambda, 0.0f, coarsest);
    __m256 level, weight = _mm256_setzero_ps();
    if (sampler.mip == Filter::kLinear) {
      level = _mm256_floor_ps(d);
      weight = _mm256_sub_ps(d, level);
    } else {
      level = _mm256_sub_ps(_mm256_ceil_ps(_mm256_add_ps(d, _mm256_set1_ps(0.5f))), _mm256_set1_ps(1.0f));
    }
    _mm256_store_si256(reinterpret_cast<__m256i*>(out.finer.data() + 8 * group), _mm256_cvttps_epi32(level));
    _mm256_store_ps(out.weight.data() + 8 * group, weight);
    const __m256 magnified = _mm256_cmp_ps(lambda, _mm256_setzero_ps(), _CMP_LE_OQ);
    out.magnified |= static_cast<LaneMask>(_mm256_movemask_ps(magnified)) << (8 * group);
  }
  return out;
}

LaneLevels lane_levels(const TextureLayout& layout, const SamplerState& sampler,
                       const TextureRequest& request, const LaneFloats& u, const LaneFloats& v,
                       const Precision& precision) {
  const __m256 quads =
      request.op == Op::kTexLod ? _mm256_setzero_ps() : quad_lambdas(layout, u, v, precision.linear_log2);
  alignas(32) LaneFloats lambda;
  for (int group = 0; group < 4; ++group)
    _mm256_store_ps(lambda.data() + 8 * group, group_lambda(sampler, request, quads, group));
  return levels_of(layout, sampler, lambda, precision);
}

}  // namespace quadrille::models
