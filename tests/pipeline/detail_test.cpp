/// What single draws and parts of the screen did: known by construction, adding up to the frame, and without
/// influence on it.
#include "pipeline/report/detail_log.h"

#include <fmt/ranges.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

#include "pipeline/render.h"
#include "pipeline/report/figures.h"
#include "pipeline/report/report.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/broken_laws.h"
#include "tests/pipeline/random_stream.h"

using namespace quadrille;
using namespace quadrille::pipeline;

using test::link;

namespace {

constexpr DetailOptions kBoth{.draws = true, .tiles = true};
constexpr DetailOptions kAll{.draws = true, .tiles = true, .timeline = true};

/// Everything that a run says but the host's cost and the details, as text. Laws of details are not among it.
std::string outcome(const traces::CommandStream& stream, const MachineConfig& config, DetailOptions detail) {
  return hw::contract::in_child([&] {
    RenderedFrame frame = render_exact(stream, config, {}, {}, detail);
    std::string text;
    for (const Check& c : frame.figures.checks)
      if (!c.holds()) text += c.law + " is broken\n";
    frame.figures.detail.reset();
    frame.figures.flow.reset();
    frame.figures.report_timeline = false;
    frame.figures.host = {};
    frame.figures.checks.clear();
    text += report_json({frame.figures, config, frame.image.width, frame.image.height});
    for (const std::uint32_t pixel : frame.image.color) text += fmt::format("{:x} ", pixel);
    for (const float depth : frame.image.depth) text += fmt::format("{} ", depth);
    return text;
  });
}

/// Renders a built-in scene of 96x64 pixels in a process of its own, and gives what `tell` says of its
/// details.
std::string told(const std::string& scene, const std::function<std::string(const Detail&)>& tell) {
  return hw::contract::in_child([&] {
    scenes::SceneOptions options;
    options.width = 96;
    options.height = 64;
    const RenderedFrame frame =
        render_exact(scenes::load_scene(scene, options), MachineConfig(), {}, {}, kBoth);
    return frame.figures.checks_hold() ? tell(*frame.figures.detail) : failed_checks(frame.figures);
  });
}

/// Distinct values of a count over the draws.
std::string values(const Detail& d, DrawCount count) {
  std::vector<std::uint64_t> all;
  for (const DrawFigures& draw : d.draws) all.push_back(draw.of(count));
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return fmt::format("{} ", fmt::join(all, ","));
}

}  // namespace

TEST_CASE("detail: with and without it pixels, cycles and figures are the same, and all laws hold") {
  for (const std::uint64_t seed : {3U, 5U, 8U}) {
    const traces::CommandStream stream = test::random_stream(seed);
    MachineConfig config;
    if (seed == 8) config.rop.cache_lines.set(16);  // lines are evicted
    INFO("stream " << seed);
    const std::string without = outcome(stream, config, {}), with = outcome(stream, config, kAll);
    CHECK(without.starts_with("{"));
    CHECK(with == without);
  }
}

TEST_CASE("detail: layers over the whole screen are draws of as many fragments as it has pixels") {
  const auto tell = [](const Detail& d) {
    return fmt::format("{} draws: ", d.draws.size()) + values(d, DrawCount::kTrianglesIn) +
           values(d, DrawCount::kCovered) + values(d, DrawCount::kShaded) + values(d, DrawCount::kWritten) +
           values(d, DrawCount::kKilledEarly);
  };
  CHECK(told("builtin:fill", tell) == "8 draws: 2 6144 6144 6144 0 ");
  CHECK(told("builtin:overdraw", tell) == "16 draws: 2 6144 6144 6144 0 ");
}

TEST_CASE("detail: squares of the screen hold the fragments of their pixels") {
  const auto tell = [](const Detail& d) {
    const auto& shaded = d.tiles.counts[static_cast<std::size_t>(TileCount::kShaded)];
    const auto& written = d.tiles.counts[static_cast<std::size_t>(TileCount::kWritten)];
    return fmt::format("{}x{} of {}: {} | {}", d.tiles.width, d.tiles.height, d.tiles.pixels,
                       fmt::join(shaded, " "), fmt::join(written, " "));
  };
  const std::string all = "8192 8192 8192 8192 8192 8192 0";
  CHECK(told("builtin:fill", tell) == "3x2 of 32: " + all + " | " + all);
}

TEST_CASE("detail: work of a pass that is not shown has no place on the screen") {
  const std::string text = hw::contract::in_child([] {
    traces::CommandStream stream = test::random_stream(5);
    const std::vector<traces::Command> once = stream.commands;
    stream.commands.insert(stream.commands.end(), once.begin(), once.end());
    const RenderedFrame frame = render_exact(stream, MachineConfig(), {}, {}, kBoth);
    const Detail& d = *frame.figures.detail;
    std::uint64_t hidden = 0, shown = 0;
    for (const DrawFigures& draw : d.draws)
      (draw.pass.index() == 0 ? hidden : shown) += draw.of(DrawCount::kShaded);
    const auto& cells = d.tiles.counts[static_cast<std::size_t>(TileCount::kShaded)];
    const std::uint64_t placed = std::accumulate(cells.begin(), cells.end() - 1, std::uint64_t{0});
    return failed_checks(frame.figures) + fmt::format("{} {} {}", hidden > 0 && hidden == cells.back(),
                                                      shown == placed, d.draws.back().pass.index());
  });
  CHECK(text == "true true 1");
}

