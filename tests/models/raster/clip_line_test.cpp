/// Clipping of lines and points, and of polygons by planes of the user's.
#include "models/raster/clip.h"
#include "models/raster/primitives.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

using namespace quadrille::models;

namespace {

constexpr Viewport kViewport{0, 0, 64, 64, 0, 1};

ClipState state(bool depth_clamp = false) { return make_clip_state(kViewport, depth_clamp, 8); }
std::array<ClipVertex, 2> line(const glm::vec4& a, const glm::vec4& b) {
  return {ClipVertex{a, 0, 0}, ClipVertex{b, 1, 0}};
}
ClipOutcome clip(const std::array<ClipVertex, 2>& ends, ClippedLine& out, const ClipState& s = state()) {
  return clip_line(ends, s, out);
}
glm::dvec4 between(const std::array<ClipVertex, 2>& ends, double t) {
  return glm::dvec4(ends[0].position) * (1 - t) + glm::dvec4(ends[1].position) * t;
}

}  // namespace

TEST_CASE("clip_line: inside, outside, and cut at the near and the far plane") {
  ClippedLine out;
  CHECK(clip(line({0, 0, 0.5F, 1}, {0.5F, 0, 0.5F, 1}), out) == ClipOutcome::kInside);
  CHECK(clip(line({2, 0, 0.5F, 1}, {3, 0, 0.5F, 1}), out) == ClipOutcome::kRejected);
  CHECK(clip(line({0, 0, -0.5F, 1}, {0, 0, -0.25F, 1}), out) == ClipOutcome::kRejected);
  REQUIRE(clip(line({0, 0, -1, 1}, {1, 0, 2, 1}), out) == ClipOutcome::kClipped);
  CHECK(out.ends[0].position.z == 0);
  CHECK(out.ends[0].position.x == Approx(1.0 / 3));
  CHECK(out.ends[0].b1 == Approx(1.0 / 3));
  CHECK(out.ends[1].position.z == 1);
  CHECK(out.ends[1].b1 == Approx(2.0 / 3));
  CHECK(clip(line({0, 0, -1, 1}, {1, 0, 2, 1}), out, state(true)) == ClipOutcome::kInside);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(clip(line({nan, 0, 0, 1}, {1, 0, 0, 1}), out) == ClipOutcome::kNotFinite);
}

TEST_CASE("clip_line: what is left lies on the line, inside all planes, and is all that lies inside") {
  RandomSource random(7);
  const ClipState s = state();
  int cut = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto corner = [&] {
      const float w = random.real(-0.5F, 2), far = i % 3 == 0 ? 3e5F : 2.0F;
      return glm::vec4(random.real(-far, far), random.real(-far, far), random.real(-1, 2), w);
    };
    const auto ends = line(corner(), corner());
    ClippedLine out;
    const ClipOutcome outcome = clip(ends, out, s);
    const auto inside = [&](const glm::dvec4& p, double slack) {
      const double x = p.x * s.scale_x + p.w * s.offset_x, y = p.y * s.scale_y + p.w * s.offset_y;
      return p.w > 0 && p.z >= -slack && p.z <= p.w + slack && std::abs(x) <= s.guard * p.w + slack &&
             std::abs(y) <= s.guard * p.w + slack;
    };
    if (outcome == ClipOutcome::kClipped) {
      ++cut;
      for (const ClipVertex& v : out.ends) {
        const glm::dvec4 on_line = between(ends, static_cast<double>(v.b1));
        const double scale = 1e-5 * (std::abs(on_line.x) + std::abs(on_line.y) + 2);
        REQUIRE(std::abs(on_line.x - static_cast<double>(v.position.x)) <= 2 * scale + 0.1);
        REQUIRE(std::abs(on_line.z - static_cast<double>(v.position.z)) <= 1e-5);
        REQUIRE(inside(glm::dvec4(v.position), 1 + scale));
      }
      REQUIRE(out.ends[0].b1 <= out.ends[1].b1);
    }
    for (int k = 0; k <= 20; ++k) {  // points of the line that are inside must be kept
      const double t = k / 20.0;
      if (!inside(between(ends, t), -1e-3 * (1 + std::abs(between(ends, t).w)))) continue;
      const bool viewed = std::abs(between(ends, t).x) <= between(ends, t).w &&
                          std::abs(between(ends, t).y) <= between(ends, t).w;
      if (!viewed) continue;
      REQUIRE((outcome == ClipOutcome::kInside || outcome == ClipOutcome::kClipped));
      REQUIRE(t >= static_cast<double>(out.ends[0].b1) - 1e-4);
      REQUIRE(t <= static_cast<double>(out.ends[1].b1) + 1e-4);
    }
  }
  CHECK(cut > 1000);
}

