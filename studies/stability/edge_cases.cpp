/// Cases of clipping and coverage: w through zero, edges that triangles share, slivers, T-junctions, vertices
/// on samples, triangles far wider than the screen.
#include "studies/stability/measures.h"
#include "studies/stability/stability.h"
#include "studies/stability/stream_builder.h"

#include <array>
#include <cmath>

namespace quadrille::studies::stability {

namespace {

constexpr std::uint32_t kSide = 200;
constexpr std::int32_t kInset = 8;
constexpr Area kWhole{0, 0, kSide, kSide};
constexpr Area kInner{kInset, kInset, kSide - 2 * kInset, kSide - 2 * kInset};

scenes::Rgba8Image counted(const Observed& o) { return count_picture(o.image(), drawn_area(o.stream)); }

Corner pixel_corner(double x, double y) { return {at_pixel(x, y, kSide, kSide), glm::vec4(1), {}}; }

/// A target that counts, its scissor inside its edges.
StreamBuilder counting(const std::string& name) {
  StreamBuilder stream(name, kSide, kSide);
  stream.clear({0, 0, 0, 0}).area(kWhole, kInner).state({.paint = Paint::kCount});
  return stream;
}

// w through zero
// --------------------------------------------------------------------------------------------------

constexpr int kCells = 4;
constexpr std::uint32_t kCell = 64;

/// Sixteen triangles whose w go through every pattern of sign, each in a cell of its own. z = w / 2, so that
/// only w decides what is behind.
traces::CommandStream w_through_zero() {
  constexpr std::array<std::array<float, 3>, kCells * kCells> kW{{{1, 1, 0},
                                                                  {1, 0, 0},
                                                                  {1, 1, -1},
                                                                  {1, -1, -1},
                                                                  {1, 0, -1},
                                                                  {1, 1, 1e-6F},
                                                                  {1, 1, -1e-6F},
                                                                  {1, 1e-30F, -1e-30F},
                                                                  {2, 1, -0.5F},
                                                                  {0.5F, -2, 3},
                                                                  {1, 1, 1e-35F},
                                                                  {1e-30F, 2e-30F, 3e-30F},
                                                                  {1e30F, 2e30F, -1e30F},
                                                                  {1, 1e6F, -1e-3F},
                                                                  {0, 0, 0},
                                                                  {-1, -1, -1}}};
  StreamBuilder stream("w-through-zero", kCells * kCell, kCells * kCell);
  for (int i = 0; i < kCells * kCells; ++i) {
    const auto& w = kW[static_cast<std::size_t>(i)];
    const Area cell{static_cast<std::int32_t>(kCell) * (i % kCells),
                    static_cast<std::int32_t>(kCell) * (i / kCells), kCell, kCell};
    stream.area(cell, {cell.x + 2, cell.y + 2, kCell - 4, kCell - 4});
    // Where a corner would be at |w|: a triangle around the cell's centre.
    constexpr std::array<std::array<float, 2>, 3> kAt{{{-0.8F, 0.7F}, {0.75F, 0.6F}, {0.1F, -0.8F}}};
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const float m = w[k] != 0 ? std::abs(w[k]) : 1.0F;
      corners.push_back({{kAt[k][0] * m, kAt[k][1] * m, w[k] * 0.5F, w[k]}, {k == 0, k == 1, k == 2, 1}, {}});
    }
    stream.draw(corners);
  }
  return stream.finish();
}

void check_w_through_zero(const Observed& o, Findings& f) {
  const InnerDifference d = inner_difference(o, ideal_reference(o));
  f.equal("inner pixels covered unlike the ideal reference", d.coverage, 0);
  f.at_most("inner pixels more than 2/255 off the ideal reference", static_cast<double>(d.over_two),
            0.001 * static_cast<double>(d.covered));
  f.at_least("inner pixels compared, covered", static_cast<double>(d.covered), 5000);
}

// shared edges
// --------------------------------------------------------------------------------------------------

/// A mesh of triangles with wandering corners over more than the drawn area.
traces::CommandStream shared_edges() {
  constexpr int kCount = 28;
  constexpr double kStep = static_cast<double>(kSide) / kCount;
  Chance chance(1);
  std::array<std::array<Corner, kCount + 1>, kCount + 1> points;
  for (int y = 0; y <= kCount; ++y) {
    for (int x = 0; x <= kCount; ++x) {
      const bool rim = x == 0 || y == 0 || x == kCount || y == kCount;
      const double away = rim ? 0 : 0.25 * kStep;
      points[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
          pixel_corner(x * kStep + chance.between(-away, away), y * kStep + chance.between(-away, away));
    }
  }
  Corners corners;
  for (std::size_t y = 0; y < kCount; ++y) {
    for (std::size_t x = 0; x < kCount; ++x) {
      const Corner &a = points[y][x], &b = points[y][x + 1], &c = points[y + 1][x], &d = points[y + 1][x + 1];
      // The diagonal turns with the cell; every second triangle turns the other way round.
      if ((x + y) % 2 == 0) corners.insert(corners.end(), {a, b, c, c, b, d});
      else corners.insert(corners.end(), {a, b, d, d, a, c});
    }
  }
  return counting("shared-edges").draw(corners).finish();
}

/// 720 triangles around one corner, from its own pixel to far outside.
traces::CommandStream fan() {
  constexpr int kBlades = 720;
  Corners corners;
  const Corner middle = pixel_corner(99.3, 101.7);
  const auto rim = [](int i) {
    // A square as rim, walked by whole steps: no transcendental function.
    constexpr int kQuarter = kBlades / 4;
    const int side = i % kBlades / kQuarter, step = i % kQuarter;
    const double t = static_cast<double>(step) / static_cast<double>(kQuarter) * kSide;
    const std::array<std::array<double, 2>, 4> at{{{t, 0}, {kSide, t}, {kSide - t, kSide}, {0, kSide - t}}};
    return pixel_corner(at[static_cast<std::size_t>(side)][0], at[static_cast<std::size_t>(side)][1]);
  };
  for (int i = 0; i < kBlades; ++i) corners.insert(corners.end(), {middle, rim(i), rim(i + 1)});
  return counting("fan").draw(corners).finish();
}

void check_once(const Observed& o, Findings& f) {
  f.equal("pixels not covered exactly once", not_once(o), 0);
}

// T-junctions
// --------------------------------------------------------------------------------------------------

/// A long edge with triangles on one side, and short ones that end in its middle on the other: the window's
/// halves below and above a line.
traces::CommandStream t_junctions(double left_y, double right_y) {
  constexpr int kPieces = 37;
  const auto on_line = [&](double t) { return pixel_corner(t * kSide, left_y + t * (right_y - left_y)); };
  Corners corners{on_line(0), pixel_corner(0, 0),     pixel_corner(kSide, 0),
                  on_line(0), pixel_corner(kSide, 0), on_line(1)};
  for (int i = 0; i < kPieces; ++i) {
    const double a = static_cast<double>(i) / kPieces, b = static_cast<double>(i + 1) / kPieces;
    const Corner low_a = pixel_corner(a * kSide, kSide), low_b = pixel_corner(b * kSide, kSide);
    corners.insert(corners.end(), {on_line(a), on_line(b), low_a, low_a, on_line(b), low_b});
  }
  return counting("t-junctions").draw(corners).finish();
}

void check_slanted_junctions(const Observed& o, Findings& f) {
  const models::reference::Result given = given_reference(o);
  std::uint64_t other = 0;
  for (std::size_t i = 0; i < given.color.size(); ++i)
    other += (given.color[i] & 0xffu) != (o.image().color[i] & 0xffu) ? 1 : 0;
  f.equal("pixels unlike the reference from the same snapped corners", other, 0);
  // A corner is at most half a step of the grid off the line: of 184 columns one in 32 holds a sample that
  // near to it, and as many again by chance.
  f.at_most("pixels not covered exactly once", static_cast<double>(not_once(o)), 12);
}

// vertices on samples
// --------------------------------------------------------------------------------------------------

constexpr std::array<std::array<int, 4>, 3> kSquares{
    {{20, 20, 80, 80}, {100, 30, 180, 90}, {30, 110, 150, 170}}};  // left, top, right, bottom

/// Squares with corners on pixel centres, cut into triangles around a centre that lies on a sample as well;
/// one turned the other way round.
traces::CommandStream on_samples() {
  Corners corners;
  for (std::size_t s = 0; s < kSquares.size(); ++s) {
    const auto [left, top, right, bottom] = kSquares[s];
    const auto at = [](int x, int y) { return pixel_corner(x + 0.5, y + 0.5); };
    const Corner middle = at((left + right) / 2, (top + bottom) / 2);
    const std::array<Corner, 8> rim{
        at(left, top),     at((left + right) / 2, top),    at(right, top),   at(right, (top + bottom) / 2),
        at(right, bottom), at((left + right) / 2, bottom), at(left, bottom), at(left, (top + bottom) / 2)};
    for (std::size_t i = 0; i < 8; ++i) {
      const Corner &a = rim[i], &b = rim[(i + 1) % 8];
      if (s == 1) corners.insert(corners.end(), {middle, b, a});
      else corners.insert(corners.end(), {middle, a, b});
    }
  }
  return counting("on-samples").draw(corners).finish();
}

void check_on_samples(const Observed& o, Findings& f) {
  std::uint64_t wrong = 0, inside = 0;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      bool wanted = false;
      for (const auto& [left, top, right, bottom] : kSquares) {
        const int px = static_cast<int>(x), py = static_cast<int>(y);
        wanted = wanted || (px >= left && px < right && py >= top && py < bottom);
      }
      inside += wanted ? 1 : 0;
      wrong += o.channel(x, y, 0) != (wanted ? 1u : 0u) ? 1 : 0;
    }
  }
  f.equal("pixels against the closed form of the top-left rule", wrong, 0);
  f.note("pixels inside, by the closed form", std::to_string(inside));
}

