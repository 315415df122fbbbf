/// From shaded vertices to the triangles to draw: clipping, projection and culling, or the machine's own
/// window triangles. Internal to the reference.
#pragma once

#include <span>
#include <vector>

#include "models/reference/coverage.h"
#include "models/reference/reference.h"
#include "models/reference/vertices.h"

namespace quadrille::models::reference {

/// Smallest clip w kept in mode *ideal*: no more than what keeps 1 / w finite, since the sides cut what is
/// far away. [G]
inline constexpr double kMinW = 1e-300;
/// How far out the sides cut in mode *ideal*, in half view volumes. [G: a corner there is still placed to
/// 10^-8 pixels]
inline constexpr double kReach = 1e5;

/// The pixels that a draw may touch: target, scissor, viewport's region of interest. Last is inclusive; empty
/// if last < first.
struct PixelBounds {
  int first_x = 0, first_y = 0, last_x = -1, last_y = -1;
};

/// By viewport of the draw.
using DrawBounds = std::vector<PixelBounds>;

/// Mode *ideal*: clips to 0 <= z <= w (unless depth is clamped) and w >= `kMinW`, cuts what is `kReach` view
/// volumes aside, projects, culls. [VK1.3 #vertexpostproc-clipping]
[[nodiscard]] std::vector<WindowTriangle> clip_and_project(const DrawState& state,
                                                           const ShadedVertices& vertices,
                                                           std::uint32_t instance, const DrawBounds& bounds);

/// Mode *given*: the machine's triangles of one instance, with the original primitives they come from. Throws
/// `UserError` for one that the draw does not have.
[[nodiscard]] std::vector<WindowTriangle> take_given(const DrawState& state, const ShadedVertices& vertices,
                                                     std::span<const GivenTriangle> given, int subpixel_bits,
                                                     const DrawBounds& bounds);

}  // namespace quadrille::models::reference
