#include "models/raster/clip.h"

#include <cmath>
#include <utility>

namespace quadrille::models {
namespace {

/// A vertex while it is cut: in double, so that seven cuts in a row lose nothing that fp32 would show.
struct WorkVertex {
  double x, y, z, w, b1, b2;
};
struct WorkPolygon {
  std::array<WorkVertex, kMaxClipVertices> vertices;
  int count = 0;
  void add(const WorkVertex& v) { vertices[static_cast<std::size_t>(count++)] = v; }
};

enum class Cut { kWMin, kNear, kFar, kLeft, kRight, kTop, kBottom };
constexpr std::array kCuts{Cut::kWMin,  Cut::kNear, Cut::kFar,   Cut::kLeft,
                           Cut::kRight, Cut::kTop,  Cut::kBottom};
constexpr unsigned bit(Cut plane) { return 1u << static_cast<unsigned>(plane); }

/// Distance to a clip plane, positive inside: linear in the vertex.
double distance(const WorkVertex& v, Cut plane, const ClipState& s) {
  switch (plane) {
    case Cut::kWMin: return v.w - static_cast<double>(kMinClipW);
    case Cut::kNear: return v.z;
    case Cut::kFar: return v.w - v.z;
    case Cut::kLeft: return s.guard * v.w + (v.x * s.scale_x + v.w * s.offset_x);
    case Cut::kRight: return s.guard * v.w - (v.x * s.scale_x + v.w * s.offset_x);
    case Cut::kTop: return s.guard * v.w + (v.y * s.scale_y + v.w * s.offset_y);
    case Cut::kBottom: return s.guard * v.w - (v.y * s.scale_y + v.w * s.offset_y);
  }
  return 0.0;
}

/// Exactly on the plane, so that window positions and depth stay in range however much the sum of two far
/// ends lost.
void put_on(Cut plane, const ClipState& s, WorkVertex& v) {
  switch (plane) {
    case Cut::kWMin: v.w = static_cast<double>(kMinClipW); break;
    case Cut::kNear: v.z = 0.0; break;
    case Cut::kFar: v.z = v.w; break;
    case Cut::kLeft: v.x = v.w * ((-s.guard - s.offset_x) / s.scale_x); break;
    case Cut::kRight: v.x = v.w * ((s.guard - s.offset_x) / s.scale_x); break;
    case Cut::kTop: v.y = v.w * ((-s.guard - s.offset_y) / s.scale_y); break;
    case Cut::kBottom: v.y = v.w * ((s.guard - s.offset_y) / s.scale_y); break;
  }
}

/// Where the edge from `in` (distance d_in >= 0) to `out` (d_out < 0) crosses a plane. Both ends are weighed:
/// a step from one of them would lose the other when their magnitudes are far apart.
WorkVertex crossing(const WorkVertex& in, double d_in, const WorkVertex& out, double d_out, Cut plane,
                    const ClipState& s) {
  const double length = d_in - d_out, to_in = -d_out / length, to_out = d_in / length;
  const auto mix = [=](double a, double b) { return a * to_in + b * to_out; };
  WorkVertex v{mix(in.x, out.x), mix(in.y, out.y),   mix(in.z, out.z),
               mix(in.w, out.w), mix(in.b1, out.b1), mix(in.b2, out.b2)};
  put_on(plane, s, v);
  return v;
}

/// Sutherland-Hodgman: keeps the part of the polygon inside one plane.
void cut(const WorkPolygon& in, Cut plane, const ClipState& state, WorkPolygon& out) {
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const WorkVertex& a = in.vertices[static_cast<std::size_t>(i)];
    const WorkVertex& b = in.vertices[static_cast<std::size_t>(i + 1 == in.count ? 0 : i + 1)];
    const double da = distance(a, plane, state), db = distance(b, plane, state);
    if (da >= 0.0) out.add(a);
    if (da >= 0.0 && db < 0.0) out.add(crossing(a, da, b, db, plane, state));
    if (da < 0.0 && db >= 0.0) out.add(crossing(b, db, a, da, plane, state));
  }
}

bool is_finite(const glm::vec4& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.w);
}

/// Bits of the six planes of the view volume that a vertex is outside of.
unsigned view_outcode(const glm::vec4& p, bool depth_clamp) {
  unsigned code =
      (p.x < -p.w ? 1u : 0u) | (p.x > p.w ? 2u : 0u) | (p.y < -p.w ? 4u : 0u) | (p.y > p.w ? 8u : 0u);
  if (!depth_clamp) code |= (p.z < 0.0f ? 16u : 0u) | (p.z > p.w ? 32u : 0u);
  return code;
}

/// Bits of the clip planes that a vertex is outside of.
unsigned cut_code(const WorkVertex& v, const ClipState& state) {
  unsigned code = 0;
  for (const Cut plane : kCuts) {
    if (state.depth_clamp && (plane == Cut::kNear || plane == Cut::kFar)) continue;
    if (distance(v, plane, state) < 0.0) code |= bit(plane);
  }
  return code;
}

ClipVertex narrow(const WorkVertex& v) {
  return {glm::vec4(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
                    static_cast<float>(v.w)),
          static_cast<float>(v.b1), static_cast<float>(v.b2)};
}

}  // namespace

ClipState make_clip_state(const Viewport& viewport, bool depth_clamp, int subpixel_bits) {
  ClipState state;
  state.depth_clamp = depth_clamp;
  state.guard = std::ldexp(15.0 / 16.0, kPositionBits - subpixel_bits);
  state.scale_x = static_cast<double>(viewport.width) * 0.5;
  state.offset_x = static_cast<double>(viewport.x) + state.scale_x;
  state.scale_y = static_cast<double>(viewport.height) * 0.5;
  state.offset_y = static_cast<double>(viewport.y) + state.scale_y;
  return state;
}

ClipOutcome clip_triangle(const std::array<glm::vec4, 3>& position, const ClipState& state,
                          ClippedPolygon& out) {
  if (!is_finite(position[0]) || !is_finite(position[1]) || !is_finite(position[2]))
    return ClipOutcome::kNotFinite;
  const unsigned outside = view_outcode(position[0], state.depth_clamp) &
                           view_outcode(position[1], state.depth_clamp) &
                           view_outcode(position[2], state.depth_clamp);
  if (outside != 0) return ClipOutcome::kRejected;

  WorkPolygon polygon, other;
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
  if (any == 0) return ClipOutcome::kInside;
  if (all != 0) return ClipOutcome::kRejected;
  // Every new vertex lies between two old ones, so a plane that no original vertex is outside of needs no
  // cut.
  for (const Cut plane : kCuts) {
    if ((any & bit(plane)) == 0) continue;
    cut(polygon, plane, state, other);
    std::swap(polygon, other);
    if (polygon.count < 3) return ClipOutcome::kRejected;
  }
  for (int i = 0; i < polygon.count; ++i)
    out.vertices[static_cast<std::size_t>(i)] = narrow(polygon.vertices[static_cast<std::size_t>(i)]);
  out.count = polygon.count;
  return ClipOutcome::kClipped;
}

}  // namespace quadrille::models
