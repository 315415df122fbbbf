#include "pipeline/report/limiter.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

#include "pipeline/render.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

UnitFigures unit(const std::string& path, std::int64_t busy, const std::vector<WaitFigure>& waits) {
  UnitFigures u;
  u.path = path;
  u.cycles = 1000;
  u.busy = busy;
  u.waits = waits;
  u.resources = {{"rate", "", hw::Resource::Kind::kRate, static_cast<double>(busy)}};
  return u;
}

LinkFigures link(const std::string& path, const std::string& from, const std::string& to, int latency,
                 double use = 0) {
  return {path, "link." + path, from, to, 4, 1, latency, 1, 10, use};
}

/// command_processor <- rop <- core_0 <-> texture_0: nothing is used up.
Figures waiting() {
  Figures f;
  f.frame.cycles = f.frame.render_cycles = 1000;
  f.links = {link("rop_to_command", "rop_0", "command_processor", 2),
             link("core_to_rop", "core_0", "rop_0", 2), link("texture_to_core", "texture_0", "core_0", 700),
             link("core_to_texture", "core_0", "texture_0", 3)};
  f.units = {unit("command_processor", 10, {{"retire_in", true, 900, "rop_to_command"}}),
             unit("rop_0", 50, {{"done_in", true, 800, "core_to_rop"}}),
             unit("core_0", 100, {{"texture_in", true, 850, "texture_to_core"}}),
             unit("texture_0", 60, {{"request_in", true, 900, "core_to_texture"}})};
  return f;
}

std::string limit_of(const char* scene, const std::vector<std::pair<std::string, std::string>>& settings) {
  return hw::contract::in_child([&] {
    scenes::SceneOptions options;
    options.width = 96;
    options.height = 64;
    MachineConfig config;
    for (const auto& [key, value] : settings) config.set(key, value, "test");
    return find_limiter(render_exact(scenes::load_scene(scene, options), config).figures).name;
  });
}

}  // namespace

TEST_CASE("limiter: a frame that was not simulated has none") {
  CHECK(find_limiter(Figures{}).kind == Limiter::Kind::kNothing);
}

TEST_CASE(
    "limiter: a rate that is used all the time is named with what its doubling saves: half the frame if "
    "nothing else bounds it") {
  Figures f = waiting();
  f.units[3].resources[0].cycles = 1000;
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.kind == Limiter::Kind::kUnit);
  CHECK(limiter.name == "texture");
  CHECK(limiter.resource == "texture.rate");
  CHECK(limiter.share == Approx(0.5).epsilon(0.01));
}

TEST_CASE("limiter: a second bound nearly as long as the first leaves little to save") {
  Figures f = waiting();
  f.units[3].resources[0].cycles = 1000;
  f.units[2].resources[0].cycles = 900;
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.name == "texture");
  CHECK(limiter.share < 0.12);
  CHECK(limiter.share > 0.05);
}

TEST_CASE("limiter: a rate and its losses add up, halving one leaves the other, and losses are no work") {
  Figures f = waiting();
  f.units.push_back(unit("memory_0", 0, {}));
  f.units.back().resources = {{"bus", "data bus", hw::Resource::Kind::kRate, 700},
                              {"rows", "data bus", hw::Resource::Kind::kLoss, 300}};
  // Nobody waits for it: it is no limit to the same degree.
  CHECK(sensitivity(f).gains[0].share == Approx(0.5 * 0.35).epsilon(0.01));
  f.units.back().resources.push_back({"queue_depth", "", hw::Resource::Kind::kPlaces, 200});
  const Sensitivity s = sensitivity(f);
  REQUIRE(s.gains.size() >= 2);
  CHECK(s.gains[0].resource == "memory.bus");
  CHECK(s.gains[0].share == Approx(0.35).epsilon(0.01));
  CHECK(s.gains[1].resource == "memory.rows");
  CHECK(s.gains[1].share == Approx(0.15).epsilon(0.01));
  CHECK(use_of(f.units.back()) == Approx(0.7));
  CHECK(speed_of_light(f).cycles == Approx(0.7 * static_cast<double>(f.frame.cycles)));
}

