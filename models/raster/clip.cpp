/// Sutherland-Hodgman: a polygon is cut by one plane after the other.
#include "models/raster/clip_planes.h"

#include <utility>

namespace quadrille::models {
namespace {

using namespace clipping;

struct WorkPolygon {
  std::array<WorkVertex, kMaxClipVertices> vertices;
  int count = 0;
  void add(const WorkVertex& v) { vertices[static_cast<std::size_t>(count++)] = v; }
};

/// Keeps the part of the polygon inside one plane. `cross(a, da, b, db)`: where an edge crosses it.
template <class Distance, class Cross>
void cut(const WorkPolygon& in, const Distance& distance_of, const Cross& cross, WorkPolygon& out) {
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const WorkVertex& a = in.vertices[static_cast<std::size_t>(i)];
    const WorkVertex& b = in.vertices[static_cast<std::size_t>(i + 1 == in.count ? 0 : i + 1)];
    const double da = distance_of(a), db = distance_of(b);
    if (da >= 0.0) out.add(a);
    if (da >= 0.0 && db < 0.0) out.add(cross(a, da, b, db));
    if (da < 0.0 && db >= 0.0) out.add(cross(b, db, a, da));
  }
}

/// Cuts by the planes in `planes`; false when nothing is left.
bool cut_by_planes(WorkPolygon& polygon, unsigned planes, const ClipState& state) {
  WorkPolygon other;
  for (const Cut plane : kCuts) {
    if ((planes & bit(plane)) == 0) continue;
    cut(
        polygon, [&](const WorkVertex& v) { return distance(v, plane, state); },
        [&](const WorkVertex& in, double d_in, const WorkVertex& out, double d_out) {
          return crossing(in, d_in, out, d_out, plane, state);
        },
        other);
    std::swap(polygon, other);
    if (polygon.count < 3) return false;
  }
  return true;
}

/// Planes of the user's that a corner is outside of.
unsigned user_planes(const UserDistances& user) {
  unsigned planes = 0;
  for (std::size_t plane = 0; plane < static_cast<std::size_t>(user.clips()); ++plane) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      planes |= user.at(corner, plane) < 0.0 ? 1u << plane : 0u;
  }
  return planes;
}

bool cut_by_user(WorkPolygon& polygon, unsigned planes, const UserDistances& user) {
  WorkPolygon other;
  for (std::size_t plane = 0; planes >> plane != 0; ++plane) {
    if ((planes >> plane & 1u) == 0) continue;
    cut(
        polygon, [&](const WorkVertex& v) { return distance(v, user, plane); },
        [](const WorkVertex& in, double d_in, const WorkVertex& out, double d_out) {
          return crossing(in, d_in, out, d_out);
        },
        other);
    std::swap(polygon, other);
    if (polygon.count < 3) return false;
  }
  return true;
}

}  // namespace

ClipOutcome clip_triangle(const std::array<glm::vec4, 3>& position, const ClipState& state,
                          ClippedPolygon& out, const UserDistances* user) {
  if (!is_finite(position[0]) || !is_finite(position[1]) || !is_finite(position[2]))
    return ClipOutcome::kNotFinite;
  const unsigned outside = view_outcode(position[0], state.depth_clamp) &
                           view_outcode(position[1], state.depth_clamp) &
                           view_outcode(position[2], state.depth_clamp);
  if (outside != 0) return ClipOutcome::kRejected;

  WorkPolygon polygon;
  unsigned any = 0, all = ~0u;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec4& p = position[i];
    const WorkVertex v{p.x, p.y, p.z, p.w, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    const unsigned code = cut_code(v, state);
    any |= code;
    all &= code;
    polygon.add(v);
    out.vertices[i] = narrow(v);
  }
  out.count = 3;
  const unsigned by_user = user != nullptr ? user_planes(*user) : 0;
  if ((any | by_user) == 0) return ClipOutcome::kInside;
  if (all != 0) return ClipOutcome::kRejected;
  // Every new vertex lies between two old ones, so a plane that no original vertex is outside of needs no
  // cut.
  if (!cut_by_planes(polygon, any, state)) return ClipOutcome::kRejected;
  if (by_user != 0 && !cut_by_user(polygon, by_user, *user)) return ClipOutcome::kRejected;
  for (int i = 0; i < polygon.count; ++i)
    out.vertices[static_cast<std::size_t>(i)] = narrow(polygon.vertices[static_cast<std::size_t>(i)]);
  out.count = polygon.count;
  return ClipOutcome::kClipped;
}

}  // namespace quadrille::models
