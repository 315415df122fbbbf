#include "scenes/data/animation.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace quadrille::scenes;

namespace {

Keyframes scalars(Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
  return {interpolation, 1, false, std::move(times), std::move(values)};
}

/// A turn around z by an angle, as (x, y, z, w).
std::array<float, 4> turn(double angle) {
  return {0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))};
}

Keyframes turns(const std::array<float, 4>& a, const std::array<float, 4>& b) {
  Keyframes keys{Interpolation::kLinear, 4, true, {0, 1}, {}};
  keys.values.insert(keys.values.end(), a.begin(), a.end());
  keys.values.insert(keys.values.end(), b.begin(), b.end());
  return keys;
}

}  // namespace

TEST_CASE("animation: before the first key is the first value, after the last the last") {
  for (const Interpolation how : {Interpolation::kStep, Interpolation::kLinear}) {
    const Keyframes keys = scalars(how, {1, 2, 4}, {10, 20, 40});
    CHECK(value_at(keys, 0)[0] == 10);
    CHECK(value_at(keys, 1)[0] == 10);
    CHECK(value_at(keys, 4)[0] == 40);
    CHECK(value_at(keys, 1e9)[0] == 40);
  }
  const Keyframes cubic = scalars(Interpolation::kCubicSpline, {1, 2}, {9, 10, 9, 9, 20, 9});
  CHECK(value_at(cubic, 0)[0] == 10);
  CHECK(value_at(cubic, 3)[0] == 20);
}

TEST_CASE("animation: a step holds until the next key, a line goes straight") {
  CHECK(value_at(scalars(Interpolation::kStep, {1, 2, 4}, {10, 20, 40}), 3.999)[0] == 20);
  CHECK(value_at(scalars(Interpolation::kLinear, {1, 2, 4}, {10, 20, 40}), 3)[0] == 30);
  CHECK(value_at(scalars(Interpolation::kLinear, {1, 2, 4}, {10, 20, 40}), 1.25)[0] == 12.5);
}

TEST_CASE("animation: a cubic spline is Hermite's with tangents a second") {
  // Tangent in, value, tangent out of each key, at 1 s and 3 s.
  const float out = 3, to = 5, in = -2, from = 1;
  const Keyframes keys = scalars(Interpolation::kCubicSpline, {1, 3}, {7, from, out, in, to, 7});
  for (const double t : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t),
                 h01 = t * t * (3 - 2 * t), h11 = t * t * (t - 1);
    const double expected = h00 * from + h10 * 2 * out + h01 * to + h11 * 2 * in;
    CHECK(value_at(keys, 1 + 2 * t)[0] == Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE("animation: a cubic spline whose tangents are the chord is a line") {
  const Keyframes keys = scalars(Interpolation::kCubicSpline, {0, 2}, {0, 10, 4, 4, 18, 0});
  for (const double time : {0.1, 0.7, 1.0, 1.9}) CHECK(value_at(keys, time)[0] == Approx(10 + 4 * time));
}

TEST_CASE("animation: rotations go along the arc at even speed, the shorter way") {
  const double quarter = std::acos(0.0);
  for (const double t : {0.25, 0.5, 0.75}) {
    const auto q = value_at(turns(turn(0), turn(quarter)), t);
    CHECK(q[2] == Approx(std::sin(t * quarter / 2)).margin(1e-7));
    CHECK(q[3] == Approx(std::cos(t * quarter / 2)));
  }
  // The same turn with the opposite sign: half way must not pass through the far side.
  std::array<float, 4> opposite = turn(quarter);
  for (float& v : opposite) v = -v;
  const auto half = value_at(turns(turn(0), opposite), 0.5);
  CHECK(std::abs(half[3]) == Approx(std::cos(quarter / 4)));
}

TEST_CASE(
    "animation: rotations that hardly differ, and ones that are not of unit length, give unit quaternions") {
  const auto near = value_at(turns(turn(0.3), turn(0.3 + 1e-6)), 0.5);
  CHECK(std::hypot(near[2], near[3]) == Approx(1));
  const auto halves = value_at(turns({0, 0, 0, 0.5F}, {0, 0, 0.5F, 0}), 0.5);  // a half turn, half way
  CHECK(halves[2] == Approx(std::sqrt(0.5)));
  CHECK(halves[3] == Approx(std::sqrt(0.5)));
}