// slivers
// --------------------------------------------------------------------------------------------------

/// Needles: two corners a whole screen apart, the third one to four sub-pixel steps beside the first.
traces::CommandStream slivers() {
  constexpr double kStep = 1.0 / 256;
  Chance chance(2);
  Corners corners;
  for (int i = 0; i < 400; ++i) {
    const double x = chance.between(-20, kSide + 20), y = chance.between(-20, kSide + 20);
    const double steps = std::floor(chance.between(1, 5));
    const double dx = i % 2 == 0 ? steps * kStep : 0, dy = i % 2 == 0 ? 0 : steps * kStep;
    corners.insert(corners.end(), {pixel_corner(x, y), pixel_corner(x + dx, y + dy),
                                   pixel_corner(chance.between(0, kSide), chance.between(0, kSide))});
  }
  return counting("slivers").draw(corners).finish();
}

void check_slivers(const Observed& o, Findings& f) {
  const models::reference::Result given = given_reference(o);
  std::uint64_t other = 0, covered = 0;
  for (std::size_t i = 0; i < given.color.size(); ++i) {
    other += (given.color[i] & 0xffu) != (o.image().color[i] & 0xffu) ? 1 : 0;
    covered += o.image().color[i] & 0xffu;
  }
  f.equal("pixels counted unlike the reference from the same corners", other, 0);
  f.at_least("samples hit", static_cast<double>(covered), 100);
}

