#include "models/raster/triangle_setup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille::models {
namespace {

/// Fits f = value + dx * X + dy * Y through three vertices.
struct PlaneFitter {
  double x1, y1, x2, y2;  ///< second and third vertex minus the first, pixels
  double inv_area;
  [[nodiscard]] Plane operator()(double f0, double f1, double f2) const {
    const double d1 = f1 - f0, d2 = f2 - f0;
    return {f0, (d1 * y2 - d2 * y1) * inv_area, (d2 * x1 - d1 * x2) * inv_area};
  }
};

/// Moves all depths by the bias. They end at 0 and 1.
void move_depths(float greatest, const SetupState& state, TriangleSetup& out) {
  const double offset = depth_offset(out.z, greatest, state);
  out.z.value += offset;
  const auto moved = [offset](float z) {
    return static_cast<float>(std::clamp(static_cast<double>(z) + offset, 0.0, 1.0));
  };
  out.z_min = moved(out.z_min);
  out.z_max = moved(out.z_max);
}

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
  limit_depths(low, high, state, out);
  if (state.bias.enable) move_depths(std::max(std::abs(low), std::abs(high)), state, out);
}

/// Pixels of which a sample may lie within the bounding box.
PixelRect samples_within(const std::array<WindowVertex, 3>& v, const SetupState& state) {
  const int subpixel_bits = state.subpixel_bits;
  const auto [x_low, x_high] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [y_low, y_high] = std::minmax({v[0].y, v[1].y, v[2].y});
  const std::int32_t half = 1 << (subpixel_bits - 1);
  // ceil((low - half) / 2^s)
  const auto first = [&](std::int32_t low, std::int64_t greatest) {
    return (low - static_cast<std::int32_t>(greatest) - half + 2 * half - 1) >> subpixel_bits;
  };
  const auto end = [&](std::int32_t high, std::int64_t least) {
    return ((high - static_cast<std::int32_t>(least) - half) >> subpixel_bits) + 1;
  };
  const GridPoint &least = state.samples.low, &greatest = state.samples.high;
  return {first(x_low, greatest.x), first(y_low, greatest.y), end(x_high, least.x), end(y_high, least.y)};
}

}  // namespace

std::int64_t doubled_area(const std::array<WindowVertex, 3>& v) {
  const std::int64_t x1 = std::int64_t{v[1].x} - v[0].x, y1 = std::int64_t{v[1].y} - v[0].y;
  const std::int64_t x2 = std::int64_t{v[2].x} - v[0].x, y2 = std::int64_t{v[2].y} - v[0].y;
  return x1 * y2 - x2 * y1;
}

double depth_offset(const Plane& z, float greatest, const SetupState& state) {
  constexpr int kMantissaBits = 23;
  const double step = state.depth_step > 0 ? state.depth_step
                      : greatest > 0       ? std::ldexp(1.0, std::ilogb(greatest) - kMantissaBits)
                                           : 0.0;
  const double offset = static_cast<double>(state.bias.slope) * std::max(std::abs(z.dx), std::abs(z.dy)) +
                        static_cast<double>(state.bias.constant) * step;
  const double clamp = static_cast<double>(state.bias.clamp);
  if (clamp > 0) return std::min(offset, clamp);
  return clamp < 0 ? std::max(offset, clamp) : offset;
}

void limit_depths(float low, float high, const SetupState& state, TriangleSetup& out) {
  const float range_low = std::min(state.min_depth, state.max_depth),
              range_high = std::max(state.min_depth, state.max_depth);
  out.z_min = std::clamp(low, range_low, range_high);
  out.z_max = std::clamp(high, range_low, range_high);
}

SetupOutcome setup_triangle(const std::array<WindowVertex, 3>& vertices,
                            const std::array<glm::vec2, 3>& weights, const SetupState& state,
                            TriangleSetup& out) {
  std::array<GridPoint, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = {vertices[i].x, vertices[i].y};
  const std::int64_t area2 = doubled_area(vertices);
  if (area2 == 0) return SetupOutcome::kZeroArea;
  const bool front = is_front(area2, state);
  if (culls(front, state)) return SetupOutcome::kCulledFace;
  const PixelRect box = samples_within(vertices, state);
  if (box.empty()) return SetupOutcome::kNoSample;
  out.bounds = intersect(box, state.scissor);
  if (out.bounds.empty()) return SetupOutcome::kOffscreen;

  out.front_facing = front;
  out.whole_pixels = false;
  fit_planes(vertices, weights, area2, state, out);
  if (area2 < 0) std::swap(p[1], p[2]);
  out.edge_count = 3;
  for (std::size_t i = 0; i < 3; ++i) out.edges[i] = make_edge(p[i], p[(i + 1) % 3], state.subpixel_bits);
  return SetupOutcome::kKept;
}

}  // namespace quadrille::models
