/// Points: which pixels a square covers, its coordinates, and limits of its size.
#include "models/raster/point_setup.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace quadrille::models;

namespace {

SetupState state() {
  SetupState s;
  s.scissor = {0, 0, 64, 64};
  return s;
}
/// At a window position in 1/256 pixels.
WindowPoint point(std::int32_t x, std::int32_t y, float size) {
  return {{x, y, 0.5F, 1}, size, false, {0, 0}};
}

PixelRect pixels(const WindowPoint& p) {
  TriangleSetup setup;
  return setup_point(p, state(), setup) == SetupOutcome::kKept ? setup.bounds : PixelRect{};
}

}  // namespace

TEST_CASE("point_setup: a square covers the pixels whose centre it holds") {
  CHECK(pixels(point(10 * 256 + 128, 20 * 256 + 128, 1)) == PixelRect{10, 20, 11, 21});
  // on a corner of four pixels: the left and upper side belong to it
  CHECK(pixels(point(10 * 256, 20 * 256, 1)) == PixelRect{9, 19, 10, 20});
  CHECK(pixels(point(10 * 256, 20 * 256, 4)) == PixelRect{8, 18, 12, 22});
  CHECK(pixels(point(10 * 256 + 128, 20 * 256 + 128, 3)) == PixelRect{9, 19, 12, 22});
  CHECK(pixels(point(10 * 256 + 129, 20 * 256 + 127, 2)) == PixelRect{10, 19, 12, 21});
  CHECK(pixels(point(0, 0, 4)) == PixelRect{0, 0, 2, 2});
}

TEST_CASE("point_setup: every point of one pixel's size or more draws about its area") {
  for (int size = 1; size <= 8; ++size) {
    for (int x = 0; x < 256; x += 7) {
      const PixelRect r = pixels(point(20 * 256 + x, 30 * 256 + 3 * x % 256, static_cast<float>(size)));
      REQUIRE(r.x1 - r.x0 == size);
      REQUIRE(r.y1 - r.y0 == size);
    }
  }
}

TEST_CASE("point_setup: coordinates run from 0 at the upper left to 1") {
  TriangleSetup setup;
  REQUIRE(setup_point(point(10 * 256, 20 * 256, 4), state(), setup) == SetupOutcome::kKept);
  const auto at = [&](const Plane& plane, double x, double y) {
    return plane.value + plane.dx * (x - setup.ref_x) + plane.dy * (y - setup.ref_y);
  };
  CHECK(at(setup.linear_1, 8, 20) == 0);
  CHECK(at(setup.linear_1, 12, 20) == 1);
  CHECK(at(setup.linear_1, 9.5, 18) == 0.375);
  CHECK(at(setup.linear_2, 8, 18) == 0);
  CHECK(at(setup.linear_2, 8, 22) == 1);
  CHECK(setup.z_min == 0.5F);
  CHECK(setup.z_max == 0.5F);
}

TEST_CASE("point_setup: sizes are limited") {
  CHECK(point_size(0.25F) == 1);
  CHECK(point_size(-3) == 1);
  CHECK(point_size(std::numeric_limits<float>::quiet_NaN()) == 1);
  CHECK(point_size(17.5F) == 17.5F);
  CHECK(point_size(std::numeric_limits<float>::infinity()) == kMaxPointSize);
}

TEST_CASE("point_setup: a point beside the scissor is not drawn") {
  TriangleSetup setup;
  CHECK(setup_point(point(70 * 256, 20 * 256, 4), state(), setup) == SetupOutcome::kOffscreen);
}
