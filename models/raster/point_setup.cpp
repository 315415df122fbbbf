#include "models/raster/point_setup.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::models {
namespace {

std::int64_t size_on_grid(float size, int subpixel_bits) {
  return std::llrint(std::ldexp(static_cast<double>(size), subpixel_bits));
}

void fit_planes(const WindowPoint& p, const SetupState& state, TriangleSetup& out) {
  const double unit = std::ldexp(1.0, -state.subpixel_bits);
  const double inv_w = p.vertex.inv_w, b1 = p.weights.x, b2 = p.weights.y;
  out.ref_x = p.vertex.x * unit;
  out.ref_y = p.vertex.y * unit;
  out.z = {p.vertex.z, 0, 0};
  out.inv_w = {inv_w, 0, 0};
  out.persp_1 = {b1 * inv_w, 0, 0};
  out.persp_2 = {b2 * inv_w, 0, 0};
  const double per_pixel = 1.0 / static_cast<double>(p.size);
  out.linear_1 = p.of_triangle ? Plane{b1, 0, 0} : Plane{0.5, per_pixel, 0};
  out.linear_2 = p.of_triangle ? Plane{b2, 0, 0} : Plane{0.5, 0, per_pixel};
  limit_depths(p.vertex.z, p.vertex.z, state, out);
}

/// The square's sides, which decide its samples. With one sample a pixel its bounds do.
void set_sides(std::int64_t left, std::int64_t top, std::int64_t size, int bits, TriangleSetup& out) {
  const std::int64_t right = left + size, bottom = top + size;
  const std::array<GridPoint, 4> corner{GridPoint{left, top}, {right, top}, {right, bottom}, {left, bottom}};
  out.edge_count = 4;
  for (std::size_t i = 0; i < 4; ++i) out.edges[i] = make_edge(corner[i], corner[(i + 1) % 4], bits);
}

}  // namespace

float point_size(float wished) {
  if (std::isnan(wished)) return 1;
  return std::clamp(wished, kMinPointSize, kMaxPointSize);
}

std::int32_t point_reach(float size, int subpixel_bits) {
  return static_cast<std::int32_t>(size_on_grid(size, subpixel_bits)) / 2 + (1 << subpixel_bits);
}

SetupOutcome setup_point(const WindowPoint& point, const SetupState& state, TriangleSetup& out) {
  const int bits = state.subpixel_bits;
  const std::int64_t size = size_on_grid(point.size, bits);
  const std::int64_t left = point.vertex.x - size / 2, top = point.vertex.y - size / 2;
  const GridPoint &least = state.samples.low, &greatest = state.samples.high;
  out.bounds = {first_pixel_from(left - greatest.x, bits), first_pixel_from(top - greatest.y, bits),
                first_pixel_from(left + size - least.x, bits), first_pixel_from(top + size - least.y, bits)};
  if (out.bounds.empty()) return SetupOutcome::kNoSample;
  out.bounds = intersect(out.bounds, state.scissor);
  if (out.bounds.empty()) return SetupOutcome::kOffscreen;
  out.edge_count = 0;
  out.whole_pixels = false;
  if (state.samples.count > 1) set_sides(left, top, size, bits, out);
  out.front_facing = true;
  fit_planes(point, state, out);
  return SetupOutcome::kKept;
}

}  // namespace quadrille::models
