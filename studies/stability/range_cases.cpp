/// Cases of range: near and far planes far apart, depths that cannot be told apart, worlds very small, very
/// large and very far away.
#include "studies/stability/measures.h"
#include "studies/stability/stability.h"
#include "studies/stability/stream_builder.h"

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include <array>
#include <cmath>

#include "models/reference/compare.h"
#include "scenes/builtin/builtin.h"
#include "scenes/record/recorder.h"

namespace quadrille::studies::stability {

namespace {

// near and far
// --------------------------------------------------------------------------------------------------

constexpr std::uint32_t kStrip = 8, kHeight = 96;
constexpr double kApart = 0.01;  // of the distance: how far the two sheets of a column are apart

/// A row of columns, each with two sheets that fill it, `kApart` of their distance apart. The farther one is
/// red and drawn first, the nearer one green.
struct Sheets {
  double near = 1, far = 1, first = 1, step = 10;  ///< distance of column k: first * step^k
  int columns = 1;
  bool reversed = false;  ///< near has depth 1, far 0
  [[nodiscard]] double distance(int column) const {
    double d = first;
    for (int i = 0; i < column; ++i) d *= step;
    return d;
  }
  /// Depth of a distance, by the projection.
  [[nodiscard]] double depth(double d) const {
    return reversed ? near / (far - near) * ((far - d) / d) : far / (far - near) * (1 - near / d);
  }
};

/// View space (camera looks along -z) to clip space, one unit of tangent to each side.
glm::mat4 projection(const Sheets& s) {
  glm::mat4 m(0);
  m[0][0] = m[1][1] = 1;
  m[2][3] = -1;
  m[2][2] = static_cast<float>(s.reversed ? s.near / (s.far - s.near) : s.far / (s.near - s.far));
  m[3][2] =
      static_cast<float>(s.reversed ? s.far * s.near / (s.far - s.near) : s.far * s.near / (s.near - s.far));
  return m;
}

Corners sheet(const Sheets& s, int column, double distance, const glm::vec4& color) {
  const double left = 2.0 * column / s.columns - 1, right = 2.0 * (column + 1) / s.columns - 1;
  const auto corner = [&](double x, double y) {
    return Corner{{static_cast<float>(x * distance), static_cast<float>(y * distance),
                   static_cast<float>(-distance), 1},
                  color,
                  {}};
  };
  return {corner(left, -0.8), corner(left, 0.8),  corner(right, 0.8),
          corner(left, -0.8), corner(right, 0.8), corner(right, -0.8)};
}

traces::CommandStream sheets(const std::string& name, const Sheets& s) {
  StreamBuilder stream(name, kStrip * static_cast<std::uint32_t>(s.columns), kHeight, true,
                       s.reversed ? 0.0F : 1.0F);
  using enum traces::CompareOp;
  for (const bool nearer : {false, true}) {
    // The farther sheet may be as far as the cleared depth; the nearer one has to be truly nearer.
    stream.state({.depth = {true, true,
                            nearer ? (s.reversed ? kGreater : kLess)
                                   : (s.reversed ? kGreaterOrEqual : kLessOrEqual)}});
    for (int k = 0; k < s.columns; ++k) {
      const double d = s.distance(k) * (nearer ? 1 : 1 + kApart);
      stream.draw(sheet(s, k, d, nearer ? glm::vec4(0.1F, 0.8F, 0.2F, 1) : glm::vec4(0.9F, 0.1F, 0.1F, 1)),
                  projection(s));
    }
  }
  return stream.finish();
}

/// The farthest distance up to which every column shows its nearer sheet.
double ordered_up_to(const Observed& o, const Sheets& s) {
  double reached = 0;
  for (int k = 0; k < s.columns; ++k) {
    if (o.channel(static_cast<std::uint32_t>(k) * kStrip + kStrip / 2, kHeight / 2, 1) < 128) return reached;
    reached = s.distance(k);
  }
  return reached;
}

/// Distance at which the two sheets' depths are one float32 step apart.
double theory(const Sheets& s) {
  return s.near * (s.far / (s.far - s.near)) * (kApart / (1 + kApart)) * 0x1p24;
}

void check_sheets(const Observed& o, const Sheets& s, Findings& f) {
  std::uint64_t drawn = 0;
  double worst = 0;
  for (int k = 0; k < s.columns; ++k) {
    const std::uint32_t x = static_cast<std::uint32_t>(k) * kStrip + kStrip / 2;
    drawn += (o.pixel(x, kHeight / 2) >> 24) != 0 ? 1 : 0;
    if (o.channel(x, kHeight / 2, 1) < 128) continue;
    const double depth = static_cast<double>(o.image().depth[std::size_t{kHeight / 2} * o.image().width + x]);
    const double ideal = s.depth(s.distance(k));
    worst = std::max(worst, std::abs(depth - ideal) / (s.reversed ? ideal * 0x1p-23 : 0x1p-24));
  }
  f.equal("columns drawn", drawn, static_cast<std::uint64_t>(s.columns));
  f.equal("inner pixels covered unlike the ideal reference", inner_difference(o, ideal_reference(o)).coverage,
          0);
  f.at_most("worst depth against double precision", worst, 4,
            s.reversed ? "relative float32 steps" : "float32 steps below 1");
  const double reached = ordered_up_to(o, s);
  if (s.reversed) {
    f.at_least("sheets 1 % apart are in order up to", reached, 0.99 * s.distance(s.columns - 1));
  } else {
    f.at_least("sheets 1 % apart are in order up to", reached, 0.25 * theory(s));
    f.note("float32 depth can tell them apart up to about", fmt::format("{:.3g}", theory(s)));
  }
}

Case sheets_case(const std::string& name, const std::string& purpose, const Sheets& s) {
  return {.name = name,
          .group = "numbers",
          .purpose = purpose,
          .must = s.reversed ? "every column is drawn, and its nearer sheet is in front at every distance"
                             : "every column is drawn; the nearer sheet is in front up to the distance that "
                               "float32 depth explains",
          .build = [name, s] { return sheets(name, s); },
          .check = [s](const Observed& o, Findings& f) { check_sheets(o, s, f); }};
}

// worlds
// --------------------------------------------------------------------------------------------------

constexpr std::uint32_t kWorldWidth = 192, kWorldHeight = 144;

traces::CommandStream recorded(const scenes::SceneData& scene) {
  scenes::SceneOptions options;
  options.width = kWorldWidth;
  options.height = kWorldHeight;
  return scenes::Recorder(scene, options).record();
}

/// The cubes, all instances scaled and then moved.
scenes::SceneData cubes(double scale, const glm::dvec3& offset) {
  scenes::SceneData scene = scenes::build_cubes();
  for (scenes::Instance& instance : scene.instances) {
    glm::dmat4 world(instance.world);
    for (int c = 0; c < 4; ++c) world[c] = glm::dvec4(glm::dvec3(world[c]) * scale, world[c].w);
    world[3] += glm::dvec4(offset, 0);
    instance.world = glm::mat4(world);
  }
  return scene;
}

/// One cube, turned, at `offset`: its corners are small numbers, only its matrix is far away.
scenes::SceneData one_cube(const glm::dvec3& offset) {
  scenes::SceneData scene = scenes::build_cubes();
  scene.instances.resize(1);
  scene.instances[0].world[3] = glm::vec4(glm::vec3(offset), 1);
  return scene;
}

models::reference::ImageDifference difference_to(const Observed& o, const scenes::SceneData& scene) {
  const pipeline::FrameImage plain =
      pipeline::render_functional_frame(recorded(scene), o.machine->precision()).image;
  return models::reference::compare_images({plain.width, plain.height, plain.color},
                                           {plain.width, plain.height, o.image().color});
}

/// `exact`: bit for bit; otherwise a pixel in a thousand may be a rounding off.
void check_same_picture(const Observed& o, const scenes::SceneData& plain, bool exact, Findings& f) {
  const models::reference::ImageDifference d = difference_to(o, plain);
  f.at_least("pixels within 2/255 of the plain scene", 100 * d.fraction_within(2), exact ? 100 : 99.9, "%");
  f.equal("8x8 blocks that look different", d.bad_blocks, 0);
  if (exact) {
    f.at_most("largest difference of a channel", d.max_lsb, 0, "of 255");
  } else {
    f.note("largest difference of a channel", fmt::format("{} of 255", d.max_lsb));
  }
}

Case world_case(const std::string& name, double scale, bool power_of_two) {
  return {.name = name,
          .group = "numbers",
          .purpose = power_of_two ? fmt::format("the cubes in a world 2^{} times as large", std::ilogb(scale))
                                  : fmt::format("the cubes in a world {:.3g} times as large", scale),
          .must = power_of_two ? "the picture of the plain world, bit for bit"
                               : "the picture of the plain world, but for roundings",
          .build = [scale] { return recorded(cubes(scale, glm::dvec3(0))); },
          .check = [=](const Observed& o,
                       Findings& f) { check_same_picture(o, cubes(1, glm::dvec3(0)), power_of_two, f); }};
}

// vertex positions far from the origin
// --------------------------------------------------------------------------------------------------

constexpr float kFarAway = 1e7F;
constexpr std::uint32_t kFarSide = 128;

/// Points of a small grid at (10^7, 10^7, 10^7), 64 units before an eye that is as far away; all in one
/// float32 matrix product, as a shader has them.
struct FarGrid {
  static constexpr int kCount = 8;
  static glm::vec4 point(int x, int y) {
    return {kFarAway + 3.0F * static_cast<float>(x), kFarAway + 3.0F * static_cast<float>(y), kFarAway, 1};
  }
  /// World to clip: the eye at (10^7 + 10.4, 10^7 + 10.4, 10^7 + 64) looks along -z, a unit of tangent 0.3 to
  /// each side.
  static glm::dmat4 matrix() {
    const double zoom = 1 / 0.3, near = 1, far = 1000, away = static_cast<double>(kFarAway);
    glm::dmat4 p(0);
    p[0][0] = p[1][1] = zoom;
    p[2][2] = far / (near - far);
    p[2][3] = -1;
    p[3][2] = far * near / (near - far);
    glm::dmat4 view(1);
    view[3] = glm::dvec4(-(away + 10.4), -(away + 10.4), -(away + 64), 1);
    return p * view;
  }
};

traces::CommandStream far_object() {
  Corners corners;
  for (int y = 0; y + 1 < FarGrid::kCount; ++y) {
    for (int x = 0; x + 1 < FarGrid::kCount; ++x) {
      const glm::vec4 color((x + y) % 2 == 0 ? 0.9F : 0.3F, 0.5F, 0.2F + 0.1F * static_cast<float>(x), 1);
      const auto corner = [&](int u, int v) { return Corner{FarGrid::point(u, v), color, {}}; };
      corners.insert(corners.end(), {corner(x, y), corner(x, y + 1), corner(x + 1, y + 1), corner(x, y),
                                     corner(x + 1, y + 1), corner(x + 1, y)});
    }
  }
  return StreamBuilder("far-object", kFarSide, kFarSide).draw(corners, glm::mat4(FarGrid::matrix())).finish();
}

/// Corners in the window against double precision, from the same positions and, by `matrix`, from the matrix
/// as stored or as meant.
double worst_jitter(const Observed& o, const glm::dmat4& matrix) {
  double worst = 0;
  std::size_t n = 0;
  constexpr int kCells = FarGrid::kCount - 1;
  constexpr std::array<std::array<int, 2>, 6> kOffsets{{{0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 1}, {1, 0}}};
  const auto measure = [&](const pipeline::RasterizedPiece& t) {
    const auto cell = static_cast<int>(t.primitive) / 2;
    for (std::size_t i = 0; i < 3; ++i, ++n) {
      const auto& offset = kOffsets[3 * (t.primitive % 2) + i];
      const glm::dvec4 clip =
          matrix * glm::dvec4(FarGrid::point(cell % kCells + offset[0], cell / kCells + offset[1]));
      const double x = (clip.x / clip.w + 1) * kFarSide / 2, y = (clip.y / clip.w + 1) * kFarSide / 2;
      worst = std::max(
          {worst, std::abs(t.piece.vertices[i].x / 256.0 - x), std::abs(t.piece.vertices[i].y / 256.0 - y)});
    }
  };
  static_cast<void>(pipeline::render_functional_frame(o.stream, o.machine->precision(), measure));
  return n > 0 ? worst : NAN;
}

void check_far_object(const Observed& o, Findings& f) {
  const glm::dmat4 meant = FarGrid::matrix(), stored{glm::mat4(meant)};
  // Three terms of 3.3e7 are added in float32, each rounded to within 2, and clip x of 64 (which is w) is
  // half the target, 64 pixels: 6 pixels, and w is off too.
  f.at_most("jitter of the corners against double, same matrix", worst_jitter(o, stored), 8, "pixels");
  f.note("jitter against the matrix as meant", fmt::format("{:.3g} pixels", worst_jitter(o, meant)));
}

}  // namespace

void add_range_cases(std::vector<Case>& cases) {
  cases.push_back(sheets_case("near-1e-6-far-1e12",
                              "near plane at 10^-6, far plane at 10^12, sheets 1 % apart in between",
                              {.near = 1e-6, .far = 1e12, .first = 2e-6, .step = 3.5, .columns = 32}));
  cases.push_back(
      sheets_case("near-1e-6-far-1e12-reversed", "the same with reversed depth: near 1, far 0",
                  {.near = 1e-6, .far = 1e12, .first = 2e-6, .step = 3.5, .columns = 32, .reversed = true}));
  cases.push_back(sheets_case("depth-ratio-1e9", "near plane at 10^-3, far plane at 10^6",
                              {.near = 1e-3, .far = 1e6, .first = 2e-3, .step = 1.8, .columns = 33}));
  cases.push_back(
      sheets_case("depth-ratio-1e9-reversed", "the same with reversed depth",
                  {.near = 1e-3, .far = 1e6, .first = 2e-3, .step = 1.8, .columns = 33, .reversed = true}));
  cases.push_back(world_case("world-1e30", 1e30, false));
  cases.push_back(world_case("world-1e-30", 1e-30, false));
  cases.push_back(world_case("world-2p100", 0x1p100, true));
  cases.push_back(world_case("world-2p-100", 0x1p-100, true));
  cases.push_back(
      {.name = "far-object",
       .group = "numbers",
       .purpose =
           "a grid 10^7 from the origin under one float32 matrix, as a shader without further care has it",
       .must = "no corner jitters more than float32 explains",
       .build = far_object,
       .check = check_far_object});
  cases.push_back({.name = "far-scene",
                   .group = "numbers",
                   .purpose = "a cube of a scene, its node 10^7 from the origin",
                   .must = "the picture of the cube at the origin",
                   .build = [] { return recorded(one_cube(glm::dvec3(static_cast<double>(kFarAway)))); },
                   .check = [](const Observed& o,
                               Findings& f) { check_same_picture(o, one_cube(glm::dvec3(0)), false, f); }});
}

}  // namespace quadrille::studies::stability
