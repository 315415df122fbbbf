#include "models/raster/clip.h"

#include "tests/models/raster/cover_count.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

using namespace quadrille::models;

namespace {

const Viewport kView{0, 0, 256, 256, 0, 1};
constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

ClipOutcome clip(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c, ClippedPolygon& out,
                 bool depth_clamp = false) {
  return clip_triangle({a, b, c}, make_clip_state(kView, depth_clamp, 8), out);
}

/// A vertex in front of, behind or beside the view volume, sometimes beyond the guard band of 2^21 pixels.
glm::vec4 wild_vertex(RandomSource& random) {
  const float spread = random.integer(0, 3) == 0 ? 1e6f : 4.0f;
  return {random.real(-spread, spread), random.real(-spread, spread), random.real(-2, 3), random.real(-2, 3)};
}

/// Bit patterns of the polygon's vertices whose weight of the third vertex is zero: those on the edge from
/// the first to the second.
std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>> on_first_edge(
    const ClippedPolygon& polygon) {
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>> points;
  const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& v = polygon.vertices[static_cast<std::size_t>(i)];
    if (v.b2 == 0.0f)
      points.insert({bits(v.position.x), bits(v.position.y), bits(v.position.z), bits(v.position.w)});
  }
  return points;
}

}  // namespace

TEST_CASE("clip: triangles that share an edge get the same points on it") {
  RandomSource random(41);
  int cut = 0;
  for (int round = 0; round < 20000; ++round) {
    const glm::vec4 a = wild_vertex(random), b = wild_vertex(random), c = wild_vertex(random),
                    d = wild_vertex(random);
    ClippedPolygon left, right;
    const ClipOutcome l = clip(a, b, c, left), r = clip(b, a, d, right);
    // then the shared edge is outside too
    if (l == ClipOutcome::kRejected || r == ClipOutcome::kRejected) continue;
    if (l == ClipOutcome::kClipped || r == ClipOutcome::kClipped) ++cut;
    if (on_first_edge(left) != on_first_edge(right)) FAIL("round " << round);
  }
  CHECK(cut > 1000);
}

TEST_CASE("clip: every vertex is inside the planes and is what its weights say") {
  RandomSource random(42);
  int vertices = 0;
  for (int round = 0; round < 20000; ++round) {
    const glm::vec4 p[3] = {wild_vertex(random), wild_vertex(random), wild_vertex(random)};
    const bool clamp = random.integer(0, 3) == 0;
    ClippedPolygon polygon;
    const ClipOutcome outcome = clip(p[0], p[1], p[2], polygon, clamp);
    if (outcome != ClipOutcome::kClipped && outcome != ClipOutcome::kInside) continue;
    REQUIRE(polygon.count >= 3);
    REQUIRE(polygon.count <= kMaxClipVertices);
    for (int i = 0; i < polygon.count; ++i, ++vertices) {
      const ClipVertex& v = polygon.vertices[static_cast<std::size_t>(i)];
      CHECK(v.position.w >= kMinClipW * 0.999f);
      if (!clamp) CHECK(v.position.z >= 0.0f);
      if (!clamp) CHECK(v.position.z <= v.position.w * 1.000001f);
      for (int k = 0; k < 4; ++k) {
        const double b1 = v.b1, b2 = v.b2, expected = p[0][k] * (1.0 - b1 - b2) + p[1][k] * b1 + p[2][k] * b2;
        // weights are floats
        const double size = std::max({std::abs(p[0][k]), std::abs(p[1][k]), std::abs(p[2][k]), 1.0f});
        if (std::abs(expected - static_cast<double>(v.position[k])) > 3e-7 * size)
          FAIL("round " << round << " vertex " << i << " component " << k);
      }
      WindowVertex w;
      if (!to_window(v.position, kView, 8, w))
        FAIL("round " << round << " vertex " << i << " has no window position");
    }
  }
  CHECK(vertices > 20000);
}

TEST_CASE("clip: corners of any magnitude leave corners that have a window position") {
  // Ends of an edge that are 10^38 apart: a cut that stepped from one of them lost the other.
  RandomSource random(44);
  constexpr float kMagnitudes[] = {1e-45f, 1e-40f, 1e-37f, 1e-30f, 1e-6f, 1.0f, 1e6f, 1e30f, 3.4e38f};
  const auto value = [&] {
    const float magnitude = kMagnitudes[random.integer(0, 8)];
    return random.integer(0, 1) == 0 ? magnitude : -magnitude;
  };
  int cut = 0;
  for (int round = 0; round < 50000; ++round) {
    glm::vec4 p[3];
    for (glm::vec4& v : p) v = {value(), value(), value(), value()};
    ClippedPolygon polygon;
    const ClipOutcome outcome = clip(p[0], p[1], p[2], polygon, random.integer(0, 1) == 0);
    if (outcome != ClipOutcome::kClipped && outcome != ClipOutcome::kInside) continue;
    for (int i = 0; i < polygon.count; ++i, ++cut) {
      WindowVertex w;
      if (!to_window(polygon.vertices[static_cast<std::size_t>(i)].position, kView, 8, w))
        FAIL("round " << round << " vertex " << i);
    }
  }
  CHECK(cut > 10000);
}

