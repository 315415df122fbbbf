/// Distances to the planes that cut, and where edges cross them.
#include "models/raster/clip_planes.h"

#include <cmath>

namespace quadrille::models {

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

UserDistances::UserDistances(int clips, int culls) : clips_(clips), culls_(culls) {}

void UserDistances::set(std::size_t corner, std::size_t plane, float distance) {
  constexpr double kFar = 0x1p128;  // beyond every finite float
  const auto d = static_cast<double>(distance);
  distance_[corner][plane] = std::isnan(d) ? -kFar : std::isinf(d) ? std::copysign(kFar, d) : d;
}

bool UserDistances::cull(std::size_t corners) const {
  const auto first = static_cast<std::size_t>(clips_);
  for (std::size_t plane = first; plane < first + static_cast<std::size_t>(culls_); ++plane) {
    std::size_t outside = 0;
    for (std::size_t corner = 0; corner < corners; ++corner) outside += at(corner, plane) < 0.0 ? 1u : 0u;
    if (outside == corners) return true;
  }
  return false;
}

namespace clipping {
namespace {

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

}  // namespace

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

double distance(const WorkVertex& v, const UserDistances& user, std::size_t plane) {
  return (1.0 - v.b1 - v.b2) * user.at(0, plane) + (v.b1 * user.at(1, plane) + v.b2 * user.at(2, plane));
}

WorkVertex crossing(const WorkVertex& in, double d_in, const WorkVertex& out, double d_out) {
  const double length = d_in - d_out, to_in = -d_out / length, to_out = d_in / length;
  const auto mix = [=](double a, double b) { return a * to_in + b * to_out; };
  return {mix(in.x, out.x), mix(in.y, out.y),   mix(in.z, out.z),
          mix(in.w, out.w), mix(in.b1, out.b1), mix(in.b2, out.b2)};
}

WorkVertex crossing(const WorkVertex& in, double d_in, const WorkVertex& out, double d_out, Cut plane,
                    const ClipState& s) {
  WorkVertex v = crossing(in, d_in, out, d_out);
  put_on(plane, s, v);
  return v;
}

bool is_finite(const glm::vec4& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.w);
}

unsigned view_outcode(const glm::vec4& p, bool depth_clamp) {
  unsigned code =
      (p.x < -p.w ? 1u : 0u) | (p.x > p.w ? 2u : 0u) | (p.y < -p.w ? 4u : 0u) | (p.y > p.w ? 8u : 0u);
  if (!depth_clamp) code |= (p.z < 0.0f ? 16u : 0u) | (p.z > p.w ? 32u : 0u);
  return code;
}

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

}  // namespace clipping
}  // namespace quadrille::models
