/// Culling of whole draws: none is dropped of which a piece reaches the raster, most that lie outside are,
/// and the machine saves what their vertices would have cost.
#include "pipeline/driver/draw_culling.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/functional/functional.h"
#include "pipeline/render.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/object_stream.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/random_source.h"
#include "tests/pipeline/random_stream.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// What happened to the draws of a frame.
struct Draws {
  int dropped = 0;  ///< found outside
  int unseen = 0;   ///< of which no piece reaches the raster
  int wrong = 0;    ///< both dropped and seen
};

Draws cull(const traces::CommandStream& stream) {
  DeviceFrame frame(std::uint64_t{1} << 30);
  build_frame(stream, {}, frame);
  find_draws_outside(frame.frame, frame.memory);
  std::vector<bool> seen(frame.frame.draws.size());
  (void)render_functional(frame.frame, frame.memory,
                          [&](const RasterizedPiece& piece) { seen[piece.draw.index()] = true; });
  Draws draws;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool dropped = frame.frame.draws[i].outside_view;
    draws.dropped += dropped ? 1 : 0;
    draws.unseen += seen[i] ? 0 : 1;
    draws.wrong += dropped && seen[i] ? 1 : 0;
  }
  return draws;
}

/// Scales by `size` and moves.
Matrix placed(float size, float x, float y, float z) {
  return {size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, x, y, z, 1};
}

/// 90 degrees of view along -z, from `near` on.
Matrix perspective(float near, float far) {
  const float depth = far / (near - far);
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, depth, -1, 0, 0, near * depth, 0};
}

std::vector<std::array<float, 3>> random_corners(RandomSource& random, int triangles) {
  std::vector<std::array<float, 3>> corners(static_cast<std::size_t>(3 * triangles));
  for (auto& corner : corners) corner = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
  return corners;
}

/// Near the planes of the view volume, or across w = 0, or anywhere; now and then with a number that is none.
ObjectDraw random_object(RandomSource& random, std::size_t programs) {
  ObjectDraw draw;
  draw.program = static_cast<std::size_t>(random.integer(0, static_cast<int>(programs) - 1));
  draw.corners = random_corners(random, random.integer(1, 4));
  draw.indexed = random.chance(0.5);
  draw.depth_clamp = random.chance(0.2);
  const float far = random.real(2, 30), size = std::exp2(random.real(-6, 2));
  draw.view = perspective(random.real(0.1F, 1), far);
  const float z = random.real(-1.2F * far, 2);
  draw.model =
      placed(size, random.real(-2, 2) * (std::abs(z) + size), random.real(-2, 2) * (std::abs(z) + size), z);
  for (float& m : draw.model) m *= random.chance(0.2) ? random.real(0.5F, 1.5F) : 1;
  const int kind = random.integer(0, 9);
  if (kind == 0)
    for (float& m : draw.view) m = random.real(-2, 2);
  if (kind == 1)
    for (float& m : draw.model) m = std::ldexp(random.real(-2, 2), random.integer(-120, 120));
  const float wild = random.chance(0.5) ? std::numeric_limits<float>::quiet_NaN() : HUGE_VALF;
  if (kind == 2) draw.corners[0][static_cast<std::size_t>(random.integer(0, 2))] = wild;
  if (kind == 3) draw.model[static_cast<std::size_t>(random.integer(0, 15))] = wild;
  return draw;
}

/// What a frame of the machine comes to, in a process of its own.
struct MachineFrame {
  std::int64_t cycles = 0;
  std::uint64_t triangles = 0, draws = 0, picture = 0;
  std::int64_t busy = 0;  ///< of the command processor, by draws that were dropped
  bool laws = false;
};

MachineFrame run_machine(const traces::CommandStream& stream, bool culls) {
  const std::string text = hw::contract::in_child([&] {
    MachineConfig config;
    config.vertex_fetch.indices_per_clk.set(1);
    config.command_processor.cull_draws.set(culls);
    const RenderedFrame frame = render_exact(stream, config, {}, {}, {.draws = true});
    std::uint64_t picture = 0;
    for (const std::uint32_t pixel : frame.image.color) picture = picture * 31 + pixel;
    std::int64_t busy = 0;
    for (const DrawFigures& draw : frame.figures.detail->draws)
      if (std::ranges::count_if(draw.busy, [](std::int64_t cycles) { return cycles > 0; }) == 1)
        busy += draw.in_flight();
    const FrameFigures& f = frame.figures.frame;
    return fmt::format("{} {} {} {} {} {}", f.cycles, f.triangles, f.draws, picture, busy,
                       frame.figures.checks_hold() ? 1 : 0);
  });
  std::istringstream words(text);
  MachineFrame frame;
  words >> frame.cycles >> frame.triangles >> frame.draws >> frame.picture >> frame.busy >> frame.laws;
  return frame;
}

}  // namespace

TEST_CASE("draw culling: no draw is dropped of which a piece reaches the raster, whatever its matrices") {
  RandomSource random(1);
  Draws all;
  for (const auto& programs : {bounded_programs(), unbounded_programs()}) {
    for (int round = 0; round < 20; ++round) {
      std::vector<ObjectDraw> objects;
      objects.reserve(60);
      for (int d = 0; d < 60; ++d) objects.push_back(random_object(random, programs.size()));
      const Draws draws = cull(object_stream(objects, programs));
      INFO("round " << round);
      REQUIRE(draws.wrong == 0);
      all.dropped += draws.dropped;
      all.unseen += draws.unseen;
    }
  }
  CHECK(all.dropped > 400);
  CHECK(all.unseen > all.dropped);
}

