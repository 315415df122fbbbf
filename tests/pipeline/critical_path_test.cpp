/// The chain of waits that a frame's end hangs on: it adds up to the frame, changes nothing, and lies where
/// the frame is known to wait.
#include "pipeline/report/critical_path.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/random_machine.h"
#include "tests/pipeline/random_stream.h"

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

constexpr DetailOptions kPath{.draws = true, .path = true};

hw::Tick ticks_of(const std::vector<PathShare>& parts) {
  hw::Tick sum = 0;
  for (const PathShare& part : parts) sum += part.ticks;
  return sum;
}

/// What is wrong with the path of a frame; empty: nothing.
std::string faults(const Figures& f) {
  std::string text = failed_checks(f);
  hw::Tick draws = 0;
  for (const CriticalPath::OfDraw& draw : f.path->draws) {
    draws += draw.ticks;
    if (draw.ticks != ticks_of(draw.parts)) text += "a draw's parts do not add up; ";
    if (draw.draw != hw::kNoDraw && draw.draw.index() >= f.frame.draws) text += "a draw that there is not; ";
  }
  if (draws != f.path->ticks || ticks_of(f.path->parts) != draws)
    text += fmt::format("draws {}, parts {}, frame {}; ", draws, ticks_of(f.path->parts), f.path->ticks);
  for (std::size_t i = 0; i < f.detail->draws.size(); ++i) {
    const double cycles = static_cast<double>(ticks_of(f.path->of_each.at(i))) * f.frame.clock_mhz * 1e-9;
    if (std::abs(cycles - static_cast<double>(f.detail->draws[i].in_flight())) > 0.01)
      text += fmt::format("draw {}: {} cycles instead of {}; ", i, cycles, f.detail->draws[i].in_flight());
  }
  return text;
}

/// Units whose time is on the path for longer than they were busy, by their own accounts; empty: none. Of
/// units with much in hand, queues count too.
std::string more_than_busy(const Figures& f) {
  std::map<std::string, double> busy;
  for (const UnitFigures& unit : f.units)
    busy[std::string(without_number(unit.path))] += static_cast<double>(unit.busy) /
                                                    static_cast<double>(unit.cycles) *
                                                    static_cast<double>(f.path->ticks);
  std::string text;
  for (const PathShare& part : f.path->parts) {
    if (part.part != PathPart::kBusy) continue;
    if (part.of == "core" || part.of == "texture" || part.of == "load_store" || part.of == "memory") continue;
    if (static_cast<double>(part.ticks) > 1.001 * busy[part.of] + 2e6) text += part.of + " ";
  }
  return text;
}

std::string outcome(const RenderedFrame& frame) {
  std::string text =
      fmt::format("{} cycles, {} actions: ", frame.figures.frame.cycles, frame.figures.host.actions);
  for (const std::uint32_t pixel : frame.image.color) text += fmt::format("{:x} ", pixel);
  return text;
}

/// Share of the path that a kind of units spends or waits for, on a small machine with these settings.
double share_of(const std::string& scene, const std::vector<std::pair<std::string, std::string>>& settings,
                std::string_view kind) {
  scenes::SceneOptions options;
  options.width = 160;
  options.height = 90;
  const traces::CommandStream stream = scenes::load_scene(scene, options);
  MachineConfig config;
  for (const auto& [name, value] : settings) config.set(name, value, "test");
  const std::string share = hw::contract::in_child([&] {
    const RenderedFrame frame = render_exact(stream, config, {}, {}, kPath);
    hw::Tick ticks = 0;
    for (const PathShare& part : frame.figures.path->parts)
      if (part.by == kind) ticks += part.ticks;
    return faults(frame.figures) +
           fmt::format("{}", static_cast<double>(ticks) / static_cast<double>(frame.figures.path->ticks));
  });
  return std::stod(share);
}

}  // namespace

TEST_CASE("critical path: of random frames on random machines it adds up and changes nothing") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const traces::CommandStream stream = test::random_stream(seed);
    MachineConfig config;
    if (seed % 3 != 0) test::randomize(config, seed);
    if (seed % 2 == 0) config.gpu.clock_mhz.parse("1755");  // cycles of unequal length
    INFO("seed " << seed);
    const MachineOptions options{.window = seed % 4 == 0 ? hw::Tick{50'000'000} : 0};
    const auto run = [&](const DetailOptions& detail) {
      return hw::contract::in_child([&] {
        const RenderedFrame frame = render_exact(stream, config, options, {}, detail);
        return (detail.path ? faults(frame.figures) + more_than_busy(frame.figures) : "") + outcome(frame);
      });
    };
    CHECK((run({}) == run(kPath)));
  }
}

TEST_CASE("critical path: the same by either driver and in any order of the modules") {
  const traces::CommandStream stream = test::random_stream(5);
  const MachineConfig config;
  const auto parts = [&](const MachineOptions& options) {
    return hw::contract::in_child([&] {
      std::string text;
      const RenderedFrame frame = render_exact(stream, config, options, {}, kPath);
      for (const PathShare& part : frame.figures.path->parts)
        text += fmt::format("{} {} {} {}; ", part.of, name_of(part.part), part.by, part.ticks);
      return text;
    });
  };
  const std::string plain = parts({});
  CHECK(plain.find("core busy") != std::string::npos);
  CHECK(parts({.driver = DriverKind::kNative}) == plain);
  CHECK(parts({.module_order = 7}) == plain);
}

TEST_CASE("critical path: it lies in the cores where lanes are few, and in memory where that is slow") {
  CHECK(share_of("builtin:cubes", {{"core.simd_lanes", "4"}, {"gpu.cores", "2"}}, "core") > 0.85);
  CHECK(
      share_of(
          "builtin:materials",
          {{"gpu.cores", "16"}, {"memory.t_burst", "16"}, {"memory.t_ccd_s", "16"}, {"memory.t_ccd_l", "16"}},
          "memory") > 0.5);
}