TEST_CASE("clip_line: both directions are cut at the same points") {
  RandomSource random(8);
  for (int i = 0; i < 2000; ++i) {
    const auto corner = [&] {
      return glm::vec4(random.real(-2, 2), random.real(-2, 2), random.real(-1, 2), random.real(0.1F, 2));
    };
    const glm::vec4 a = corner(), b = corner();
    ClippedLine there, back;
    const ClipOutcome outcome = clip(line(a, b), there);
    REQUIRE(clip(line(b, a), back) == outcome);
    if (outcome != ClipOutcome::kClipped) continue;
    REQUIRE(there.ends[0].position == back.ends[1].position);
    REQUIRE(there.ends[1].position == back.ends[0].position);
  }
}

TEST_CASE("clip_point: a point is kept by its centre") {
  const auto kept = [](const glm::vec4& p, bool clamp = false) {
    return clip_point({p, 0, 0}, state(clamp));
  };
  CHECK(kept({0, 0, 0.5F, 1}) == ClipOutcome::kInside);
  CHECK(kept({1, -1, 0, 1}) == ClipOutcome::kInside);
  CHECK(kept({1.01F, 0, 0.5F, 1}) == ClipOutcome::kRejected);
  CHECK(kept({0, 0, 1.5F, 1}) == ClipOutcome::kRejected);
  CHECK(kept({0, 0, 1.5F, 1}, true) == ClipOutcome::kInside);
  CHECK(kept({0, 0, 0, 0}) == ClipOutcome::kRejected);
  CHECK(kept({0, 0, 0.5F, -1}) == ClipOutcome::kRejected);
  CHECK(kept({0, std::numeric_limits<float>::infinity(), 0, 1}) == ClipOutcome::kNotFinite);
}

TEST_CASE("clip: planes of the user's cut triangles and lines where the distance is 0") {
  UserDistances user(1, 0);
  user.set(0, 0, -1);
  user.set(1, 0, 1);
  user.set(2, 0, 3);
  ClippedPolygon polygon;
  const std::array<glm::vec4, 3> triangle{glm::vec4(0, 0, 0.5F, 1), glm::vec4(0.5F, 0, 0.5F, 1),
                                          glm::vec4(0, 0.5F, 0.5F, 1)};
  REQUIRE(clip_triangle(triangle, state(), polygon, &user) == ClipOutcome::kClipped);
  CHECK(polygon.count == 4);
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& v = polygon.vertices[static_cast<std::size_t>(i)];
    CHECK((1 - v.b1 - v.b2) * -1 + v.b1 + 3 * v.b2 >= -1e-6F);
  }
  ClippedLine out;
  REQUIRE(clip_line(line(triangle[0], triangle[1]), state(), out, &user) == ClipOutcome::kClipped);
  CHECK(out.ends[0].b1 == 0.5F);
  CHECK(out.ends[0].position.x == 0.25F);
  CHECK(clip_point({triangle[0], 0, 0}, state(), &user) == ClipOutcome::kRejected);
  CHECK(clip_point({triangle[1], 1, 0}, state(), &user) == ClipOutcome::kInside);
  const float inf = std::numeric_limits<float>::infinity();
  user.set(0, 0, std::numeric_limits<float>::quiet_NaN());
  CHECK(clip_point({triangle[0], 0, 0}, state(), &user) == ClipOutcome::kRejected);
  user.set(0, 0, inf);
  CHECK(clip_triangle(triangle, state(), polygon, &user) == ClipOutcome::kInside);
}