TEST_CASE("detail: what is written back counts for the draw that wrote it last, and the rest for none") {
  // Every line of the target is written by all eight layers and stays in the cache until the flush.
  const auto tell = [](const Detail& d) {
    std::uint64_t before = 0;
    for (std::size_t i = 0; i + 1 < d.draws.size(); ++i) before += d.draws[i].of(DrawCount::kColorBytes);
    const auto& bytes = d.tiles.counts[static_cast<std::size_t>(TileCount::kBytes)];
    return fmt::format("{} {} {} {}", before, d.draws.back().of(DrawCount::kColorBytes),
                       d.outside_draws.of(DrawCount::kColorBytes), fmt::join(bytes, " "));
  };
  CHECK(told("builtin:fill", tell) == "0 24576 0 4096 4096 4096 4096 4096 4096 0");
}

TEST_CASE("detail: draws retire in their order, within the frame, and their work names what limits them") {
  const auto tell = [](const Detail& d) {
    std::string wrong;
    for (std::size_t i = 0; i < d.draws.size(); ++i) {
      const DrawFigures& draw = d.draws[i];
      if (draw.in_flight() <= 0 || (i > 0 && draw.retired < d.draws[i - 1].retired))
        wrong += fmt::format("draw {} ", i);
      if (draw.label.empty()) wrong += fmt::format("label {} ", i);
      const DrawLimiter l = d.limiter(draw);
      if (l.unit.empty() || l.work > static_cast<double>(draw.in_flight()))
        wrong += fmt::format("limiter {} ", i);
    }
    return wrong;
  };
  CHECK(told("builtin:fill", tell).empty());
  CHECK(told("builtin:cubes", tell).empty());
}

TEST_CASE("detail: a draw that nobody worked for, or for a short time, is limited by latency") {
  Detail d;
  d.kinds = {"core", "rop"};
  DrawFigures draw;
  draw.retired = 100;
  draw.work = {0, 0};
  CHECK(d.limiter(draw).kind() == "latency");
  CHECK(d.limiter(draw).unit.empty());
  draw.work = {20, 49};
  CHECK(d.limiter(draw).kind() == "latency");
  CHECK(d.limiter(draw).unit == "rop");
  draw.work = {50, 49};
  CHECK(d.limiter(draw).kind() == "core");
  CHECK(d.limiter(draw).share == 0.5);
}

TEST_CASE("detail: work that is charged to another draw is noticed") {
  const std::string requests = test::broken_laws(
      [](const Machine& machine) {
        link<hw::MemoryRequest>(machine, "vertex_fetch_to_l2_0")
            .inject_fault([n = 0](hw::MemoryRequest& r) mutable {
              if (++n == 3) r.draw = hw::DrawId(r.draw == hw::DrawId(0) ? 1 : 0);
            });
      },
      kBoth);
  CHECK(requests == "each draw: requests of clients = requests looked up in L2\n");
  const std::string fills = test::broken_laws(
      [](const Machine& machine) {
        link<hw::MemoryRequest>(machine, "l2_to_memory_0")
            .inject_fault([n = 0](hw::MemoryRequest& r) mutable {
              if (r.kind == hw::MemoryRequest::Kind::kRead && ++n == 3) r.draw = hw::kNoDraw;
            });
      },
      kBoth);
  CHECK(fills == "each draw: bytes filled into L2 = bytes read from memory\n");
}

TEST_CASE("detail: a sum that lacks something breaks its law, of draws, tiles and busy cycles") {
  const auto broken = [](const std::function<void(Detail&)>& harm) {
    Detail d;
    d.draws.resize(2);
    for (auto& counts : d.tiles.counts) counts.assign(3, 0);
    harm(d);
    hw::Audit audit;
    d.audit(audit);
    std::string lines;
    for (const hw::Audit::Sides& s : audit.all())
      if (s.left != s.right) lines += std::string(s.law->text) + "\n";
    return lines;
  };
  CHECK(broken([](Detail&) {}).empty());
  CHECK(broken([](Detail& d) { d.draw_totals[static_cast<std::size_t>(DrawCount::kTexels)] = 1; }) ==
        "texels for draws and for none = for the frame\n");
  CHECK(broken([](Detail& d) { d.tiles.counts[static_cast<std::size_t>(TileCount::kBytes)][2] = 1; }) ==
        "bytes of depth and colour of tiles and of none = of the frame\n");
  CHECK(broken([](Detail& d) { d.busy_total = 1; }) == "busy cycles for draws and for none = of the units\n");
}