TEST_CASE(
    "limiter: places that are all taken while no rate is used up are named, those furthest downstream") {
  Figures f = waiting();
  f.units[2].resources.push_back({"warp_slots", "", hw::Resource::Kind::kPlaces, 950});
  f.units[3].resources.push_back({"cache_misses", "", hw::Resource::Kind::kPlaces, 800});
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.kind == Limiter::Kind::kPlaces);
  CHECK(limiter.resource == "texture.cache_misses");
  CHECK(limiter.share == Approx(0.5).epsilon(0.01));
}

TEST_CASE("limiter: phases of a frame are told from an even mixture") {
  Figures even = waiting(), phases = waiting();
  for (Figures* f : {&even, &phases}) {
    f->frame.cycles = f->frame.render_cycles = 100000;
    f->slice_cycles = 50000;
    for (UnitFigures& u : f->units) u.cycles = 100000;
  }
  const auto set = [](Figures& f, std::size_t unit, std::vector<double> at_end_of) {
    f.units[unit].resources[0].cycles = at_end_of.back();
    f.units[unit].resources[0].at_end_of = std::move(at_end_of);
  };
  for (Figures* f : {&even, &phases}) {
    set(*f, 0, {500, 1000});
    set(*f, 1, {2500, 5000});
  }
  set(even, 2, {25000, 50000});
  set(even, 3, {25000, 50000});
  set(phases, 2, {50000, 50000});
  set(phases, 3, {0, 50000});
  CHECK(sensitivity(even).gains.front().share < 0.03);
  CHECK(sensitivity(phases).gains[0].share == Approx(0.25).epsilon(0.02));  // half of its phase
  CHECK(sensitivity(phases).gains[1].share == Approx(0.25).epsilon(0.02));
}

TEST_CASE("limiter: the least time of a frame is that of its most used rate") {
  Figures f = waiting();
  f.units[3].resources[0].cycles = 640;
  CHECK(speed_of_light(f).cycles == Approx(640));
  CHECK(speed_of_light(f).resource == "texture");
}

TEST_CASE("limiter: a link that carries all it can is named by its key") {
  Figures f = waiting();
  f.links[1].use = 0.9;
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.kind == Limiter::Kind::kLink);
  CHECK(limiter.name == "link.core_to_rop");
}

TEST_CASE("limiter: a loop of waiting is named by its longest latency, not by one on the way to it") {
  Figures f = waiting();
  f.links[0].latency = 5000;
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.kind == Limiter::Kind::kLatency);
  CHECK(limiter.name == "link.texture_to_core");
  CHECK(limiter.walk == std::vector<std::string>{"command_processor", "rop", "core", "texture"});
  CHECK(limiter.loop == 2);
}

TEST_CASE("limiter: the walk ends at a unit that works more than it waits") {
  Figures f = waiting();
  f.units[2].busy = 500;
  f.units[2].waits[0].cycles = 400;
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.kind == Limiter::Kind::kWork);
  CHECK(limiter.name == "core");
}