TEST_CASE("clip_primitive: cull distances drop what lies outside of one plane with all its vertices") {
  PrimitiveVertices vertices;
  vertices.position = {glm::vec4(0, 0, 0.5F, 1), glm::vec4(0.5F, 0, 0.5F, 1), glm::vec4(0, 0.5F, 0.5F, 1)};
  const auto outcome = [&](std::array<float, 3> first, std::array<float, 3> second, PieceKind kind) {
    vertices.user = UserDistances(0, 2);
    for (std::size_t i = 0; i < 3; ++i) vertices.user.set(i, 0, first[i]), vertices.user.set(i, 1, second[i]);
    ClippedPrimitive out;
    const ViewState view{kViewport, state(), {}};
    clip_primitive(vertices, {.assembled = kind, .cull_distances = 2}, std::span(&view, 1), out);
    return out.outcome;
  };
  CHECK(outcome({-1, -1, -1}, {1, 1, 1}, PieceKind::kTriangle) == ClipOutcome::kRejected);
  CHECK(outcome({-1, -1, 1}, {1, -1, -1}, PieceKind::kTriangle) == ClipOutcome::kInside);
  CHECK(outcome({-1, -1, 1}, {1, 1, 1}, PieceKind::kLine) == ClipOutcome::kRejected);
  CHECK(outcome({1, -1, -1}, {1, 1, 1}, PieceKind::kPoint) == ClipOutcome::kInside);
}

TEST_CASE("clip_primitive: a triangle's edges and corners carry its facing and their weights") {
  PrimitiveVertices vertices;
  vertices.position = {glm::vec4(0, 0, 0.5F, 1), glm::vec4(0.5F, 0, 0.5F, 1), glm::vec4(0, 0.5F, 0.5F, 1)};
  vertices.point_size = {2, 3, 400};
  ClippedPrimitive out;
  const auto clipped = [&](PolygonMode mode, FrontFace front, CullMode cull) {
    SetupState setup;
    setup.front = front;
    setup.cull = cull;
    const ViewState view{kViewport, state(), setup};
    clip_primitive(vertices, {.polygon_mode = mode, .point_size = true}, std::span(&view, 1), out);
    return out.outcome;
  };
  REQUIRE(clipped(PolygonMode::kLine, FrontFace::kClockwise, CullMode::kNone) == ClipOutcome::kInside);
  REQUIRE(out.count == 3);
  CHECK(out.pieces[0].front);
  CHECK(out.pieces[0].weights[0] == glm::vec2(0, 1));  // from the third vertex to the first
  CHECK(out.pieces[0].weights[1] == glm::vec2(0, 0));
  CHECK(out.pieces[2].weights[1] == glm::vec2(0, 1));
  REQUIRE(clipped(PolygonMode::kPoint, FrontFace::kCounterClockwise, CullMode::kNone) ==
          ClipOutcome::kInside);
  CHECK_FALSE(out.pieces[0].front);
  CHECK(out.pieces[1].point_size == 3);
  CHECK(out.pieces[2].point_size == kMaxPointSize);
  CHECK(clipped(PolygonMode::kPoint, FrontFace::kCounterClockwise, CullMode::kBack) == ClipOutcome::kCulled);
  vertices.position[2] = vertices.position[1];
  CHECK(clipped(PolygonMode::kLine, FrontFace::kClockwise, CullMode::kNone) == ClipOutcome::kCulled);
}

TEST_CASE(
    "clip_primitive: a piece carries the viewport that its first vertex chose, and none of an earlier one") {
  PrimitiveVertices vertices;
  vertices.position = {glm::vec4(0, 0, 0.5F, 1), glm::vec4(0.5F, 0, 0.5F, 1), glm::vec4(0, 0.5F, 0.5F, 1)};
  const auto output = [&](std::size_t corner, int slot) {
    if (slot < 4) return vertices.position[corner][slot];
    return std::bit_cast<float>(corner == 0 ? 1u : 7u);
  };
  const PrimitiveState state{.viewport_index = true};
  const Viewport other{8, 0, 8, 8, 0, 1};
  const std::array<ViewState, 2> views{ViewState{kViewport, make_clip_state(kViewport, false, 8), {}},
                                       ViewState{other, make_clip_state(other, false, 8), {}}};
  read_vertices(state, 4, output, vertices);
  CHECK(vertices.viewport == 1);
  ClippedPrimitive out;
  clip_primitive(vertices, state, views, out);
  REQUIRE(out.count == 1);
  CHECK(out.pieces[0].viewport == 1);
  CHECK(out.pieces[0].vertices[0].x == 12 * 256);  // the middle of the second one
  vertices.viewport = 2;
  clip_primitive(vertices, state, views, out);
  CHECK(out.pieces[0].viewport == 0);
  vertices.viewport = 1;
  clip_primitive(vertices, state, views, out);
  clip_primitive(vertices, state, std::span(views).first(1), out);
  CHECK(out.pieces[0].viewport == 0);
}