TEST_CASE("draw culling: no draw of a random stream is dropped of which a piece reaches the raster") {
  int dropped = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Draws draws =
        cull(seed % 2 == 0 ? random_stream(seed, {.draws = 30, .triangles = 1}) : random_primitives(seed));
    INFO("seed " << seed);
    REQUIRE(draws.wrong == 0);
    dropped += draws.dropped;
  }
  CHECK(dropped > 0);
}

TEST_CASE(
    "draw culling: a draw whose box lies a hundred-thousandth beyond a plane is dropped, of a plain "
    "product") {
  // The far corner of a cube of size 1, at w = 4, is just beyond the side, or just within.
  const std::vector<std::array<float, 3>> cube{{-1, -1, -1}, {1, 1, 1}, {-1, 1, 1}};
  const Matrix view = perspective(0.5F, 100);
  for (const float side : {1.0F, -1.0F}) {
    for (const bool along_y : {false, true}) {
      // Position x - 0.5 from the axis at distance 3.5 to 4.5: nearest to the side is the far face.
      const auto at = [&](float x) {
        const Matrix model = along_y ? placed(0.5F, 0, side * x, -4) : placed(0.5F, side * x, 0, -4);
        return ObjectDraw{0, model, view, cube, false, false};
      };
      CHECK(cull(object_stream({at(5.00005F)}, bounded_programs())).dropped == 1);
      CHECK(cull(object_stream({at(4.99995F)}, bounded_programs())).dropped == 0);
    }
  }
  CHECK(
      cull(object_stream({{0, placed(1, 0, 0, 5), view, cube, false, false}}, bounded_programs())).dropped ==
      1);
  CHECK(cull(object_stream({{0, placed(1, 0, 0, -200), view, cube, false, false}}, bounded_programs()))
            .dropped == 1);
  CHECK(cull(object_stream({{0, placed(1, 0, 0, -200), view, cube, false, true}}, bounded_programs()))
            .dropped == 0);
}

TEST_CASE("draw culling: every program whose position can be bounded has draws dropped, and no other") {
  const std::vector<std::array<float, 3>> corners{{0.5F, 0.25F, 0}, {0.75F, 0.5F, 0}, {0.5F, 0.5F, 0}};
  const auto far_away = [&](const std::vector<std::string>& programs) {
    std::vector<ObjectDraw> objects;
    for (std::size_t p = 0; p < programs.size(); ++p)
      objects.push_back({p, placed(1, 100, 0, 0.5F), kIdentity, corners, p % 2 == 0, false});
    return cull(object_stream(objects, programs));
  };
  const auto bounded = bounded_programs();
  CHECK(far_away(bounded).dropped == static_cast<int>(bounded.size()));
  const Draws unbounded = far_away(unbounded_programs());
  CHECK(unbounded.dropped == 0);
  CHECK(unbounded.unseen == static_cast<int>(unbounded_programs().size()));
}

TEST_CASE(
    "draw culling: of a grid of objects the machine draws those in view, and saves the others' indices") {
  // 64 objects of 128 triangles; the last four are in view. Without culling the index rate limits: an index a
  // cycle. With it an object out of view takes draw_clk cycles.
  constexpr int kObjects = 64, kSeen = 4, kTriangles = 128, kDrawClk = 16;
  RandomSource random(3);
  const auto corners = random_corners(random, kTriangles);
  std::vector<ObjectDraw> objects;
  for (int i = kObjects - 1; i >= 0; --i) {
    const int column = i < kSeen ? i % 2 : 2 + i % 8, row = i < kSeen ? i / 2 : 2 + i / 8;
    objects.push_back({0,
                       placed(0.01F, static_cast<float>(column) - 0.5F, static_cast<float>(row) - 0.5F, 0.5F),
                       kIdentity, corners, true, false});
  }
  const traces::CommandStream stream = object_stream(objects, bounded_programs());
  const MachineFrame all = run_machine(stream, false), seen = run_machine(stream, true);
  CHECK(all.laws);
  CHECK(seen.laws);
  CHECK(all.picture == seen.picture);
  CHECK(all.draws == kObjects);
  CHECK(seen.draws == kObjects);
  CHECK(all.triangles == kObjects * kTriangles);
  CHECK(seen.triangles == kSeen * kTriangles);
  CHECK(seen.busy == (kObjects - kSeen) * kDrawClk);
  const double predicted = (kObjects - kSeen) * (3.0 * kTriangles - kDrawClk);
  CHECK(static_cast<double>(all.cycles - seen.cycles) == Approx(predicted).epsilon(0.02));
}

TEST_CASE("draw culling: pictures stay as they are, and laws hold, on streams and machines of every kind") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    const traces::CommandStream stream = random_stream(seed, {.draws = 20, .triangles = 1});
    Settings settings{{"command_processor.cull_draws", "true"}};
    if (seed % 2 == 0) settings.emplace_back("command_processor.draws_in_flight", "1");
    const PlanRun run = run_plan(settings, seed % 3 == 0, stream);
    REQUIRE(run.failure == "");
    CHECK(run.digest == functional_digest(stream));
    CHECK(run.broken.empty());
  }
}
