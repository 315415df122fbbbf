/// Evaluating a triangle's planes at pixel centres: depths of a tile, and the inputs of a fragment warp.
///
/// There is one depth function: depth = clamp(float(z plane in double), z_min, z_max). The early test, the
/// late test, Hi-Z and FragCoord.z all use it, bit for bit. z_min and z_max are the triangle's own range, so
/// the clamp moves a covered pixel by rounding errors only (and depth clamp comes for free). 1 / w and the
/// perspective weights may be anything on helper pixels beyond a triangle's horizon.
#pragma once

#include "models/raster/triangle_setup.h"
#include "models/shader/warp.h"

namespace quadrille::models {

/// Depths at the 64 pixels of a tile, quad-major, whether covered or not.
void tile_depths(const TriangleSetup& triangle, int tile_x, int tile_y, float out[64]);
/// The same at one sample of each pixel.
void sample_depths(const TriangleSetup& triangle, int tile_x, int tile_y, const SampleGrid& samples,
                   int sample, float out[64]);

struct DepthBounds {
  float min = 0, max = 0;
};
/// Smallest and greatest depth at the samples of a tile whose pixels are within the triangle's bounds:
/// contains every covered sample's depth. Not only close: every rounding in the depth function is monotonic,
/// so the outermost samples bound all others.
[[nodiscard]] DepthBounds tile_depth_bounds(const TriangleSetup& triangle, int tile_x, int tile_y,
                                            const SampleGrid& samples = {});

/// Fills lanes 4 * slot .. 4 * slot + 3 of a fragment warp with the quad whose top-left pixel is (quad_x,
/// quad_y): x, y, z, inv_w, persp_1/2, linear_1/2 and front_facing, at the pixels' centres or `from_centre`.
void interpolate_quad(const TriangleSetup& triangle, int quad_x, int quad_y, int slot, FragmentInputs& out,
                      const PixelOffset& from_centre = {});

/// Weights of a triangle's second and third vertex.
struct VertexWeights {
  float persp_1 = 0, persp_2 = 0, linear_1 = 0, linear_2 = 0;
};
/// At a position in the window, in pixels; as `interpolate_quad`, bit for bit.
[[nodiscard]] VertexWeights weights_at(const TriangleSetup& triangle, double px, double py);

}  // namespace quadrille::models