// triangles far wider than the screen
// --------------------------------------------------------------------------------------------------

constexpr std::uint32_t kWide = 128;

/// Two cells: a triangle a million pixels wide (within the guard band) and one 10^9 wide (cut), their edges
/// crossing the cell, under a thin ramp of colour.
traces::CommandStream wide_triangles() {
  StreamBuilder stream("wide-triangles", 2 * kWide, kWide);
  for (int cell = 0; cell < 2; ++cell) {
    const double reach = cell == 0 ? 5e5 : 5e8;
    const auto corner = [&](double x, double y, const glm::vec4& color) {
      return Corner{at_pixel(x, y, kWide, kWide), color, {}};
    };
    stream.area(
        {cell * static_cast<std::int32_t>(kWide), 0, kWide, kWide},
        {cell * static_cast<std::int32_t>(kWide) + kInset, kInset, kWide - 2 * kInset, kWide - 2 * kInset});
    // Both long edges pass through the cell: y = 40 + x / 8 and y = 100 - x / 4.
    const double meet = 160;  // x at which they meet
    const double left = meet - reach;
    stream.draw(Corners{corner(meet, 60, {1, 0.2F, 0.2F, 1}), corner(left, 40 + left / 8, {0.2F, 1, 0.2F, 1}),
                        corner(left, 100 - left / 4, {0.2F, 0.2F, 1, 1})});
  }
  return stream.finish();
}

