/// Cohen-Sutherland: while an end is outside, the line is cut by a plane that this end is outside of.
#include "models/raster/clip_planes.h"

#include <bit>

namespace quadrille::models {
namespace {

using namespace clipping;

WorkVertex widen(const ClipVertex& v) {
  return {v.position.x, v.position.y, v.position.z, v.position.w, v.b1, v.b2};
}

/// Bits of the planes that cut, and above them of the user's.
class Outcodes {
 public:
  Outcodes(const ClipState& state, const UserDistances* user) : state_(state), user_(user) {}
  [[nodiscard]] unsigned of(const WorkVertex& v) const {
    unsigned code = cut_code(v, state_);
    for (std::size_t plane = 0; user_ != nullptr && plane < static_cast<std::size_t>(user_->clips()); ++plane)
      code |= clipping::distance(v, *user_, plane) < 0.0 ? 1u << (kCuts.size() + plane) : 0u;
    return code;
  }
  /// Cuts the end that is outside of plane number `plane` off; the other one is inside.
  [[nodiscard]] WorkVertex cut(const WorkVertex& inside, const WorkVertex& outside, std::size_t plane) const {
    if (plane < kCuts.size()) {
      const Cut p = kCuts[plane];
      return crossing(inside, clipping::distance(inside, p, state_), outside,
                      clipping::distance(outside, p, state_), p, state_);
    }
    const std::size_t mine = plane - kCuts.size();
    return crossing(inside, clipping::distance(inside, *user_, mine), outside,
                    clipping::distance(outside, *user_, mine));
  }

 private:
  const ClipState& state_;
  const UserDistances* user_;
};

/// Cuts by every plane in `planes` that an end is still outside of; false: nothing is left. One round a
/// plane, so that rounding cannot make it go on for ever.
bool cut_line(std::array<WorkVertex, 2>& v, unsigned planes, const Outcodes& codes) {
  for (; planes != 0; planes &= planes - 1) {
    const auto plane = static_cast<std::size_t>(std::countr_zero(planes));
    const bool first = (codes.of(v[0]) >> plane & 1u) != 0, second = (codes.of(v[1]) >> plane & 1u) != 0;
    if (first && second) return false;
    if (first) v[0] = codes.cut(v[1], v[0], plane);
    if (second) v[1] = codes.cut(v[0], v[1], plane);
  }
  return true;
}

}  // namespace

ClipOutcome clip_line(const std::array<ClipVertex, 2>& ends, const ClipState& state, ClippedLine& out,
                      const UserDistances* user) {
  if (!is_finite(ends[0].position) || !is_finite(ends[1].position)) return ClipOutcome::kNotFinite;
  if ((view_outcode(ends[0].position, state.depth_clamp) &
       view_outcode(ends[1].position, state.depth_clamp)) != 0)
    return ClipOutcome::kRejected;
  const Outcodes codes(state, user);
  std::array<WorkVertex, 2> v{widen(ends[0]), widen(ends[1])};
  const unsigned first = codes.of(v[0]), second = codes.of(v[1]);
  out.ends = ends;
  if ((first | second) == 0) return ClipOutcome::kInside;
  if ((first & second) != 0 || !cut_line(v, first | second, codes)) return ClipOutcome::kRejected;
  out.ends = {narrow(v[0]), narrow(v[1])};
  return ClipOutcome::kClipped;
}

ClipOutcome clip_point(const ClipVertex& vertex, const ClipState& state, const UserDistances* user) {
  if (!is_finite(vertex.position)) return ClipOutcome::kNotFinite;
  const bool outside =
      view_outcode(vertex.position, state.depth_clamp) != 0 || Outcodes(state, user).of(widen(vertex)) != 0;
  return outside ? ClipOutcome::kRejected : ClipOutcome::kInside;
}

}  // namespace quadrille::models
