/// Point set-up: a square of the point's size around its window position, which covers the pixels whose
/// centre is inside. [VK1.3 #primsrast-points]
///
/// A square with level sides needs no edge functions: its bounds are the pixels that it covers. Samples on
/// the left and upper side belong to it.
#pragma once

#include "models/raster/triangle_setup.h"

namespace quadrille::models {

/// A point's window position and size. A point that is a vertex of a triangle (polygon mode) carries its
/// weights of the triangle's second and third vertex; any other carries its coordinates in their place.
struct WindowPoint {
  WindowVertex vertex;
  float size = 1;
  bool of_triangle = false;
  glm::vec2 weights{0, 0};
};

/// The size that gl_PointSize stands for: limited to what a point can have; what is not a number is 1.
[[nodiscard]] float point_size(float wished);

/// Sets up a point. The planes linear_1 and linear_2 are its coordinates (gl_PointCoord), 0 at the left and
/// upper side and 1 at the others. Checks run in the order kNoSample, kOffscreen.
[[nodiscard]] SetupOutcome setup_point(const WindowPoint& point, const SetupState& state, TriangleSetup& out);

/// How far a point's pixels may lie from it, in units of the sub-pixel grid.
[[nodiscard]] std::int32_t point_reach(float size, int subpixel_bits);

}  // namespace quadrille::models
