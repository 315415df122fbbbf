#include "models/raster/interpolate.h"

#include <immintrin.h>

#include <algorithm>

namespace quadrille::models {
namespace {

/// The pixels of a quad, relative to its top-left one.
inline __m256d quad_x_offsets() { return _mm256_setr_pd(0.0, 1.0, 0.0, 1.0); }
inline __m256d quad_y_offsets() { return _mm256_setr_pd(0.0, 0.0, 1.0, 1.0); }

/// (value + dx * X) + dy * Y: the one order of operations, which `depth_at` repeats.
inline __m256d evaluate(const Plane& plane, __m256d x, __m256d y) {
  const __m256d along_x =
      _mm256_add_pd(_mm256_set1_pd(plane.value), _mm256_mul_pd(_mm256_set1_pd(plane.dx), x));
  return _mm256_add_pd(along_x, _mm256_mul_pd(_mm256_set1_pd(plane.dy), y));
}

inline __m128 limit_depth(__m256d z, __m128 low, __m128 high) {
  return _mm_min_ps(_mm_max_ps(_mm256_cvtpd_ps(z), low), high);
}

/// At a position in the window, in pixels.
float depth_at(const TriangleSetup& t, double px, double py) {
  const double x = px - t.ref_x, y = py - t.ref_y;
  return std::clamp(static_cast<float>((t.z.value + t.z.dx * x) + t.z.dy * y), t.z_min, t.z_max);
}

/// `x` and `y`: where in each pixel, from its upper left corner.
void depths_at(const TriangleSetup& triangle, int tile_x, int tile_y, double x, double y, float out[64]) {
  const __m256d x0 = _mm256_add_pd(_mm256_set1_pd(tile_x * kTileSize + x - triangle.ref_x), quad_x_offsets());
  const __m256d y0 = _mm256_add_pd(_mm256_set1_pd(tile_y * kTileSize + y - triangle.ref_y), quad_y_offsets());
  const __m256d value = _mm256_set1_pd(triangle.z.value), dx = _mm256_set1_pd(triangle.z.dx),
                dy = _mm256_set1_pd(triangle.z.dy);
  const __m128 low = _mm_set1_ps(triangle.z_min), high = _mm_set1_ps(triangle.z_max);
  __m256d along_x[4];
  for (int column = 0; column < 4; ++column) {
    along_x[column] =
        _mm256_add_pd(value, _mm256_mul_pd(dx, _mm256_add_pd(x0, _mm256_set1_pd(2.0 * column))));
  }
  for (int row = 0; row < 4; ++row) {
    const __m256d along_y = _mm256_mul_pd(dy, _mm256_add_pd(y0, _mm256_set1_pd(2.0 * row)));
    for (int column = 0; column < 4; ++column) {
      _mm_storeu_ps(out + 16 * row + 4 * column,
                    limit_depth(_mm256_add_pd(along_x[column], along_y), low, high));
    }
  }
}

}  // namespace

void tile_depths(const TriangleSetup& triangle, int tile_x, int tile_y, float out[64]) {
  depths_at(triangle, tile_x, tile_y, 0.5, 0.5, out);
}

void sample_depths(const TriangleSetup& triangle, int tile_x, int tile_y, const SampleGrid& samples,
                   int sample, float out[64]) {
  const PixelOffset at = samples.from_centre(sample);
  depths_at(triangle, tile_x, tile_y, 0.5 + at.x, 0.5 + at.y, out);
}

DepthBounds tile_depth_bounds(const TriangleSetup& triangle, int tile_x, int tile_y,
                              const SampleGrid& samples) {
  const PixelRect tile{tile_x * kTileSize, tile_y * kTileSize, (tile_x + 1) * kTileSize,
                       (tile_y + 1) * kTileSize};
  const PixelRect r = intersect(tile, triangle.bounds);
  const double left = r.x0 + 0.5 + samples.pixels(samples.low.x),
               right = r.x1 - 0.5 + samples.pixels(samples.high.x);
  const double top = r.y0 + 0.5 + samples.pixels(samples.low.y),
               bottom = r.y1 - 0.5 + samples.pixels(samples.high.y);
  const bool grows_right = triangle.z.dx >= 0.0, grows_down = triangle.z.dy >= 0.0;
  return {depth_at(triangle, grows_right ? left : right, grows_down ? top : bottom),
          depth_at(triangle, grows_right ? right : left, grows_down ? bottom : top)};
}

void interpolate_quad(const TriangleSetup& triangle, int quad_x, int quad_y, int slot, FragmentInputs& out,
                      const PixelOffset& from_centre) {
  const auto lane = static_cast<std::size_t>(4 * slot);
  const __m256d centre_x = _mm256_add_pd(_mm256_set1_pd(quad_x + (0.5 + from_centre.x)), quad_x_offsets());
  const __m256d centre_y = _mm256_add_pd(_mm256_set1_pd(quad_y + (0.5 + from_centre.y)), quad_y_offsets());
  const __m256d x = _mm256_sub_pd(centre_x, _mm256_set1_pd(triangle.ref_x)),
                y = _mm256_sub_pd(centre_y, _mm256_set1_pd(triangle.ref_y));
  const __m256d inv_w = evaluate(triangle.inv_w, x, y);
  const __m256d w = _mm256_div_pd(_mm256_set1_pd(1.0), inv_w);
  const auto store = [lane](LaneFloats& row, __m256d value) {
    _mm_storeu_ps(&row[lane], _mm256_cvtpd_ps(value));
  };
  store(out.x, centre_x);
  store(out.y, centre_y);
  _mm_storeu_ps(&out.z[lane], limit_depth(evaluate(triangle.z, x, y), _mm_set1_ps(triangle.z_min),
                                          _mm_set1_ps(triangle.z_max)));
  store(out.inv_w, inv_w);
  store(out.persp_1, _mm256_mul_pd(evaluate(triangle.persp_1, x, y), w));
  store(out.persp_2, _mm256_mul_pd(evaluate(triangle.persp_2, x, y), w));
  store(out.linear_1, evaluate(triangle.linear_1, x, y));
  store(out.linear_2, evaluate(triangle.linear_2, x, y));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(&out.front_facing[lane]),
                   _mm_set1_epi32(triangle.front_facing ? -1 : 0));
}

VertexWeights weights_at(const TriangleSetup& t, double px, double py) {
  const double x = px - t.ref_x, y = py - t.ref_y;
  const auto at = [&](const Plane& plane) { return (plane.value + plane.dx * x) + plane.dy * y; };
  const double w = 1.0 / at(t.inv_w);
  return {static_cast<float>(at(t.persp_1) * w), static_cast<float>(at(t.persp_2) * w),
          static_cast<float>(at(t.linear_1)), static_cast<float>(at(t.linear_2))};
}

}  // namespace quadrille::models
