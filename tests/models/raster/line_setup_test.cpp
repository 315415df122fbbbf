/// Lines: the diamond-exit rule by brute force, joints of strips, rectangles, planes along the line.
#include "models/raster/line_setup.h"
#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <utility>

using namespace quadrille::models;

namespace {

__extension__ using Wide = __int128;
using Pixels = std::set<std::pair<int, int>>;

constexpr PixelRect kScissor{-40, -40, 80, 80};

SetupState state_of(int bits, LineMode mode = LineMode::kBresenham, float width = 1) {
  SetupState state;
  state.scissor = kScissor;
  state.subpixel_bits = bits;
  state.line_mode = mode;
  state.line_width = width;
  return state;
}

std::array<LineEnd, 2> line(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
  return {LineEnd{{x0, y0, 0.25F, 1.0F}, {0, 0}}, LineEnd{{x1, y1, 0.75F, 0.5F}, {1, 0}}};
}

/// What the rasteriser makes of it: tile by tile.
Pixels drawn(const TriangleSetup& setup) {
  Pixels pixels;
  TileWalk walk(setup);
  for (TileHit tile; walk.next(tile);) {
    const std::uint64_t mask =
        tile.fully_covered ? ~std::uint64_t{0} : tile_coverage(setup, tile.tile_x, tile.tile_y);
    for (int entry = 0; entry < kTilePixels; ++entry) {
      if ((mask >> entry & 1u) != 0)
        pixels.emplace(8 * tile.tile_x + entry_x(entry), 8 * tile.tile_y + entry_y(entry));
    }
  }
  return pixels;
}

Pixels drawn(const std::array<LineEnd, 2>& ends, const SetupState& state) {
  TriangleSetup setup;
  return setup_line(ends, state, setup) == SetupOutcome::kKept ? drawn(setup) : Pixels{};
}

/// The rule word for word, in exact numbers: positions in 2^-40 of a grid unit, moved up by 1 and left by
/// 2^20.
class DiamondExit {
 public:
  DiamondExit(const std::array<LineEnd, 2>& ends, int bits)
      : half_(kUnit << (bits - 1)), one_(kUnit << bits), a_(place(ends[0])), b_(place(ends[1])) {}
  [[nodiscard]] bool draws(int x, int y) const {
    const Position centre{x * one_ + half_, y * one_ + half_};
    return meets_diamond(centre) && !inside(b_, centre);
  }

 private:
  static constexpr Wide kUnit = Wide{1} << 40;
  struct Position {
    Wide x, y;
  };
  static Position place(const LineEnd& end) {
    return {end.vertex.x * kUnit - (Wide{1} << 20), end.vertex.y * kUnit - 1};
  }
  static Wide magnitude(Wide v) { return v < 0 ? -v : v; }
  [[nodiscard]] bool inside(const Position& p, const Position& centre) const {
    return magnitude(p.x - centre.x) + magnitude(p.y - centre.y) < half_;
  }
  /// Is there a t in 0..1 with all four sides' distances below a half? The bounds of t are fractions.
  [[nodiscard]] bool meets_diamond(const Position& centre) const {
    Wide low = 0, low_of = 1, high = 1, high_of = 1;
    bool low_open = false, high_open = false;
    for (const int sx : {-1, 1}) {
      for (const int sy : {-1, 1}) {
        const Wide at_a = sx * (a_.x - centre.x) + sy * (a_.y - centre.y) - half_;
        const Wide at_b = sx * (b_.x - centre.x) + sy * (b_.y - centre.y) - half_;
        if (at_a >= 0 && at_b >= 0) return false;
        if (at_a < 0 && at_b < 0) continue;
        const Wide t = at_a < 0 ? -at_a : at_a, of = at_a < 0 ? at_b - at_a : at_a - at_b;
        if (at_a >= 0 && exceeds(t, of, low, low_of)) low = t, low_of = of, low_open = true;
        if (at_a < 0 && exceeds(high, high_of, t, of)) high = t, high_of = of, high_open = true;
      }
    }
    const bool order = exceeds(high, high_of, low, low_of);
    return order || (!low_open && !high_open);
  }
  /// a / b > c / d, of positive denominators; 2^63 at most each.
  static bool exceeds(Wide a, Wide b, Wide c, Wide d) { return a * d > c * b; }

