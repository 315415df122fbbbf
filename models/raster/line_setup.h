/// Line set-up: from two window vertices to the edges, bounds and planes that the rasteriser knows from
/// triangles.
///
/// A Bresenham line is a band of its width around the line, cut off straight at two columns (or two rows, if
/// it is steep): so it needs two edge functions, and its bounds do the rest. The band gives each column one
/// pixel. Which column is the first and which the last follows from the diamond-exit rule: a pixel is drawn
/// if the line leaves the diamond |x - xc| + |y - yc| < 1/2 around its centre. Ends on a boundary count as
/// moved up by a little and to the left by a little more, which is what the top-left rule says too. So a
/// strip draws each joint once. All of it is integer arithmetic. [VK1.3 #primsrast-lines-bresenham]
///
/// A rectangular line is the rectangle of its width along the line: four edge functions.
#pragma once

#include "models/raster/triangle_setup.h"

#include <array>

namespace quadrille::models {

/// A window vertex of a line, and its weights of the second and third vertex of the primitive that it comes
/// from (for a line that was not clipped: 0 and 1, and 0).
struct LineEnd {
  WindowVertex vertex;
  glm::vec2 weights{0, 0};
};

/// Sets up the line from `ends[0]` to `ends[1]`. Checks run in the order kZeroArea, kNoSample, kOffscreen.
/// Depth, 1 / w and weights are linear along the line: by the nearest point of the line in the rectangular
/// modes, by the column (or row) in Bresenham's.
[[nodiscard]] SetupOutcome setup_line(const std::array<LineEnd, 2>& ends, const SetupState& state,
                                      TriangleSetup& out);

/// How far a line's pixels may lie from it, in units of the sub-pixel grid.
[[nodiscard]] std::int32_t line_reach(const SetupState& state);

/// How much of a pixel a smooth line covers.
struct LineCoverage {
  Plane along, across;  ///< pixels from the line's middle, on both axes of its rectangle
  double half_length = 0, half_width = 0;
  /// At the centre of a pixel, relative to the set-up's reference point; 0 to 1. The pixel counts as a square
  /// that is turned with the line: an approximation that costs two products.
  [[nodiscard]] float at(double x, double y) const;
};
/// Of a line that was set up, from the same ends.
[[nodiscard]] LineCoverage line_coverage(const std::array<LineEnd, 2>& ends, const SetupState& state);

}  // namespace quadrille::models
