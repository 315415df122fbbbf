/// The ellipse that a pixel covers of a texture's level, by its axes, in doubles. [P: Heckbert 1989]
#pragma once

#include <array>

namespace quadrille::models::reference {

using Change = std::array<double, 2>;  ///< of a place, in texels

/// Radii of the image of a round pixel, and the direction of the longer one.
struct EllipseAxes {
  double longer = 0, shorter = 0;
  Change direction{1, 0};  ///< of length 1
};
/// Of the changes of a place to the next pixel along x and y.
[[nodiscard]] EllipseAxes ellipse_axes(const Change& along_x, const Change& along_y);

/// The ellipse that is filtered over: no larger than a level allows, a texel wider, and at most `most`
/// times as long as it is wide.
[[nodiscard]] EllipseAxes filtered_ellipse(EllipseAxes axes, double most);

/// exp(-2 r^2) at a distance from the centre that is r of the way to the edge; 0 beyond the edge.
[[nodiscard]] double ellipse_weight(const EllipseAxes& axes, double u, double v);

}  // namespace quadrille::models::reference
