/// Clipping in homogeneous clip space: triangles as polygons (Sutherland-Hodgman), lines by the outcodes of
/// their ends (Cohen-Sutherland), points by their centre. [VK1.3 #vertexpostproc-clipping]
///
/// Order of decisions: a vertex that is not finite discards the triangle; a triangle wholly outside one plane
/// of the view volume is rejected; then it is cut by w >= kMinClipW and, unless depth is clamped, by 0 <= z
/// <= w. The sides of the view volume do not cut (the scissor does that later); only a triangle with a vertex
/// beyond the guard band is cut there, so that window positions fit their grid. A cut is computed from the
/// inside vertex to the outside one, in double, from that edge's two end points alone: two triangles that
/// share the edge get the same point. Planes of the user's cut last.
#pragma once

#include "models/raster/viewport.h"
#include "models/shader/isa.h"

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>

namespace quadrille::models {

/// Smallest w that is kept. [G: below the near plane of any world that a float can hold, far enough above the
/// least normal float that w and 1 / w are both normal, with all their bits]
inline constexpr float kMinClipW = 0x1p-120f;
/// Three vertices, and one more for each of seven planes and of the user's.
inline constexpr int kMaxClipVertices = 10 + kMaxUserDistances;

struct ClipVertex {
  glm::vec4 position{0};
  /// weights of the original triangle's second and third vertex (the first has 1 - b1 - b2)
  float b1 = 0, b2 = 0;
};

/// A convex polygon; its triangles are the fan (0, i, i + 1), i = 1 .. count - 2.
struct ClippedPolygon {
  std::array<ClipVertex, kMaxClipVertices> vertices;
  int count = 0;
};

enum class ClipOutcome : std::uint8_t {
  kInside,    ///< not cut: the polygon is the triangle
  kClipped,   ///< cut; the polygon has 3 or more vertices
  kRejected,  ///< nothing is left
  kCulled,    ///< a triangle drawn as lines or points that faces the way that is culled, or has no area
  kNotFinite  ///< discarded: a coordinate is NaN or infinite
};

/// What a draw's clipper needs: made once a draw.
struct ClipState {
  bool depth_clamp = false;
  double guard = 0;                                             ///< pixels: |window x|, |window y| kept
  double scale_x = 0, offset_x = 0, scale_y = 0, offset_y = 0;  ///< viewport: window = ndc * scale + offset
};
/// The guard band is 15/16 of the window grid: the rest absorbs fp32 rounding of the viewport transform.
[[nodiscard]] ClipState make_clip_state(const Viewport& viewport, bool depth_clamp, int subpixel_bits);

/// What a primitive's vertices wrote to gl_ClipDistance (the first `clips` planes) and gl_CullDistance (the
/// `culls` after them). An infinite distance is kept as a very large one; what is not a number is far
/// outside.
class UserDistances {
 public:
  UserDistances(int clips, int culls);
  [[nodiscard]] int clips() const { return clips_; }
  [[nodiscard]] int culls() const { return culls_; }
  void set(std::size_t corner, std::size_t plane, float distance);
  [[nodiscard]] double at(std::size_t corner, std::size_t plane) const { return distance_[corner][plane]; }
  /// Is each of the first `corners` vertices outside of one cull plane, the same for all?
  /// [VK1.3 #interfaces-builtin-variables: CullDistance]
  [[nodiscard]] bool cull(std::size_t corners) const;

 private:
  int clips_, culls_;
  std::array<std::array<double, kMaxUserDistances>, 3> distance_{};
};

/// Clips one triangle. `out` is written when the outcome is kInside or kClipped.
[[nodiscard]] ClipOutcome clip_triangle(const std::array<glm::vec4, 3>& position, const ClipState& state,
                                        ClippedPolygon& out, const UserDistances* user = nullptr);

struct ClippedLine {
  std::array<ClipVertex, 2> ends;
};
/// Clips the line between two vertices of a primitive, with these weights of its second and third vertex;
/// `out` likewise. A line is cut where it leaves the guard band, not the view volume, as a triangle is.
[[nodiscard]] ClipOutcome clip_line(const std::array<ClipVertex, 2>& ends, const ClipState& state,
                                    ClippedLine& out, const UserDistances* user = nullptr);

/// kInside, kRejected or kNotFinite: a point is kept if its centre is in the view volume. `vertex` of the
/// primitive, whose weights it has.
[[nodiscard]] ClipOutcome clip_point(const ClipVertex& vertex, const ClipState& state,
                                     const UserDistances* user = nullptr);

}  // namespace quadrille::models
