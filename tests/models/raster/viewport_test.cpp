#include "models/raster/viewport.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace quadrille::models;

namespace {

const Viewport kView{0, 0, 1920, 1080, 0, 1};
constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("viewport: corners and depth range map as the specification says") {
  const Viewport view{100, 50, 800, -600, 0.25f, 0.75f};  // flipped y
  WindowVertex v;
  REQUIRE(to_window({-2, -2, 0, 2}, view, 8, v));
  CHECK(v.x == 100 * 256);
  CHECK(v.y == 50 * 256);
  CHECK(v.z == 0.25f);
  CHECK(v.inv_w == 0.5f);
  REQUIRE(to_window({4, 4, 4, 4}, view, 8, v));
  CHECK(v.x == 900 * 256);
  CHECK(v.y == -550 * 256);
  CHECK(v.z == 0.75f);
}

TEST_CASE("viewport: positions snap to the nearest grid point and ties to even") {
  const Viewport unit{0, 0, 2, 2, 0, 1};  // window x = ndc x + 1
  const auto snapped = [&](float x) {
    WindowVertex v;
    REQUIRE(to_window({x, 0, 0, 1}, unit, 4, v));
    return v.x - 16;
  };
  CHECK(snapped(0.0f) == 0);
  CHECK(snapped(1.0f / 32) == 0);
  CHECK(snapped(3.0f / 32) == 2);
  CHECK(snapped(-1.0f / 32) == 0);
  CHECK(snapped(-3.0f / 32) == -2);
  CHECK(snapped(1.01f / 32) == 1);
}

TEST_CASE("viewport: what cannot be placed on the grid is discarded") {
  WindowVertex v;
  CHECK_FALSE(to_window({0, 0, 0, 0}, kView, 8, v));
  CHECK_FALSE(to_window({0, 0, 0, -1}, kView, 8, v));
  CHECK_FALSE(to_window({0, 0, 0, kNan}, kView, 8, v));
  CHECK_FALSE(to_window({kNan, 0, 0, 1}, kView, 8, v));
  CHECK_FALSE(to_window({0, kInf, 0, 1}, kView, 8, v));
  CHECK_FALSE(to_window({0, 0, kNan, 1}, kView, 8, v));
  CHECK_FALSE(to_window({1e30f, 0, 0, 1}, kView, 8, v));
  CHECK_FALSE(to_window({0, 0, 0, std::numeric_limits<float>::denorm_min()}, kView, 8, v));
  CHECK_FALSE(to_window({0, 0, 0, 1}, Viewport{0, 0, kNan, 10, 0, 1}, 8, v));
  REQUIRE(to_window({0, 0, 1e30f, 1}, kView, 8, v));
  CHECK(v.z == 1048576.0f);
}

TEST_CASE("viewport: pixels that may be drawn lie in viewport and scissor and target") {
  const PixelRect all{-1000, -1000, 100000, 100000};
  CHECK(drawable_rect(kView, all, 640, 480) == PixelRect{0, 0, 640, 480});
  CHECK(drawable_rect(kView, {10, 20, 30, 40}, 640, 480) == PixelRect{10, 20, 30, 40});
  CHECK(drawable_rect({10.5f, 20.6f, 10, 10, 0, 1}, all, 640, 480) ==
        PixelRect{10, 21, 20, 31});  // centres from 10.5 (inside) to before 20.5
  CHECK(drawable_rect({0, 100, 50, -40, 0, 1}, all, 640, 480) == PixelRect{0, 60, 50, 100});
  CHECK(drawable_rect({-1e30f, 0, 10, 10, 0, 1}, all, 640, 480).empty());
  CHECK(drawable_rect({0, 0, kNan, 10, 0, 1}, all, 640, 480).empty());
  CHECK(drawable_rect({0, 0, kInf, 10, 0, 1}, all, 640, 480).empty());
}
