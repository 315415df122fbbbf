#include "models/raster/triangle_setup.h"

#include "tests/models/raster/brute_force.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace quadrille::models;

namespace {

WindowVertex at(int x, int y) { return {x, y, 0.5f, 1.0f}; }
// On the screen, y down: right along the top, then down, is clockwise.
const std::array<WindowVertex, 3> kClockwise{at(0, 0), at(2560, 0), at(0, 2560)};
const std::array<WindowVertex, 3> kCounterClockwise{at(0, 0), at(0, 2560), at(2560, 0)};

SetupOutcome outcome(const std::array<WindowVertex, 3>& v, const SetupState& state) {
  TriangleSetup t;
  return setup_triangle(v, whole_triangle_weights(), state, t);
}

SetupState state_of(CullMode cull, FrontFace front) {
  SetupState s;
  s.cull = cull;
  s.front = front;
  s.scissor = {0, 0, 100, 100};
  return s;
}

}  // namespace

TEST_CASE("triangle_setup: faces follow the winding on the screen") {
  for (const FrontFace front : {FrontFace::kClockwise, FrontFace::kCounterClockwise}) {
    for (const bool clockwise : {false, true}) {
      const auto& v = clockwise ? kClockwise : kCounterClockwise;
      const bool is_front = clockwise == (front == FrontFace::kClockwise);
      TriangleSetup t;
      REQUIRE(setup_triangle(v, whole_triangle_weights(), state_of(CullMode::kNone, front), t) ==
              SetupOutcome::kKept);
      CHECK(t.front_facing == is_front);
      CHECK(outcome(v, state_of(CullMode::kFront, front)) ==
            (is_front ? SetupOutcome::kCulledFace : SetupOutcome::kKept));
      CHECK(outcome(v, state_of(CullMode::kBack, front)) ==
            (is_front ? SetupOutcome::kKept : SetupOutcome::kCulledFace));
    }
  }
}

TEST_CASE("triangle_setup: says why a triangle makes no pixels") {
  const SetupState s = state_of(CullMode::kNone, FrontFace::kClockwise);
  CHECK(outcome({at(0, 0), at(256, 256), at(512, 512)}, s) == SetupOutcome::kZeroArea);
  CHECK(outcome({at(7, 7), at(7, 7), at(900, 512)}, s) == SetupOutcome::kZeroArea);
  // between the centres at 128 and 384
  CHECK(outcome({at(130, 130), at(380, 130), at(130, 380)}, s) == SetupOutcome::kNoSample);
  // a vertex on a centre
  CHECK(outcome({at(128, 128), at(380, 130), at(130, 380)}, s) == SetupOutcome::kKept);
  CHECK(outcome({at(-2560, 0), at(-300, 0), at(-300, 900)}, s) == SetupOutcome::kOffscreen);
  CHECK(outcome({at(100 * 256, 0), at(110 * 256, 0), at(100 * 256, 900)}, s) == SetupOutcome::kOffscreen);
  // an empty scissor
  CHECK(outcome({at(0, 0), at(2560, 0), at(0, 2560)}, SetupState{}) == SetupOutcome::kOffscreen);
}

TEST_CASE("triangle_setup: bounds hold exactly the pixels with centres in the bounding box") {
  RandomSource random(21);
  for (int round = 0; round < 2000; ++round) {
    const int bits = random.integer(4, 12), one = 1 << bits;
    const auto v = awkward_triangle(random, 32, bits);
    TriangleSetup t;
    if (setup_in_square(v, 32, bits, t) != SetupOutcome::kKept) continue;
    const auto [x_low, x_high] = std::minmax({v[0].x, v[1].x, v[2].x});
    for (int x = 0; x < 32; ++x) {
      const std::int64_t centre = std::int64_t{x} * one + one / 2;
      CHECK((x >= t.bounds.x0 && x < t.bounds.x1) == (centre >= x_low && centre <= x_high));
    }
  }
}

TEST_CASE("triangle_setup: planes pass through the vertices") {
  RandomSource random(22);
  for (int round = 0; round < 2000; ++round) {
    std::array<WindowVertex, 3> v;
    for (WindowVertex& p : v)
      p = {random.integer(0, 25600), random.integer(0, 25600), random.real(0, 1), random.real(0.1f, 3.0f)};
    TriangleSetup t;
    if (setup_in_square(v, 100, 8, t) != SetupOutcome::kKept) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = v[i].x / 256.0 - t.ref_x, y = v[i].y / 256.0 - t.ref_y;
      const auto value = [&](const Plane& p) { return p.value + p.dx * x + p.dy * y; };
      CHECK(value(t.z) == Approx(v[i].z).margin(1e-9));
      CHECK(value(t.inv_w) == Approx(v[i].inv_w).margin(1e-9));
      CHECK(value(t.persp_1) == Approx(i == 1 ? v[i].inv_w : 0.0f).margin(1e-9));
      CHECK(value(t.persp_2) == Approx(i == 2 ? v[i].inv_w : 0.0f).margin(1e-9));
      CHECK(value(t.linear_1) == Approx(i == 1 ? 1.0 : 0.0).margin(1e-9));
      CHECK(value(t.linear_2) == Approx(i == 2 ? 1.0 : 0.0).margin(1e-9));
    }
  }
}

TEST_CASE("triangle_setup: the depth range is that of the vertices within the viewport") {
  std::array<WindowVertex, 3> v = kClockwise;
  v[0].z = -3.0f;
  v[1].z = 0.25f;
  v[2].z = 7.0f;
  SetupState s = state_of(CullMode::kNone, FrontFace::kClockwise);
  s.min_depth = 0.75f;  // an inverted depth range
  s.max_depth = 0.125f;
  TriangleSetup t;
  REQUIRE(setup_triangle(v, whole_triangle_weights(), s, t) == SetupOutcome::kKept);
  CHECK(t.z_min == 0.125f);
  CHECK(t.z_max == 0.75f);
}