  Wide half_, one_;
  Position a_, b_;
};

Pixels by_rule(const std::array<LineEnd, 2>& ends, int bits) {
  const DiamondExit rule(ends, bits);
  Pixels pixels;
  for (int y = -4; y < 20; ++y) {
    for (int x = -4; x < 20; ++x) {
      if (rule.draws(x, y)) pixels.emplace(x, y);
    }
  }
  return pixels;
}

}  // namespace

TEST_CASE("line_setup: Bresenham lines are those of the diamond-exit rule") {
  RandomSource random(1);
  for (int i = 0; i < 6000; ++i) {
    const int bits = 4;
    // Half of them on a coarse grid, where ends lie on boundaries of pixels and diamonds.
    const int step = i % 2 == 0 ? 1 : 4;
    const auto at = [&] { return step * random.integer(0, 256 / step - 1); };
    const auto ends = line(at(), at(), at(), at());
    INFO(ends[0].vertex.x << "," << ends[0].vertex.y << " to " << ends[1].vertex.x << ","
                          << ends[1].vertex.y);
    REQUIRE(drawn(ends, state_of(bits)) == by_rule(ends, bits));
  }
}

TEST_CASE("line_setup: short lines within a pixel or two follow the rule too") {
  RandomSource random(2);
  for (int i = 0; i < 20000; ++i) {
    const auto at = [&] { return random.integer(64, 103); };
    const auto ends = line(at(), at(), at(), at());
    INFO(ends[0].vertex.x << "," << ends[0].vertex.y << " to " << ends[1].vertex.x << ","
                          << ends[1].vertex.y);
    REQUIRE(drawn(ends, state_of(4)) == by_rule(ends, 4));
  }
}

TEST_CASE("line_setup: a joint on the way belongs to one of two lines") {
  RandomSource random(3);
  for (int i = 0; i < 3000; ++i) {
    const auto step = [&] { return random.integer(-60, 60); };
    const std::int32_t x = 128 + step(), y = 128 + step(), dx = step(), dy = step();
    const Pixels first = drawn(line(x - dx, y - dy, x, y), state_of(4)),
                 second = drawn(line(x, y, x + dx, y + dy), state_of(4));
    Pixels both = first;
    both.insert(second.begin(), second.end());
    REQUIRE(both.size() == first.size() + second.size());
    REQUIRE(both == drawn(line(x - dx, y - dy, x + dx, y + dy), state_of(4)));
  }
}

TEST_CASE("line_setup: a wide Bresenham line repeats its pixels across") {
  RandomSource random(4);
  for (int i = 0; i < 500; ++i) {
    const auto at = [&] { return random.integer(0, 255); };
    const auto ends = line(at(), at(), at(), at());
    const bool steep =
        std::abs(ends[1].vertex.x - ends[0].vertex.x) < std::abs(ends[1].vertex.y - ends[0].vertex.y);
    Pixels expected;
    for (const auto& [x, y] : drawn(ends, state_of(4))) {
      for (int k = -1; k <= 1; ++k) expected.emplace(steep ? x + k : x, steep ? y : y + k);
    }
    REQUIRE(drawn(ends, state_of(4, LineMode::kBresenham, 3)) == expected);
  }
}

