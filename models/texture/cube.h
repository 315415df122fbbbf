/// Faces of a cube: which one a direction meets and where, and which texel lies beyond an edge. [VK1.3
/// #textures-cube-map-face-selection, #textures-cubemapedge]
#pragma once

#include "models/texture/lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace quadrille::models {

/// Chooses among six numbers by face: s and t of a direction, or of its change.
struct CubeAxes {
  __m256 z_major, y_major, negative;  ///< masks
  /// The number that runs along s, along t and along the major axis of each lane's face.
  [[nodiscard]] __m256 along_s(const __m256 (&r)[3]) const {
    const __m256 of_x = _mm256_xor_ps(r[2], _mm256_andnot_ps(negative, sign()));
    const __m256 of_z = _mm256_xor_ps(r[0], _mm256_and_ps(negative, sign()));
    return pick(of_x, r[0], of_z);
  }
  [[nodiscard]] __m256 along_t(const __m256 (&r)[3]) const {
    const __m256 of_y = _mm256_xor_ps(r[2], _mm256_and_ps(negative, sign()));
    const __m256 down = _mm256_xor_ps(r[1], sign());
    return pick(down, of_y, down);
  }
  [[nodiscard]] __m256 along_major(const __m256 (&r)[3]) const {
    return _mm256_xor_ps(pick(r[0], r[1], r[2]), _mm256_and_ps(negative, sign()));
  }

 private:
  [[nodiscard]] static __m256 sign() { return _mm256_set1_ps(-0.0f); }
  [[nodiscard]] __m256 pick(__m256 x, __m256 y, __m256 z) const {
    return _mm256_blendv_ps(_mm256_blendv_ps(x, y, y_major), z, z_major);
  }
};

/// The axes of the faces that the directions meet. Of equal lengths z counts before y, and y before x.
inline CubeAxes cube_axes(const __m256 (&r)[3]) {
  const auto length = [](__m256 v) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), v); };
  const __m256 x = length(r[0]), y = length(r[1]), z = length(r[2]);
  CubeAxes axes;
  axes.z_major = _mm256_and_ps(_mm256_cmp_ps(z, x, _CMP_GE_OQ), _mm256_cmp_ps(z, y, _CMP_GE_OQ));
  axes.y_major = _mm256_cmp_ps(y, x, _CMP_GE_OQ);
  const __m256 major = _mm256_blendv_ps(_mm256_blendv_ps(r[0], r[1], axes.y_major), r[2], axes.z_major);
  axes.negative = _mm256_cmp_ps(major, _mm256_setzero_ps(), _CMP_LT_OQ);
  return axes;
}

inline __m256i cube_face(const CubeAxes& axes) {
  const auto pick = [&](int x, int y, int z) {
    const __m256 xy = _mm256_blendv_ps(_mm256_castsi256_ps(_mm256_set1_epi32(x)),
                                       _mm256_castsi256_ps(_mm256_set1_epi32(y)), axes.y_major);
    return _mm256_blendv_ps(xy, _mm256_castsi256_ps(_mm256_set1_epi32(z)), axes.z_major);
  };
  return _mm256_sub_epi32(_mm256_castps_si256(pick(0, 2, 4)), _mm256_castps_si256(axes.negative));
}

struct CubeTexel {
  std::int32_t face = 0, x = 0, y = 0;
};

/// The texel that lies beyond one edge of a face of n x n texels: x or y is -1 or n, the other is inside.
inline CubeTexel beyond_edge(const CubeTexel& from, std::int32_t n) {
  const double s = (2.0 * from.x + 1.0) / n - 1.0, t = (2.0 * from.y + 1.0) / n - 1.0;
  const std::array<std::array<double, 3>, 6> directions{
      {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}}};
  const auto& r = directions.at(static_cast<std::size_t>(from.face));
  const double x = std::abs(r[0]), y = std::abs(r[1]), z = std::abs(r[2]);
  const std::size_t axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  const bool negative = r.at(axis) < 0;
  const double sign = negative ? -1 : 1, length = std::abs(r.at(axis));
  const double across = axis == 0 ? -sign * r[2] : axis == 1 ? r[0] : sign * r[0];
  const double down = axis == 1 ? sign * r[2] : -r[1];
  const auto texel = [&](double place) {
    return std::clamp(static_cast<std::int32_t>(std::floor((place / length + 1.0) / 2.0 * n)), 0, n - 1);
  };
  return {static_cast<std::int32_t>(2 * axis) + (negative ? 1 : 0), texel(across), texel(down)};
}

}  // namespace quadrille::models
