#include "scenes/record/depth_range.h"

#include <algorithm>
#include <vector>

namespace quadrille::scenes {
namespace {

/// How far inside plane `plane` of the view volume: -w <= x, y <= w and 0 <= z <= w.
double inside(const glm::dvec4& p, int plane) {
  switch (plane) {
    case 0: return p.w + p.x;
    case 1: return p.w - p.x;
    case 2: return p.w + p.y;
    case 3: return p.w - p.y;
    case 4: return p.z;
    default: return p.w - p.z;
  }
}

/// A plane at a time. [P: Sutherland and Hodgman 1974]
std::vector<glm::dvec4> clipped(std::vector<glm::dvec4> polygon) {
  for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
    std::vector<glm::dvec4> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec4 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double from = inside(a, plane), to = inside(b, plane);
      if (from >= 0) kept.push_back(a);
      if ((from < 0) != (to < 0)) kept.push_back(a + (b - a) * (from / (from - to)));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

}  // namespace

void DepthRangeFinder::add(const Triangle& corners) {
  for (const glm::dvec4& p : clipped({corners.begin(), corners.end()})) {
    if (!(p.w > 0)) continue;
    least_ = std::min(least_, p.z / p.w);
    greatest_ = std::max(greatest_, p.z / p.w);
  }
}

std::optional<DepthRange> DepthRangeFinder::range() const {
  if (!(least_ <= greatest_)) return std::nullopt;
  return DepthRange{static_cast<float>(least_), static_cast<float>(greatest_)};
}

}  // namespace quadrille::scenes
