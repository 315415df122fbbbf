/// Clipping in homogeneous coordinates, the viewport transform, facing and culling.
#include "models/reference/primitives.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace quadrille::models::reference {
namespace {

using Point4 = std::array<double, 4>;

struct Corner {
  Point4 clip{};
  double b1 = 0, b2 = 0;
};

/// The planes that cut, in this order. The sides are far outside the view volume: what they cut away is not
/// seen, and a corner stays where doubles place it.
enum Plane : int { kEye, kLeft, kRight, kTop, kBottom, kNear, kFar, kPlanes };

/// Signed distances to the planes; positive inside.
double distance_to(int plane, const Point4& p) {
  switch (static_cast<Plane>(plane)) {
    case kEye: return p[3] - kMinW;
    case kLeft: return kReach * p[3] + p[0];
    case kRight: return kReach * p[3] - p[0];
    case kTop: return kReach * p[3] + p[1];
    case kBottom: return kReach * p[3] - p[1];
    case kNear: return p[2];
    case kFar: return p[3] - p[2];
    case kPlanes: break;
  }
  return 0;
}

/// The point of the edge inside -> outside on the plane. Always computed in this direction, so that
/// neighbours get the same point.
Corner cut(int plane, const Corner& inside, const Corner& outside) {
  const double in = distance_to(plane, inside.clip), out = distance_to(plane, outside.clip);
  // weights of both: their sum may not lose the smaller end
  const double to_outside = in / (in - out), to_inside = -out / (in - out);
  Corner corner;
  for (std::size_t c = 0; c < 4; ++c)
    corner.clip[c] = inside.clip[c] * to_inside + outside.clip[c] * to_outside;
  if (plane == kEye) corner.clip[3] = kMinW;
  corner.b1 = inside.b1 * to_inside + outside.b1 * to_outside;
  corner.b2 = inside.b2 * to_inside + outside.b2 * to_outside;
  return corner;
}

std::vector<Corner> clip_polygon(const std::array<Point4, 3>& corners, bool depth_clamp) {
  std::vector<Corner> polygon{{corners[0], 0, 0}, {corners[1], 1, 0}, {corners[2], 0, 1}};
  for (int plane = 0; plane < (depth_clamp ? kNear : kPlanes); ++plane) {
    std::vector<Corner> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner& a = polygon[i];
      const Corner& b = polygon[(i + 1) % polygon.size()];
      const bool a_in = distance_to(plane, a.clip) >= 0, b_in = distance_to(plane, b.clip) >= 0;
      if (a_in) kept.push_back(a);
      if (a_in && !b_in) kept.push_back(cut(plane, a, b));
      if (!a_in && b_in) kept.push_back(cut(plane, b, a));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

bool all_finite(const std::array<Point4, 3>& corners) {
  return std::all_of(corners.begin(), corners.end(), [](const Point4& p) {
    return std::all_of(p.begin(), p.end(), [](double c) { return std::isfinite(c); });
  });
}

/// [VK1.3 #vertexpostproc-viewport]
void project(const traces::SetViewport& v, const Point4& clip, WindowTriangle& t, std::size_t corner) {
  t.inv_w[corner] = 1.0 / clip[3];
  t.x[corner] = clip[0] / clip[3] * (v.width / 2.0) + (v.x + v.width / 2.0);
  t.y[corner] = clip[1] / clip[3] * (v.height / 2.0) + (v.y + v.height / 2.0);
  t.z[corner] = clip[2] / clip[3] * (static_cast<double>(v.max_depth) - v.min_depth) + v.min_depth;
}

/// Weights that vary linearly in the framebuffer: each corner's clip-space weights times the vertices' clip
/// w. [VK1.3 #vertexpostproc-clipping-shader-outputs]
void find_screen_barycentric(const std::array<Point4, 3>& clip, WindowTriangle& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double b1 = t.barycentric[i][0], b2 = t.barycentric[i][1];
    const double w0 = (1 - b1 - b2) * clip[0][3], w1 = b1 * clip[1][3], w2 = b2 * clip[2][3];
    t.screen_barycentric[i] = {w1 / (w0 + w1 + w2), w2 / (w0 + w1 + w2)};
  }
}

int pixel_bound(double a, int low, int high) {
  return static_cast<int>(std::clamp(a, static_cast<double>(low), static_cast<double>(high)));
}

/// Facing, culling and bounds. False: nothing to draw. [VK1.3 #primsrast-polygons-basic]
bool finish(const traces::Pipeline& pipeline, const PixelBounds& bounds, WindowTriangle& t) {
  const double area = doubled_area(t);
  if (area == 0 || std::isnan(area)) return false;
  t.clockwise = area > 0;
  t.front = t.clockwise == (pipeline.front == traces::FrontFace::kClockwise);
  if (pipeline.cull == (t.front ? traces::CullMode::kFront : traces::CullMode::kBack)) return false;
  const auto [left, right] = std::minmax_element(t.x.begin(), t.x.end());
  const auto [top, bottom] = std::minmax_element(t.y.begin(), t.y.end());
  t.first_x = pixel_bound(std::floor(*left - 0.5), bounds.first_x, bounds.last_x + 1);
  t.first_y = pixel_bound(std::floor(*top - 0.5), bounds.first_y, bounds.last_y + 1);
  t.last_x = pixel_bound(std::ceil(*right), bounds.first_x - 1, bounds.last_x);
  t.last_y = pixel_bound(std::ceil(*bottom), bounds.first_y - 1, bounds.last_y);
  return t.first_x <= t.last_x && t.first_y <= t.last_y;
}

std::array<Point4, 3> corners_of(const ShadedVertices& vertices,
                                 const std::array<std::uint32_t, 3>& triangle) {
  return {vertices.clip[triangle[0]], vertices.clip[triangle[1]], vertices.clip[triangle[2]]};
}

std::array<std::uint32_t, 3> distinct_of(const ShadedVertices& vertices,
                                         const std::array<std::uint32_t, 3>& positions) {
  return {vertices.sequence[positions[0]], vertices.sequence[positions[1]], vertices.sequence[positions[2]]};
}

}  // namespace

std::vector<WindowTriangle> clip_and_project(const DrawState& state, const ShadedVertices& vertices,
                                             std::uint32_t instance, const PixelBounds& bounds) {
  std::vector<WindowTriangle> out;
  const auto primitives = assemble(state.pipeline->topology, state.draw->count);
  for (std::uint32_t primitive = 0; primitive < primitives.size(); ++primitive) {
    WindowTriangle t;
    t.instance = instance, t.primitive = primitive, t.vertices = distinct_of(vertices, primitives[primitive]);
    const std::array<Point4, 3> clip = corners_of(vertices, t.vertices);
    if (!all_finite(clip)) continue;
    const std::vector<Corner> polygon = clip_polygon(clip, state.pipeline->depth_clamp);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const std::array<const Corner*, 3> fan{&polygon[0], &polygon[i], &polygon[i + 1]};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        project(state.viewport, fan[corner]->clip, t, corner);
        t.barycentric[corner] = {fan[corner]->b1, fan[corner]->b2};
      }
      find_screen_barycentric(clip, t);
      if (finish(*state.pipeline, bounds, t)) out.push_back(t);
    }
  }
  return out;
}

