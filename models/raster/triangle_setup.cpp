#include "models/raster/triangle_setup.h"

#include <algorithm>
#include <utility>

namespace quadrille::models {
namespace {

struct Point {
  std::int64_t x, y;
};

/// The edge from a to b of a triangle whose inside is where the value is positive (clockwise on the screen, y
/// down).
EdgeFunction make_edge(const Point& a, const Point& b, int subpixel_bits) {
  EdgeFunction edge;
  edge.a = a.y - b.y;
  edge.b = b.x - a.x;
  const bool top_left = edge.a > 0 || (edge.a == 0 && edge.b > 0);
  const std::int64_t half = std::int64_t{1} << (subpixel_bits - 1);
  const std::int64_t at_first_centre = edge.a * (half - a.x) + edge.b * (half - a.y) - (top_left ? 0 : 1);
  edge.origin = at_first_centre >> subpixel_bits;  // rounds down: keeps the sign at every centre
  return edge;
}

/// Fits f = value + dx * X + dy * Y through three vertices.
struct PlaneFitter {
  double x1, y1, x2, y2;  ///< second and third vertex minus the first, pixels
  double inv_area;
  [[nodiscard]] Plane operator()(double f0, double f1, double f2) const {
    const double d1 = f1 - f0, d2 = f2 - f0;
    return {f0, (d1 * y2 - d2 * y1) * inv_area, (d2 * x1 - d1 * x2) * inv_area};
  }
};

void fit_planes(const std::array<WindowVertex, 3>& v, const std::array<glm::vec2, 3>& weights,
                std::int64_t area2, const SetupState& state, TriangleSetup& out) {
  const double unit = 1.0 / static_cast<double>(1 << state.subpixel_bits);
  const auto pixels = [unit](std::int64_t fixed) { return static_cast<double>(fixed) * unit; };
  const PlaneFitter fit{pixels(std::int64_t{v[1].x} - v[0].x), pixels(std::int64_t{v[1].y} - v[0].y),
                        pixels(std::int64_t{v[2].x} - v[0].x), pixels(std::int64_t{v[2].y} - v[0].y),
                        1.0 / (static_cast<double>(area2) * unit * unit)};
  const auto fit_weighted = [&](auto component) {
    const auto value = [&](std::size_t i) {
      return static_cast<double>(component(weights[i])) * static_cast<double>(v[i].inv_w);
    };
    return fit(value(0), value(1), value(2));
  };
  out.ref_x = pixels(v[0].x);
  out.ref_y = pixels(v[0].y);
  out.z = fit(v[0].z, v[1].z, v[2].z);
  out.inv_w = fit(v[0].inv_w, v[1].inv_w, v[2].inv_w);
  out.persp_1 = fit_weighted([](const glm::vec2& b) { return b.x; });
  out.persp_2 = fit_weighted([](const glm::vec2& b) { return b.y; });
  out.linear_1 = fit(weights[0].x, weights[1].x, weights[2].x);
  out.linear_2 = fit(weights[0].y, weights[1].y, weights[2].y);

  const auto [low, high] = std::minmax({v[0].z, v[1].z, v[2].z});
  const float range_low = std::min(state.min_depth, state.max_depth),
              range_high = std::max(state.min_depth, state.max_depth);
  out.z_min = std::clamp(low, range_low, range_high);
  out.z_max = std::clamp(high, range_low, range_high);
}

/// Pixels whose centre lies within the bounding box.
PixelRect centres_within(const std::array<WindowVertex, 3>& v, int subpixel_bits) {
  const auto [x_low, x_high] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [y_low, y_high] = std::minmax({v[0].y, v[1].y, v[2].y});
  const std::int32_t half = 1 << (subpixel_bits - 1);
  // ceil((low - half) / 2^s)
  const auto first = [&](std::int32_t low) { return (low - half + 2 * half - 1) >> subpixel_bits; };
  const auto end = [&](std::int32_t high) { return ((high - half) >> subpixel_bits) + 1; };
  return {first(x_low), first(y_low), end(x_high), end(y_high)};
}

}  // namespace

SetupOutcome setup_triangle(const std::array<WindowVertex, 3>& vertices,
                            const std::array<glm::vec2, 3>& weights, const SetupState& state,
                            TriangleSetup& out) {
  std::array<Point, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = {vertices[i].x, vertices[i].y};
  // Twice the signed area, positive when clockwise on the screen; Vulkan's area has the opposite sign. [VK1.3
  // #primsrast-polygons-basic]
  const std::int64_t area2 = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  if (area2 == 0) return SetupOutcome::kZeroArea;
  const bool front = (area2 < 0) == (state.front == FrontFace::kCounterClockwise);
  if (state.cull == (front ? CullMode::kFront : CullMode::kBack)) return SetupOutcome::kCulledFace;
  const PixelRect box = centres_within(vertices, state.subpixel_bits);
  if (box.empty()) return SetupOutcome::kNoSample;
  out.bounds = intersect(box, state.scissor);
  if (out.bounds.empty()) return SetupOutcome::kOffscreen;

  out.front_facing = front;
  fit_planes(vertices, weights, area2, state, out);
  if (area2 < 0) std::swap(p[1], p[2]);
  for (std::size_t i = 0; i < 3; ++i) out.edges[i] = make_edge(p[i], p[(i + 1) % 3], state.subpixel_bits);
  return SetupOutcome::kKept;
}

}  // namespace quadrille::models
