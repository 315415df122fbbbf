/// The planes that cut, and a vertex while it is cut: what the clipping of polygons and of lines share.
#pragma once

#include "models/raster/clip.h"

#include <array>
#include <cstdint>
#include <span>

namespace quadrille::models::clipping {

/// A vertex while it is cut: in double, so that seven cuts in a row lose nothing that fp32 would show.
struct WorkVertex {
  double x, y, z, w, b1, b2;
};

enum class Cut : std::uint8_t { kWMin, kNear, kFar, kLeft, kRight, kTop, kBottom };
inline constexpr std::array kCuts{Cut::kWMin,  Cut::kNear, Cut::kFar,   Cut::kLeft,
                                  Cut::kRight, Cut::kTop,  Cut::kBottom};
[[nodiscard]] constexpr unsigned bit(Cut plane) { return 1u << static_cast<unsigned>(plane); }

/// Distance to a clip plane, positive inside: linear in the vertex.
[[nodiscard]] double distance(const WorkVertex& v, Cut plane, const ClipState& s);
/// Distance to a plane of the user's.
[[nodiscard]] double distance(const WorkVertex& v, const UserDistances& user, std::size_t plane);
/// Where the edge from `in` (distance d_in >= 0) to `out` (d_out < 0) crosses a plane. Both ends are weighed:
/// a step from one of them would lose the other when their magnitudes are far apart.
[[nodiscard]] WorkVertex crossing(const WorkVertex& in, double d_in, const WorkVertex& out, double d_out);
/// The same, and then exactly on the plane, so that window positions and depth stay in range however much the
/// sum of two far ends lost.
[[nodiscard]] WorkVertex crossing(const WorkVertex& in, double d_in, const WorkVertex& out, double d_out,
                                  Cut plane, const ClipState& s);

[[nodiscard]] bool is_finite(const glm::vec4& p);
/// Bits of the six planes of the view volume that a vertex is outside of.
[[nodiscard]] unsigned view_outcode(const glm::vec4& p, bool depth_clamp);
/// Bits of the clip planes that a vertex is outside of.
[[nodiscard]] unsigned cut_code(const WorkVertex& v, const ClipState& state);

[[nodiscard]] ClipVertex narrow(const WorkVertex& v);

}  // namespace quadrille::models::clipping
