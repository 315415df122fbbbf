/// Level of detail of the lanes of one texture instruction: which mip levels a lane reads and how it mixes
/// them.
#pragma once

#include "models/base/sampler.h"
#include "models/precision.h"
#include "models/shader/warp.h"
#include "models/texture/layout.h"

#include <immintrin.h>

#include <array>
#include <cstdint>

namespace quadrille::models {

/// By lane.
struct LaneLevels {
  /// the level read, or the finer of two: 0 .. levels - 1
  alignas(32) std::array<std::int32_t, kWarpLanes> finer;
  /// of level finer + 1; 0: only the finer one is read
  alignas(32) LaneFloats weight;
  LaneMask magnified = 0;  ///< lambda <= 0: the magnification filter applies
};

/// Computes them from texture coordinates that are finite (u, v in texture widths and heights). sample.h
/// states the rules.
[[nodiscard]] LaneLevels lane_levels(const TextureLayout& layout, const SamplerState& sampler,
                                     const TextureRequest& request, const LaneFloats& u, const LaneFloats& v,
                                     const Precision& precision);

/// The same from each lane's level of detail, biased and limited, before it is rounded.
[[nodiscard]] LaneLevels levels_of(const TextureLayout& layout, const SamplerState& sampler,
                                   const LaneFloats& lambda, const Precision& precision);

/// log2 of positive numbers, as the unit has it.
[[nodiscard]] __m256 unit_log2(__m256 x, const Precision& precision);
/// Bias, the sampler's with `shader_bias`, and the sampler's limits.
[[nodiscard]] __m256 biased_lambda(__m256 base, __m256 shader_bias, const SamplerState& sampler);

}  // namespace quadrille::models
