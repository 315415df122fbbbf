/// Which raster engines a triangle goes to: all that own a tile it covers, few others, and at least one.
#include "models/raster/engine.h"
#include "models/raster/coarse.h"
#include "models/raster/triangle_setup.h"

#include <catch2/catch.hpp>

#include <bit>
#include <random>

using namespace quadrille::models;

namespace {

constexpr int kBits = 8;
constexpr std::uint32_t kWidth = 200, kHeight = 120;

std::array<WindowVertex, 3> random_triangle(std::mt19937& random, std::int32_t size) {
  const auto below = [&](std::int32_t end) {
    return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(end));
  };
  const std::int32_t x = below(260 << kBits) - (30 << kBits), y = below(180 << kBits) - (30 << kBits);
  std::array<WindowVertex, 3> triangle;
  for (WindowVertex& v : triangle) v = {x + below(size << kBits), y + below(size << kBits), 0.5F, 1.0F};
  return triangle;
}

}  // namespace

TEST_CASE("engine: a triangle goes to every engine that owns a tile of it") {
  std::mt19937 random(7);
  for (const std::uint32_t engines : {1u, 2u, 4u, 8u}) {
    const ScreenShare share{2 * engines, engines};
    std::size_t sent = 0, needed = 0;
    for (int i = 0; i < 4000; ++i) {
      const std::array<WindowVertex, 3> triangle = random_triangle(random, i % 3 == 0 ? 12 : 90);
      const std::uint32_t touched =
          engines_touched(triangle, 0, kBits, kWidth, kHeight, share, static_cast<std::uint32_t>(i));
      REQUIRE(touched != 0);
      REQUIRE((touched >> engines) == 0);
      SetupState state{CullMode::kNone, FrontFace::kCounterClockwise, {0, 0, kWidth, kHeight}, kBits, 0, 1};
      const std::array<glm::vec2, 3> weights{glm::vec2(0, 0), {1, 0}, {0, 1}};
      TriangleSetup setup;
      if (setup_triangle(triangle, weights, state, setup) != SetupOutcome::kKept) continue;
      std::uint32_t owners = 0;
      TileWalk walk(setup);
      for (TileHit tile; walk.next(tile);)
        owners |= 1u << share.engine_of_tile(static_cast<std::uint32_t>(tile.tile_x),
                                             static_cast<std::uint32_t>(tile.tile_y));
      CHECK((owners & ~touched) == 0);
      sent += static_cast<std::size_t>(std::popcount(touched));
      needed += static_cast<std::size_t>(std::popcount(owners));
    }
    INFO(engines << " engines: " << sent << " sent, " << needed << " needed");
    CHECK(static_cast<double>(sent) <= 1.25 * static_cast<double>(needed));
  }
}

TEST_CASE("engine: what touches no tile of the screen goes to the engines in turn") {
  const std::array<WindowVertex, 3> outside{
      WindowVertex{-900 << kBits, 0, 0, 1}, {-800 << kBits, 0, 0, 1}, {-800 << kBits, 50 << kBits, 0, 1}};
  for (std::uint32_t turn = 0; turn < 8; ++turn)
    CHECK(engines_touched(outside, 0, kBits, kWidth, kHeight, {4, 4}, turn) == 1u << turn % 4);
}

TEST_CASE("engine: each engine has an equal part of the screen") {
  for (const std::uint32_t engines : {2u, 4u, 8u}) {
    const ScreenShare share{engines, engines};
    std::array<int, 8> tiles{};
    for (std::uint32_t y = 0; y < 64; ++y) {
      for (std::uint32_t x = 0; x < 64; ++x) ++tiles[share.engine_of_tile(x, y)];
    }
    for (std::uint32_t e = 0; e < engines; ++e) CHECK(tiles[e] == static_cast<int>(64 * 64 / engines));
  }
}

TEST_CASE("engine: pixels beyond the box count by how far they reach") {
  // A point in the middle of its tile, whose square reaches into the next one.
  const WindowVertex at{4 << kBits, 4 << kBits, 0, 1};
  const ScreenShare share{2, 2};
  const auto engines = [&](std::int32_t pixels) {
    return engines_touched({at, at, at}, pixels << kBits, kBits, kWidth, kHeight, share, 0);
  };
  CHECK(engines(2) == 1u << share.engine_of_tile(0, 0));
  CHECK(engines(40) == 3u);
}