std::vector<WindowTriangle> take_given(const DrawState& state, const ShadedVertices& vertices,
                                       std::span<const GivenTriangle> given, int subpixel_bits,
                                       const PixelBounds& bounds) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 60;
  std::vector<WindowTriangle> out;
  const auto primitives = assemble(state.pipeline->topology, state.draw->count);
  const double scale = std::ldexp(1.0, -subpixel_bits);
  for (const GivenTriangle& g : given) {
    if (g.primitive >= primitives.size())
      throw user_error("given triangle: draw {} has {} primitives, not number {}", g.draw, primitives.size(),
                       g.primitive);
    WindowTriangle t;
    t.instance = g.instance, t.primitive = g.primitive,
    t.vertices = distinct_of(vertices, primitives[g.primitive]);
    t.exact = true, t.subpixel_bits = subpixel_bits;
    t.fixed_x = g.x, t.fixed_y = g.y, t.z = g.z, t.inv_w = g.inv_w, t.barycentric = g.barycentric;
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::max(std::abs(g.x[i]), std::abs(g.y[i])) > kLimit)
        throw user_error("given triangle: draw {}, primitive {}: a coordinate beyond 2^60", g.draw,
                         g.primitive);
      t.x[i] = static_cast<double>(g.x[i]) * scale, t.y[i] = static_cast<double>(g.y[i]) * scale;
    }
    find_screen_barycentric(corners_of(vertices, t.vertices), t);
    if (finish(*state.pipeline, bounds, t)) out.push_back(t);
  }
  return out;
}

}  // namespace quadrille::models::reference
