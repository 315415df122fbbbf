/// Clipping in homogeneous coordinates, the viewport transform, facing and culling; and lines and points, of
/// which triangles have some when they are not filled.
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

/// What clips a primitive: the planes above, and those that its program gives distances to.
class Clipping {
 public:
  Clipping(const DrawState& state, const ShadedVertices& vertices,
           const std::array<std::uint32_t, 3>& primitive)
      : planes_(state.pipeline->depth_clamp ? kNear : kPlanes), vertices_(vertices), primitive_(primitive) {}

  [[nodiscard]] int planes() const {
    return planes_ + static_cast<int>(vertices_.distances.empty() ? 0 : vertices_.clip_distances);
  }
  [[nodiscard]] double distance(int plane, const Corner& c) const {
    if (plane < planes_) return distance_to(plane, c.clip);
    const auto at = [&](std::size_t i) {
      return user_distance(i, static_cast<std::size_t>(plane - planes_));
    };
    return (1 - c.b1 - c.b2) * at(0) + (c.b1 * at(1) + c.b2 * at(2));
  }
  /// The point of the edge inside -> outside on the plane. Always computed in this direction, so that
  /// neighbours get the same point.
  [[nodiscard]] Corner cut(int plane, const Corner& inside, const Corner& outside) const {
    const double in = distance(plane, inside), out = distance(plane, outside);
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
  /// Do all vertices lie outside of one cull plane?
  [[nodiscard]] bool culls() const {
    if (vertices_.distances.empty()) return false;
    for (std::size_t i = vertices_.clip_distances; i < vertices_.distances[0].size(); ++i) {
      if (user_distance(0, i) < 0 && user_distance(1, i) < 0 && user_distance(2, i) < 0) return true;
    }
    return false;
  }

 private:
  /// What is not a number is outside; infinity is far away.
  [[nodiscard]] double user_distance(std::size_t corner, std::size_t i) const {
    constexpr double kFar = 0x1p128;
    const double d = vertices_.distances[primitive_[corner]][i];
    return std::isnan(d) ? -kFar : std::clamp(d, -kFar, kFar);
  }

  int planes_;
  const ShadedVertices& vertices_;
  std::array<std::uint32_t, 3> primitive_;
};

std::vector<Corner> clip_polygon(const std::array<Point4, 3>& corners, const Clipping& clipping) {
  std::vector<Corner> polygon{{corners[0], 0, 0}, {corners[1], 1, 0}, {corners[2], 0, 1}};
  for (int plane = 0; plane < clipping.planes(); ++plane) {
    std::vector<Corner> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner& a = polygon[i];
      const Corner& b = polygon[(i + 1) % polygon.size()];
      const bool a_in = clipping.distance(plane, a) >= 0, b_in = clipping.distance(plane, b) >= 0;
      if (a_in) kept.push_back(a);
      if (a_in && !b_in) kept.push_back(clipping.cut(plane, a, b));
      if (!a_in && b_in) kept.push_back(clipping.cut(plane, b, a));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

/// False: nothing is left.
bool clip_segment(std::array<Corner, 2>& ends, const Clipping& clipping) {
  for (int plane = 0; plane < clipping.planes(); ++plane) {
    const bool first = clipping.distance(plane, ends[0]) >= 0,
               second = clipping.distance(plane, ends[1]) >= 0;
    if (!first && !second) return false;
    if (!first) ends[0] = clipping.cut(plane, ends[1], ends[0]);
    if (!second) ends[1] = clipping.cut(plane, ends[0], ends[1]);
  }
  return true;
}

/// Is a point's centre in the view volume?
bool keeps_point(const Corner& c, const Clipping& clipping) {
  const Point4& p = c.clip;
  if (std::abs(p[0]) > p[3] || std::abs(p[1]) > p[3]) return false;
  for (int plane = 0; plane < clipping.planes(); ++plane) {
    if (clipping.distance(plane, c) < 0) return false;
  }
  return true;
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

/// How far pixels may lie outside of the box around the corners.
double reach_of(const WindowTriangle& t) {
  switch (t.shape) {
    case Shape::kTriangle: return 0;
    case Shape::kLine: return 0.5 * t.line_width + 2;
    case Shape::kPoint: return 0.5 * t.point_size + 1;
  }
  return 0;
}

/// Does a triangle of this area show a side that is drawn? Notes which.
bool shows(const traces::Pipeline& pipeline, double area, WindowTriangle& t) {
  if (area == 0 || std::isnan(area)) return false;
  t.clockwise = area > 0;
  t.front = t.clockwise == (pipeline.front == traces::FrontFace::kClockwise);
  return pipeline.cull != (t.front ? traces::CullMode::kFront : traces::CullMode::kBack);
}

/// Facing, culling and bounds. False: nothing to draw. [VK1.3 #primsrast-polygons-basic]
bool finish(const traces::Pipeline& pipeline, const PixelBounds& bounds, WindowTriangle& t) {
  if (t.shape == Shape::kTriangle && !shows(pipeline, doubled_area(t), t)) return false;
  if (t.shape == Shape::kLine && t.x[0] == t.x[1] && t.y[0] == t.y[1]) return false;
  const double reach = reach_of(t);
  const auto [left, right] = std::minmax_element(t.x.begin(), t.x.end());
  const auto [top, bottom] = std::minmax_element(t.y.begin(), t.y.end());
  t.first_x = pixel_bound(std::floor(*left - reach - 0.5), bounds.first_x, bounds.last_x + 1);
  t.first_y = pixel_bound(std::floor(*top - reach - 0.5), bounds.first_y, bounds.last_y + 1);
  t.last_x = pixel_bound(std::ceil(*right + reach), bounds.first_x - 1, bounds.last_x);
  t.last_y = pixel_bound(std::ceil(*bottom + reach), bounds.first_y - 1, bounds.last_y);
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

namespace {

double drawn_point_size(const ShadedVertices& vertices, std::uint32_t vertex) {
  const double size = vertices.point_size.empty() ? 1 : vertices.point_size[vertex];
  return std::isnan(size) ? 1 : std::clamp(size, 1.0, 256.0);
}

Shape assembled_shape(traces::Topology topology) {
  switch (topology) {
    case traces::Topology::kPointList: return Shape::kPoint;
    case traces::Topology::kLineList:
    case traces::Topology::kLineStrip: return Shape::kLine;
    case traces::Topology::kTriangleList:
    case traces::Topology::kTriangleStrip:
    case traces::Topology::kTriangleFan: break;
  }
  return Shape::kTriangle;
}

/// Shape and state of what a draw rasterises.
WindowTriangle blank(const traces::Pipeline& pipeline) {
  WindowTriangle t;
  t.shape = assembled_shape(pipeline.topology);
  if (t.shape == Shape::kTriangle && pipeline.polygon_mode == traces::PolygonMode::kLine)
    t.shape = Shape::kLine;
  if (t.shape == Shape::kTriangle && pipeline.polygon_mode == traces::PolygonMode::kPoint)
    t.shape = Shape::kPoint;
  t.line_mode = pipeline.line_mode;
  t.line_width = static_cast<double>(pipeline.line_width);
  return t;
}

/// That the provoking vertex chooses, which is the first; the first viewport if there is none of its number.
std::uint32_t viewport_of(const DrawState& state, const ShadedVertices& vertices, const WindowTriangle& t) {
  if (vertices.viewport.empty()) return 0;
  const std::uint32_t chosen = vertices.viewport[t.vertices[0]];
  return chosen < state.pipeline->viewports ? chosen : 0;
}

/// One primitive in mode *ideal*, from its vertices to what is drawn of it.
class Projection {
 public:
  Projection(const DrawState& state, const ShadedVertices& vertices, const PixelBounds& bounds,
             const WindowTriangle& blank, std::vector<WindowTriangle>& out)
      : state_(state),
        vertices_(vertices),
        bounds_(bounds),
        blank_(blank),
        clip_(corners_of(vertices, blank.vertices)),
        clipping_(state, vertices, blank.vertices),
        out_(out) {}

  void run() {
    if (!all_finite(clip_) || clipping_.culls()) return;
    switch (assembled_shape(state_.pipeline->topology)) {
      case Shape::kTriangle: return triangle();
      case Shape::kLine: return line(0, 1);
      case Shape::kPoint: return point(0);
    }
  }

 private:
  void triangle() {
    const std::vector<Corner> polygon = clip_polygon(clip_, clipping_);
    if (blank_.shape != Shape::kTriangle) return outline(polygon);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) add({&polygon[0], &polygon[i], &polygon[i + 1]});
  }

  /// Edges or corners of a triangle that shows the right side. Edges that clipping has made are not drawn.
  void outline(const std::vector<Corner>& polygon) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      area += doubled_area(placed({&polygon[0], &polygon[i], &polygon[i + 1]}));
    if (!shows(*state_.pipeline, area, blank_)) return;
    if (blank_.shape == Shape::kLine) {
      line(2, 0);
      line(0, 1);
      line(1, 2);
    } else {
      for (const std::size_t i : {0u, 1u, 2u}) point(i);
    }
  }

  [[nodiscard]] Corner corner(std::size_t i) const {
    return {clip_[i], i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
  }

  void line(std::size_t from, std::size_t to) {
    std::array<Corner, 2> ends{corner(from), corner(to)};
    if (clip_segment(ends, clipping_)) add({&ends[0], &ends[1], &ends[1]});
  }

  void point(std::size_t i) {
    const Corner at = corner(i);
    blank_.point_size = drawn_point_size(vertices_, blank_.vertices[i]);
    if (keeps_point(at, clipping_)) add({&at, &at, &at});
  }

  [[nodiscard]] WindowTriangle placed(const std::array<const Corner*, 3>& corners) const {
    WindowTriangle t = blank_;
    for (std::size_t i = 0; i < 3; ++i) {
      project(state_.viewports[blank_.viewport], corners[i]->clip, t, i);
      t.barycentric[i] = {corners[i]->b1, corners[i]->b2};
    }
    find_screen_barycentric(clip_, t);
    return t;
  }

  void add(const std::array<const Corner*, 3>& corners) {
    WindowTriangle t = placed(corners);
    if (finish(*state_.pipeline, bounds_, t)) out_.push_back(t);
  }

  const DrawState& state_;
  const ShadedVertices& vertices_;
  const PixelBounds& bounds_;
  WindowTriangle blank_;
  std::array<Point4, 3> clip_;
  Clipping clipping_;
  std::vector<WindowTriangle>& out_;
};

}  // namespace

std::vector<WindowTriangle> clip_and_project(const DrawState& state, const ShadedVertices& vertices,
                                             std::uint32_t instance, const DrawBounds& bounds) {
  std::vector<WindowTriangle> out;
  const auto primitives = assemble(state.pipeline->topology, state.draw->count, vertices.breaks);
  WindowTriangle t = blank(*state.pipeline);
  t.instance = instance;
  for (std::uint32_t primitive = 0; primitive < primitives.size(); ++primitive) {
    t.primitive = primitive, t.vertices = distinct_of(vertices, primitives[primitive]);
    t.viewport = viewport_of(state, vertices, t);
    Projection(state, vertices, bounds[t.viewport], t, out).run();
  }
  return out;
}

std::vector<WindowTriangle> take_given(const DrawState& state, const ShadedVertices& vertices,
                                       std::span<const GivenTriangle> given, int subpixel_bits,
                                       const DrawBounds& bounds) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 60;
  std::vector<WindowTriangle> out;
  const auto primitives = assemble(state.pipeline->topology, state.draw->count, vertices.breaks);
  const double scale = std::ldexp(1.0, -subpixel_bits);
  for (const GivenTriangle& g : given) {
    if (g.primitive >= primitives.size())
      throw user_error("given triangle: draw {} has {} primitives, not number {}", g.draw, primitives.size(),
                       g.primitive);
    WindowTriangle t = blank(*state.pipeline);
    t.instance = g.instance, t.primitive = g.primitive,
    t.vertices = distinct_of(vertices, primitives[g.primitive]);
    t.viewport = viewport_of(state, vertices, t);
    t.exact = true, t.subpixel_bits = subpixel_bits;
    t.fixed_x = g.x, t.fixed_y = g.y, t.z = g.z, t.inv_w = g.inv_w, t.barycentric = g.barycentric;
    t.point_size = g.point_size, t.front = g.front;
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::max(std::abs(g.x[i]), std::abs(g.y[i])) > kLimit)
        throw user_error("given triangle: draw {}, primitive {}: a coordinate beyond 2^60", g.draw,
                         g.primitive);
      t.x[i] = static_cast<double>(g.x[i]) * scale, t.y[i] = static_cast<double>(g.y[i]) * scale;
    }
    find_screen_barycentric(corners_of(vertices, t.vertices), t);
    if (finish(*state.pipeline, bounds[t.viewport], t)) out.push_back(t);
  }
  return out;
}

}  // namespace quadrille::models::reference
