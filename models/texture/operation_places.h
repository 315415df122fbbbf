/// Where the lanes of a texture request ask, and at which level of detail: the first half of what
/// operation_plan.cpp does. Everything is decided lane by lane or quad by quad.
#pragma once

#include "models/base/sampler.h"
#include "models/precision.h"
#include "models/shader/warp.h"
#include "models/texture/cube.h"
#include "models/texture/ellipse_texels.h"
#include "models/texture/layout.h"

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille::models {

using LaneInts = std::array<std::int32_t, kWarpLanes>;
inline constexpr std::size_t kGroupLanes = 8;

inline __m256 load(const LaneFloats& lanes, std::size_t first) {
  return _mm256_loadu_ps(lanes.data() + first);
}
inline void store(LaneFloats& lanes, std::size_t first, __m256 v) {
  _mm256_storeu_ps(lanes.data() + first, v);
}
inline __m256i load(const LaneInts& lanes, std::size_t first) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes.data() + first));
}
inline void store(LaneInts& lanes, std::size_t first, __m256i v) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes.data() + first), v);
}

/// The sampler as a view of this kind is read through it: axes that it lacks have nothing beyond them, and
/// beyond an edge of a cube lies another face.
[[nodiscard]] SamplerState sampler_for(const SamplerState& sampler, ViewKind kind);

class OperationPlaces {
 public:
  OperationPlaces(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                  const Precision& precision);
  [[nodiscard]] const TextureOperation& operation() const { return operation_; }
  [[nodiscard]] const TextureWords& words() const { return words_; }

  /// Fills `place`, `slice` and the changes of the places.
  void find();
  /// Then fills the levels of detail; with anisotropy, `axis` and how many samples lie along it.
  void find_levels(std::array<float, kWarpLanes>& samples);
  /// Do lanes take the texels of an ellipse, in place of samples?
  [[nodiscard]] bool takes_ellipses() const;
  /// A lane's, in a level of such a size.
  [[nodiscard]] TexelEllipse ellipse_of(std::size_t lane, std::int32_t width, std::int32_t height) const;

  std::array<LaneFloats, 3> place;   ///< in texture sizes; of a cube, on the face
  LaneInts slice;                    ///< layer, face or both
  std::array<LaneFloats, 2> axis{};  ///< that samples lie along, in texture sizes
  LaneFloats lambda, plain_lambda;   ///< limited; without limits and the shader's bias

 private:
  [[nodiscard]] float size(std::size_t k) const;
  [[nodiscard]] bool needs_changes() const;
  [[nodiscard]] bool stretches() const;
  [[nodiscard]] float most_anisotropy() const;
  void change_of(std::size_t k, std::size_t first, __m256& along_x, __m256& along_y) const;
  void find_group(std::size_t first);
  [[nodiscard]] __m256i layer_of(std::size_t first) const;
  static void to_face(const CubeAxes& axes, __m256 (&r)[3], __m256 (&x)[3], __m256 (&y)[3]);
  void level_of_detail(std::size_t first, std::array<float, kWarpLanes>& samples);
  __m256 stretch(std::size_t first, __m256 x2, __m256 y2, std::array<float, kWarpLanes>& samples);
  static void ellipse(const __m256 (&along)[2][2], __m256 x2, __m256 y2, __m256 (&axis)[2], __m256& long2,
                      __m256& short2);

  const TextureView& view_;
  const SamplerState& sampler_;
  const TextureRequest& request_;
  const Precision& precision_;
  TextureOperation operation_;
  TextureWords words_;
  std::size_t dimensions_;
  std::array<LaneFloats, 3> along_x_, along_y_;  ///< change of the place, in texels of the finest level
};

}  // namespace quadrille::models
