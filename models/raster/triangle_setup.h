/// Triangle set-up: from three window vertices to edge functions, bounds and plane equations; everything the
/// rasteriser asks about a triangle.
///
/// Edge functions are exact. With vertices on the 2^-s grid, E(x, y) = a (x - xi) + b (y - yi) is an integer,
/// and at pixel centres it steps by multiples of 2^s; dividing by 2^s and rounding down keeps its sign, so
/// `origin + a * px + b * py >= 0` decides pixel (px, py) with the top-left rule folded into `origin`. [VK1.3
/// #primsrast-polygons-basic] Planes are in double from the snapped positions, relative to the first vertex:
/// depth, 1 / w and the barycentric weights are each one rounding away from the exact plane, whatever the
/// size of the triangle.
#pragma once

#include "models/base/pipeline_state.h"
#include "models/raster/edge.h"
#include "models/raster/samples.h"
#include "models/raster/tile.h"
#include "models/raster/viewport.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>

namespace quadrille::models {

/// What the rasteriser asks about a primitive. A triangle has three edges; a line has two or four, and a
/// point none: its bounds are its pixels (line_setup.h, point_setup.h).
struct TriangleSetup {
  std::array<EdgeFunction, 4> edges;
  int edge_count = 3;
  /// pixels that may be covered: those with a sample in the bounding box, within the scissor
  PixelRect bounds;
  double ref_x = 0, ref_y = 0;  ///< reference point, pixels
  Plane z, inv_w;               ///< window depth, 1 / w
  Plane persp_1, persp_2;       ///< weight of the second and third vertex, divided by w
  Plane linear_1, linear_2;     ///< the weights themselves, linear in the window
  /// depths are limited to this: range of the vertices' depths within the viewport's
  float z_min = 0, z_max = 0;
  bool front_facing = false;
  /// what is covered is decided at the centre, for all samples of a pixel (Bresenham lines)
  bool whole_pixels = false;
};

/// State that set-up needs; `scissor` is a draw's `drawable_rect`, depths are the viewport's.
struct SetupState {
  CullMode cull = CullMode::kNone;
  FrontFace front = FrontFace::kCounterClockwise;
  PixelRect scissor;
  int subpixel_bits = 8;
  float min_depth = 0, max_depth = 1;
  LineMode line_mode = LineMode::kBresenham;
  float line_width = 1;  ///< pixels
  SampleGrid samples{};
  DepthBias bias{};
  /// what depths of the attachment's format are apart; 0: its floats are apart by their size
  double depth_step = 0;
};

enum class SetupOutcome : std::uint8_t {
  kKept,
  kCulledFace,  ///< faces the way that is culled
  kZeroArea,    ///< no area, or no length, after snapping
  kOffscreen,   ///< its pixels are outside the scissor
  kNoSample     ///< its bounding box holds no sample
};

/// Sets up one triangle. `weights` holds (b1, b2) of each vertex: (0,0) (1,0) (0,1) for a triangle that was
/// not clipped. `out` is written when kept. The checks run in the order kZeroArea, kCulledFace, kNoSample,
/// kOffscreen. Weights that are "linear" are those of the clipped piece's corners.
[[nodiscard]] SetupOutcome setup_triangle(const std::array<WindowVertex, 3>& vertices,
                                          const std::array<glm::vec2, 3>& weights, const SetupState& state,
                                          TriangleSetup& out);

/// Twice the signed area, in squares of the grid's unit: positive when clockwise on the screen; Vulkan's area
/// has the opposite sign. [VK1.3 #primsrast-polygons-basic]
[[nodiscard]] std::int64_t doubled_area(const std::array<WindowVertex, 3>& vertices);
/// Does a triangle of this area (not 0) show its front?
[[nodiscard]] inline bool is_front(std::int64_t area2, const SetupState& state) {
  return (area2 < 0) == (state.front == FrontFace::kCounterClockwise);
}
[[nodiscard]] inline bool culls(bool front, const SetupState& state) {
  return state.cull == (front ? CullMode::kFront : CullMode::kBack);
}

/// How far a triangle's depths are moved; `greatest` is the greatest of its corners. [VK1.3
/// #primsrast-depthbias]
[[nodiscard]] double depth_offset(const Plane& z, float greatest, const SetupState& state);

/// Limits depths to the range of a primitive's vertices (from `low` to `high`) within the viewport's.
void limit_depths(float low, float high, const SetupState& state, TriangleSetup& out);

/// (b1, b2) of a triangle that was not clipped.
[[nodiscard]] inline std::array<glm::vec2, 3> whole_triangle_weights() {
  return {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)};
}

}  // namespace quadrille::models