void check_wide_triangles(const Observed& o, Findings& f) {
  f.equal("pixels covered unlike the reference from the same snapped corners",
          coverage_difference(o, given_reference(o)), 0);
  const models::reference::Result ideal = ideal_reference(o);
  // A float32 window position 5e5 pixels away is good to 1/64 pixel, so the edge may miss a sample in about
  // 112 columns x 4 edges / 32.
  f.at_most("pixels covered unlike the ideal reference", static_cast<double>(coverage_difference(o, ideal)),
            16);
  const InnerDifference d = inner_difference(o, ideal);
  f.at_most("worst channel of the inner pixels", d.worst, 2, "of 255");
  f.at_least("inner pixels compared, covered", static_cast<double>(d.covered), 3000);
}

}  // namespace

void add_edge_cases(std::vector<Case>& cases) {
  cases.push_back({.name = "w-through-zero",
                   .group = "numbers",
                   .purpose = "triangles whose w is negative, zero, tiny or huge at one, two or all corners",
                   .must = "only the part in front is drawn, where and as the ideal reference draws it",
                   .build = w_through_zero,
                   .check = check_w_through_zero});
  cases.push_back({.name = "shared-edges",
                   .group = "numbers",
                   .purpose = "1568 triangles with wandering corners, each edge shared",
                   .must = "each pixel is covered exactly once",
                   .build = shared_edges,
                   .check = check_once,
                   .picture = counted});
  cases.push_back({.name = "fan",
                   .group = "numbers",
                   .purpose = "720 triangles around one corner, far thinner than a pixel there",
                   .must = "each pixel is covered exactly once",
                   .build = fan,
                   .check = check_once,
                   .picture = counted});
  cases.push_back({.name = "t-junctions-straight",
                   .group = "numbers",
                   .purpose = "corners in the middle of a neighbour's edge that runs along the pixels",
                   .must = "each pixel is covered exactly once",
                   .build = [] { return t_junctions(100.25, 100.25); },
                   .check = check_once,
                   .picture = counted});
  cases.push_back(
      {.name = "t-junctions-slanted",
       .group = "numbers",
       .purpose = "the same with a slanted edge, on a grid of a 16th of a pixel: corners snap beside the "
                  "edge, as on any rasteriser",
       .must = "coverage is that of the snapped corners, and no more pixels go wrong than the grid explains",
       .build = [] { return t_junctions(61.37, 141.83); },
       .machine = [](pipeline::MachineConfig& machine) { machine.gpu.subpixel_bits.set(4); },
       .check = check_slanted_junctions,
       .picture = counted});
  cases.push_back(
      {.name = "on-samples",
       .group = "numbers",
       .purpose = "corners and edges exactly on samples, in both directions of turning",
       .must = "the top-left rule to the pixel: left and top edges belong, right and bottom ones do not",
       .build = on_samples,
       .check = check_on_samples,
       .picture = counted});
  cases.push_back({.name = "slivers",
                   .group = "numbers",
                   .purpose = "400 needles, one to four 256ths of a pixel wide and up to a screen long",
                   .must = "exactly the samples that the reference finds under the same snapped corners",
                   .build = slivers,
                   .check = check_slivers,
                   .picture = counted});
  cases.push_back(
      {.name = "wide-triangles",
       .group = "numbers",
       .purpose = "a triangle 10^6 pixels wide, within the guard band, and one 10^9 wide, which is cut",
       .must = "coverage of the snapped corners exactly, edges and colours as the ideal reference has them",
       .build = wide_triangles,
       .check = check_wide_triangles});
}

}  // namespace quadrille::studies::stability