TEST_CASE(
    "limiter: a frame that is mostly scan-out says so, with what scan-out waited for after the passes") {
  Figures f = waiting();
  f.links.push_back(link("command_to_scan", "command_processor", "scan_out", 2));
  f.links.push_back(link("scan_to_command", "scan_out", "command_processor", 2));
  f.links.push_back(link("l2_0_to_scan_out", "l2_0", "scan_out", 4));
  f.links.push_back(link("l2_1_to_scan_out", "l2_1", "scan_out", 4));
  f.units[0].waits = {{"scan_done_in", true, 550, "scan_to_command"},
                      {"retire_in", true, 440, "rop_to_command"}};
  f.units.push_back(unit("scan_out", 120,
                         {{"scan_in", true, 450, "command_to_scan"},
                          {"memory_in_0", true, 230, "l2_0_to_scan_out"},
                          {"memory_in_1", true, 200, "l2_1_to_scan_out"}}));
  f.frame.cycles = 1000;
  f.frame.render_cycles = 450;
  const Limiter limiter = find_limiter(f);
  CHECK(limiter.kind == Limiter::Kind::kWork);
  CHECK(limiter.name == "scan_out");
  CHECK(limiter.share == Approx(0.55));
  CHECK(limiter.text ==
        "scan-out: 55.0 % of the frame, after all passes were flushed; busy 12.0 %, waits for l2 43.0 %");
  f.frame.render_cycles = 500;
  f.units[0].waits = {{"retire_in", true, 500, "rop_to_command"},
                      {"scan_done_in", true, 490, "scan_to_command"}};
  CHECK(find_limiter(f).name == "link.texture_to_core");
  // The longest wait decides, not the half; and nobody else waits for scan-out, whatever its own ports say.
  f.units[0].waits = {{"scan_done_in", true, 480, "scan_to_command"},
                      {"retire_in", true, 440, "rop_to_command"}};
  f.frame.render_cycles = 520;
  CHECK(find_limiter(f).text.starts_with("scan-out: 48.0 % of the frame"));
  f.units[0].waits = {{"retire_in", true, 500, "rop_to_command"},
                      {"scan_done_in", true, 490, "scan_to_command"}};
  f.links.push_back(link("scan_to_core", "scan_out", "core_0", 9000));
  for (UnitFigures& u : f.units) {
    if (u.path == "core_0") u.waits.push_back({"request_in", true, 990, "scan_to_core"});
  }
  CHECK(find_limiter(f).name == "link.texture_to_core");
}

TEST_CASE("limiter: machines made narrow at one place are limited there") {
  CHECK(limit_of("builtin:cubes", {{"gpu.cores", "1"}}) == "core");
  CHECK(limit_of("builtin:overdraw",
                 {{"memory.t_burst", "1000"}, {"rop.cache_lines", "16"}, {"l2.cache_lines", "16"}}) ==
        "memory");
  CHECK(limit_of("builtin:fill", {{"gpu.cores", "64"}, {"fine_raster.quads_per_clk", "1"}}) == "fine_raster");
  CHECK(limit_of("builtin:cubes", {{"link.coarse_to_fine.latency", "100000"}}) == "link.coarse_to_fine");
  CHECK(limit_of("builtin:overdraw", {{"link.memory_to_l2.latency", "1000000"}}) == "link.memory_to_l2");
  CHECK(limit_of("builtin:triangle", {{"scan_out.lines_in_flight", "1"}}) == "scan_out");
}

TEST_CASE("limiter: no unit or link of a real frame is used more than all of the time") {
  const double worst = std::stod(hw::contract::in_child([] {
    scenes::SceneOptions options;
    options.width = 96;
    options.height = 64;
    const MachineConfig machine;
    return std::to_string(
        sensitivity(render_exact(scenes::load_scene("builtin:cubes", options), machine).figures)
            .uses.front()
            .use);
  }));
  CHECK(worst <= 1);
  CHECK(worst > 0.3);
}

TEST_CASE(
    "limiter: the page on it says what every doubling sets, and doublings change something on the default "
    "machine") {
  std::ifstream file(QUADRILLE_SOURCE_DIR "/docs/limit.md");
  std::stringstream page;
  page << file.rdbuf();
  const MachineConfig machine;
  for (const Doubling& doubling : doublings()) {
    std::string row = fmt::format("| `{}` | {} | ", doubling.resource, doubling.words);
    for (const DoublingStep& step : doubling.steps)
      row += fmt::format("{}`{}` {}", &step == &doubling.steps.front() ? "" : ", ", step.parameter,
                         step.factor == 2 ? "x 2" : "/ 2");
    INFO(row);
    CHECK(page.str().find(row + " |") != std::string::npos);
    CHECK_FALSE(settings_of(doubling, machine).empty());
  }
}