TEST_CASE("line_setup: a rectangular line is two triangles without their common edge") {
  RandomSource random(5);
  for (int i = 0; i < 500; ++i) {
    const auto at = [&] { return random.integer(0, 511); };
    const auto ends = line(at(), at(), at(), at());
    const double dx = ends[1].vertex.x - ends[0].vertex.x, dy = ends[1].vertex.y - ends[0].vertex.y;
    if (dx == 0 && dy == 0) continue;
    const double reach = 2.5 * 16 / std::sqrt(dx * dx + dy * dy);  // a line of 5 pixels
    const auto sx = static_cast<std::int32_t>(std::lrint(-dy * reach)),
               sy = static_cast<std::int32_t>(std::lrint(dx * reach));
    const auto corner = [&](std::size_t end, int side) {
      return WindowVertex{ends[end].vertex.x + side * sx, ends[end].vertex.y + side * sy, 0, 1};
    };
    const SetupState state = state_of(4);
    Pixels expected;
    for (const auto& t : {std::array{corner(0, -1), corner(1, -1), corner(1, 1)},
                          std::array{corner(0, -1), corner(1, 1), corner(0, 1)}}) {
      TriangleSetup setup;
      if (setup_triangle(t, whole_triangle_weights(), state, setup) != SetupOutcome::kKept) continue;
      for (const auto& pixel : drawn(setup)) REQUIRE(expected.insert(pixel).second);
    }
    REQUIRE(drawn(ends, state_of(4, LineMode::kRectangular, 5)) == expected);
  }
}

TEST_CASE("line_setup: planes grow along the line") {
  TriangleSetup setup;
  const auto at = [&](const Plane& plane, double x, double y) {
    return plane.value + plane.dx * (x - setup.ref_x) + plane.dy * (y - setup.ref_y);
  };
  SECTION("along the columns of a Bresenham line") {
    REQUIRE(setup_line(line(0, 0, 160, 80), state_of(4), setup) == SetupOutcome::kKept);
    CHECK(at(setup.z, 5, 77) == Approx(0.5));
    CHECK(at(setup.persp_1, 10, 5) == Approx(0.5));
    CHECK(at(setup.linear_1, 2.5, 0) == Approx(0.25));
  }
  SECTION("by the nearest point in a rectangle") {
    REQUIRE(setup_line(line(0, 0, 96, 128), state_of(4, LineMode::kRectangular, 2), setup) ==
            SetupOutcome::kKept);
    CHECK(at(setup.z, 3, 4) == Approx(0.5));
    CHECK(at(setup.linear_1, 3 + 4, 4 - 3) == Approx(0.5));
  }
  CHECK(setup.persp_2.dx == 0);
  CHECK(setup.front_facing);
}

TEST_CASE("line_setup: what is not drawn") {
  TriangleSetup setup;
  CHECK(setup_line(line(20, 20, 20, 20), state_of(4), setup) == SetupOutcome::kZeroArea);
  CHECK(setup_line(line(20, 20, 20, 20), state_of(4, LineMode::kRectangular, 9), setup) ==
        SetupOutcome::kZeroArea);
  // ends in the diamond in which it begins
  CHECK(setup_line(line(24, 24, 25, 25), state_of(4), setup) == SetupOutcome::kNoSample);
  CHECK(setup_line(line(2000, 20, 2100, 20), state_of(4), setup) == SetupOutcome::kOffscreen);
}

TEST_CASE("line_setup: a smooth line's coverage sums to its area") {
  RandomSource random(6);
  for (int i = 0; i < 50; ++i) {
    const auto at = [&] { return random.integer(0, 511); };
    const auto ends = line(at(), at(), at(), at());
    const SetupState state = state_of(4, LineMode::kSmooth, 2);
    TriangleSetup setup;
    if (setup_line(ends, state, setup) != SetupOutcome::kKept) continue;
    const LineCoverage coverage = line_coverage(ends, state);
    double sum = 0;
    for (const auto& [x, y] : drawn(setup)) {
      const float part = coverage.at(x + 0.5 - setup.ref_x, y + 0.5 - setup.ref_y);
      REQUIRE((part >= 0 && part <= 1));
      sum += static_cast<double>(part);
    }
    const double area = 4 * coverage.half_length * coverage.half_width;
    CHECK(sum == Approx(area).margin(1.5).epsilon(0.02));
  }
}
