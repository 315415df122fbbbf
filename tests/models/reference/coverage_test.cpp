/// Coverage: known triangles, shared edges, the top-left rule, and both modes against each other.
#include "models/reference/coverage.h"

#include "tests/models/random_source.h"
#include "tests/models/reference/test_frame.h"

#include <catch2/catch.hpp>

using namespace quadrille::models::reference;
using quadrille::models::RandomSource;

namespace {

WindowTriangle triangle(std::array<double, 3> x, std::array<double, 3> y, bool exact) {
  WindowTriangle t;
  t.x = x, t.y = y, t.exact = exact, t.subpixel_bits = 8;
  for (std::size_t i = 0; i < 3; ++i)
    t.fixed_x[i] = std::llround(x[i] * 256), t.fixed_y[i] = std::llround(y[i] * 256);
  t.clockwise = doubled_area(t) > 0;
  return t;
}

int covered_pixels(const WindowTriangle& t, int side) {
  int count = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) count += locate_sample(t, {x, y}).covered ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE(
    "coverage: a right triangle along pixel corners covers n (n + 1) / 2 pixels or n (n - 1) / 2, by the "
    "side its diagonal is on") {
  for (const bool exact : {true, false}) {
    // The diagonal runs through pixel centres. It is a right edge of the upper-left triangle, a left edge of
    // the lower-right one.
    CHECK(covered_pixels(triangle({0, 8, 0}, {0, 0, 8}, exact), 16) == 28);
    CHECK(covered_pixels(triangle({8, 8, 0}, {0, 8, 8}, exact), 16) == 36);
    // the other winding covers the same
    CHECK(covered_pixels(triangle({0, 0, 8}, {0, 8, 0}, exact), 16) == 28);
    // The other diagonal: below it the edge is a left edge.
    CHECK(covered_pixels(triangle({0, 8, 8}, {0, 0, 8}, exact), 16) == 36);
    CHECK(covered_pixels(triangle({0, 8, 0}, {0, 8, 8}, exact), 16) == 28);
  }
}

TEST_CASE("coverage: samples on top and left edges belong to the triangle, on bottom and right edges not") {
  for (const bool exact : {true, false}) {
    const WindowTriangle a = triangle({1.5, 5.5, 1.5}, {1.5, 1.5, 5.5}, exact),
                         b = triangle({5.5, 5.5, 1.5}, {1.5, 5.5, 5.5}, exact);
    CHECK(locate_sample(a, {3, 1}).covered);        // top edge
    CHECK(locate_sample(a, {1, 3}).covered);        // left edge
    CHECK_FALSE(locate_sample(b, {5, 3}).covered);  // right edge
    CHECK_FALSE(locate_sample(b, {3, 5}).covered);  // bottom edge
    CHECK(covered_pixels(a, 8) + covered_pixels(b, 8) == 16);
  }
}

TEST_CASE("coverage: a fan around a point covers every sample of its outline once") {
  RandomSource random(7);
  for (int round = 0; round < 200; ++round) {
    // Sub-pixel steps of a half make many edges run through samples.
    const double step = round % 2 == 0 ? 0.5 : 1.0 / 256;
    const auto coordinate = [&] { return std::round(static_cast<double>(random.real(0, 16)) / step) * step; };
    const double cx = coordinate(), cy = coordinate();
    const std::array<double, 4> outline_x{0, 16, 16, 0}, outline_y{0, 0, 16, 16};
    for (const bool exact : {true, false}) {
      std::array<int, 256> hits{};
      for (std::size_t i = 0; i < 4; ++i) {
        const WindowTriangle t = triangle({cx, outline_x[i], outline_x[(i + 1) % 4]},
                                          {cy, outline_y[i], outline_y[(i + 1) % 4]}, exact);
        if (doubled_area(t) == 0) continue;
        for (int p = 0; p < 256; ++p)
          hits.at(static_cast<std::size_t>(p)) += locate_sample(t, {p % 16, p / 16}).covered ? 1 : 0;
      }
      CHECK(std::all_of(hits.begin(), hits.end(), [](int n) { return n == 1; }));
    }
  }
}

TEST_CASE("coverage: unsnapped neighbours share an edge without gap or overlap") {
  RandomSource random(11);
  for (int round = 0; round < 2000; ++round) {
    const auto coordinate = [&] { return static_cast<double>(random.real(0, 16)) / 3.0 * 2.9999; };
    const std::array<double, 4> x{coordinate(), coordinate(), coordinate(), coordinate()},
        y{coordinate(), coordinate(), coordinate(), coordinate()};
    const WindowTriangle a = triangle({x[0], x[1], x[2]}, {y[0], y[1], y[2]}, false),
                         b = triangle({x[1], x[0], x[3]}, {y[1], y[0], y[3]}, false);
    if (a.clockwise != b.clockwise) continue;  // they lie on the same side of the edge
    for (int p = 0; p < 256; ++p)
      CHECK_FALSE((locate_sample(a, {p % 16, p / 16}).covered && locate_sample(b, {p % 16, p / 16}).covered));
  }
}

TEST_CASE("coverage: exact integers and doubles agree on snapped positions, huge ones too") {
  RandomSource random(3);
  for (int round = 0; round < 500; ++round) {
    const float reach = round % 2 == 0 ? 40.0f : 1e6f;
    std::array<double, 3> x{}, y{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = std::round(static_cast<double>(random.real(-reach, reach)) * 256) / 256;
      y[i] = std::round(static_cast<double>(random.real(-reach, reach)) * 256) / 256;
    }
    const WindowTriangle exact = triangle(x, y, true), ideal = triangle(x, y, false);
    for (int p = 0; p < 64; ++p) {
      const SamplePlace a = locate_sample(exact, {p % 8, p / 8}), b = locate_sample(ideal, {p % 8, p / 8});
      CHECK(a.covered == b.covered);
      for (std::size_t i = 0; i < 3; ++i) CHECK(a.weights[i] == Approx(b.weights[i]).margin(1e-9));
    }
  }
}