TEST_CASE("clip: a world of 1e-30 is clipped as one of 1") {
  ClippedPolygon small, plain;
  const float s = 0x1p-100f;
  const glm::vec4 a(-3, 0.5f, 0.2f, 1), b(0.5f, -0.5f, -0.2f, 0.7f), c(0.3f, 4, 0.1f, 2);
  REQUIRE(clip(a, b, c, plain, false) == ClipOutcome::kClipped);
  REQUIRE(clip(a * s, b * s, c * s, small, false) == ClipOutcome::kClipped);
  REQUIRE(small.count == plain.count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(plain.count); ++i)
    CHECK(small.vertices[i].position == plain.vertices[i].position * s);
}

TEST_CASE("clip: a floor that reaches behind the eye covers each pixel below the horizon once") {
  RandomSource random(43);
  for (int round = 0; round < 12; ++round) {
    // Eye one unit above the floor, looking along +z with 90 degrees: clip = (x, 1, z * far / (far - near)
    // ..., z), y down.
    const int cells = random.integer(1, 12);
    const float reach = round % 2 == 0 ? 40.0f : 3e5f, near = 0.05f, far = 2.0f * reach;
    const auto vertex = [&](int i, int j) {
      const float x = reach * (2.0f * static_cast<float>(i) / static_cast<float>(cells) - 1.0f);
      const float z = reach * (2.0f * static_cast<float>(j) / static_cast<float>(cells) - 1.0f) + 0.37f;
      return glm::vec4(x, 1.0f, (z - near) * (far / (far - near)), z);
    };
    CoverCount count(256, 8);
    const auto draw = [&](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) {
      ClippedPolygon polygon;
      const ClipOutcome outcome = clip(a, b, c, polygon);
      if (outcome != ClipOutcome::kInside && outcome != ClipOutcome::kClipped) return;
      std::array<WindowVertex, kMaxClipVertices> w;
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i)
        REQUIRE(to_window(polygon.vertices[i].position, kView, 8, w[i]));
      for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(polygon.count); ++i)
        count.add(w[0], w[i], w[i + 1]);
    };
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        draw(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
        draw(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
      }
    }
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        const int expected = y < 128 ? 0 : 1;
        if (y >= 124 && y <= 132) continue;  // where the floor ends, near the horizon
        if (count.at(x, y) != expected)
          FAIL("round " << round << " pixel " << x << "," << y << " covered " << count.at(x, y) << " times");
      }
    }
  }
  SUCCEED();
}

TEST_CASE("clip: decides rejection and inside and not finite") {
  ClippedPolygon out;
  const glm::vec4 a(0, 0, 0.5f, 1), b(1, 0, 0.5f, 1), c(0, 1, 0.5f, 1);
  CHECK(clip(a, b, c, out) == ClipOutcome::kInside);
  CHECK(out.count == 3);
  CHECK(clip(a, b, {0, kNan, 0, 1}, out) == ClipOutcome::kNotFinite);
  CHECK(clip(a, b, {0, 0, 0, kInf}, out) == ClipOutcome::kNotFinite);
  // right of the volume
  CHECK(clip({2, 0, 0, 1}, {3, 1, 0, 1}, {2, 5, 0, 1}, out) == ClipOutcome::kRejected);
  // nearer than near
  CHECK(clip({0, 0, -1, 1}, {1, 0, -2, 1}, {0, 1, -1, 1}, out) == ClipOutcome::kRejected);
  CHECK(clip({0, 0, -1, 1}, {1, 0, -2, 1}, {0, 1, -1, 1}, out, true) == ClipOutcome::kInside);  // depth clamp
  CHECK(clip({0, 0, 2, 1}, {1, 0, 3, 1}, {0, 1, 2, 1}, out) == ClipOutcome::kRejected);         // beyond far
  CHECK(clip({0, 0, 0, -1}, {0, 0, 0, -1}, {0, 0, 0, -1}, out) == ClipOutcome::kRejected);      // behind
  CHECK(clip({0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, out) == ClipOutcome::kRejected);         // w = 0
  // the guard band does the rest
  CHECK(clip({5, 0, 0.5f, 1}, {0, 0, 0.5f, 1}, {0, 5, 0.5f, 1}, out) == ClipOutcome::kInside);
  CHECK(clip({0, 0, -1, 1}, {1, 0, 0.5f, 1}, {0, 1, 0.5f, 1}, out) == ClipOutcome::kClipped);
  CHECK(out.count == 4);
  // beyond the guard band
  CHECK(clip({1e9f, 0, 0.5f, 1}, {0, 0, 0.5f, 1}, {0, 1, 0.5f, 1}, out) == ClipOutcome::kClipped);
}
