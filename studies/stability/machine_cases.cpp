/// Cases of machines at their edges: links of one place, latencies of a million cycles, clocks a thousand to
/// one, caches of one line, one core and 64.
#include "pipeline/report/limiter.h"
#include "pipeline/report/report.h"
#include "studies/stability/machine_picture.h"
#include "studies/stability/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/scene.h"

namespace quadrille::studies::stability {

namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

void apply(pipeline::MachineConfig& machine, const Settings& settings) {
  for (const auto& [key, value] : settings) machine.set(key, value, "stability");
}

/// The same parameter of every link.
Settings every_link(const std::string& parameter, const std::string& value) {
  Settings settings;
  const pipeline::MachineConfig machine;
  for (const auto& [path, group] : machine.groups()) {
    if (path.starts_with("link.")) settings.emplace_back(path + "." + parameter, value);
  }
  return settings;
}

/// One line, one way, one miss under way in every cache.
Settings one_line_caches() {
  Settings settings;
  const pipeline::MachineConfig machine;
  for (const auto& [path, group] : machine.groups()) {
    for (const char* parameter : {"cache_lines", "cache_ways", "cache_misses"}) {
      if (group->find(parameter) != nullptr) settings.emplace_back(path + "." + parameter, "1");
    }
  }
  return settings;
}

Settings joined(Settings a, const Settings& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The least cycles in which the memory channels can move what they moved.
double memory_bound(const Observed& o) {
  return static_cast<double>(pipeline::memory_bytes(o.exact.figures)) /
         pipeline::peak_memory_bytes_per_cycle(*o.machine);
}

/// The least cycles in which the links of a class can pass what they passed: a slot is free again after the
/// round trip. None: the machine has no such link.
std::optional<double> link_bound(const Observed& o, const std::string& key) {
  std::optional<double> most;
  for (const pipeline::LinkFigures& link : o.exact.figures.links) {
    if (link.key != key) continue;
    const double rounds =
        link.tokens == 0 ? 0 : std::floor(static_cast<double>(link.tokens - 1) / link.depth);
    most = std::max(most.value_or(0), rounds * (link.latency + link.credit_latency));
  }
  return most;
}

/// What is expected of a machine.
struct Expected {
  std::vector<std::string> limits = {};  ///< the limiter's name is one of these
  bool memory = false;                   ///< the frame's time is that of memory's bytes, within `factor`
  std::string link = {};                 ///< the frame's time is that of this class of links, within `factor`
  double factor = 2;
};

void check_machine(const Observed& o, const Expected& expected, Findings& f) {
  const pipeline::Limiter limiter = pipeline::find_limiter(o.exact.figures);
  const bool named = std::ranges::find(expected.limits, limiter.name) != expected.limits.end();
  f.add(
      {"what limits it", limiter.name, "= " + fmt::format("{}", fmt::join(expected.limits, " or ")), named});
  const auto cycles = static_cast<double>(o.exact.figures.frame.cycles);
  if (expected.memory) {
    f.at_least("cycles, beside bytes over bandwidth", cycles, memory_bound(o));
    f.at_most("cycles, beside a multiple of that", cycles, expected.factor * memory_bound(o));
  }
  if (expected.link.empty()) return;
  const double least = link_bound(o, expected.link).value_or(NAN);  // which nothing is above or below
  f.at_least("cycles, beside tokens times round trip over depth", cycles, least);
  f.at_most("cycles, beside a multiple of that", cycles, expected.factor * least);
}

Case machine_case(const std::string& name, const std::string& purpose, const std::string& scene,
                  const Settings& settings, const Expected& expected) {
  return {.name = name,
          .group = "machines",
          .purpose = fmt::format("{} ({})", purpose, scene),
          .must = "the picture of any other machine; it names what limits it",
          .build =
              [scene] {
                scenes::SceneOptions options;
                options.width = 160;
                options.height = 120;
                return scenes::load_scene("builtin:" + scene, options);
              },
          .machine = [settings](pipeline::MachineConfig& machine) { apply(machine, settings); },
          .check = [expected](const Observed& o, Findings& f) { check_machine(o, expected, f); },
          .picture = machine_picture};
}

}  // namespace

void add_machine_cases(std::vector<Case>& cases) {
  const std::string million = "1000000";
  cases.push_back(machine_case("default-machine", "the default machine, to compare with", "cubes", {},
                               {.limits = {"core"}}));
  cases.push_back(machine_case("depth-1", "every link holds one token", "overdraw",
                               joined(every_link("depth", "1"), {{"gpu.cores", "16"}, {"l2.hit_clk", "1"}}),
                               {.limits = {"link.client_to_l2"}, .link = "link.client_to_l2"}));
  cases.push_back(machine_case("latency-1e6-raster",
                               "a million cycles from coarse to fine raster, one elsewhere", "cubes",
                               joined(every_link("latency", "1"), {{"link.coarse_to_fine.latency", million}}),
                               {.limits = {"link.coarse_to_fine"}, .link = "link.coarse_to_fine"}));
  cases.push_back(
      machine_case("latency-1e6-texture", "a million cycles from texture units to cores, one elsewhere",
                   "cubes", joined(every_link("latency", "1"), {{"link.texture_to_core.latency", million}}),
                   {.limits = {"link.texture_to_core"}, .link = "link.texture_to_core"}));
  cases.push_back(machine_case("latency-1e6-memory",
                               "a million cycles from memory to the L2 cache, one elsewhere", "overdraw",
                               joined(every_link("latency", "1"), {{"link.memory_to_l2.latency", million}}),
                               {.limits = {"link.memory_to_l2"}}));
  cases.push_back(machine_case(
      "latency-1e6-commands", "a million cycles from a draw's end to the command processor, one elsewhere",
      "cubes", joined(every_link("latency", "1"), {{"link.rop_to_command.latency", million}}),
      {.limits = {"link.rop_to_command"}}));
  cases.push_back(machine_case("slow-memory-clock", "a memory clock of a thousandth of the GPU's", "overdraw",
                               {{"gpu.memory_mhz", "1"}}, {.limits = {"memory"}}));
  cases.push_back(machine_case("slow-gpu-clock", "a GPU clock of a thousandth of the memory's", "cubes",
                               {{"gpu.clock_mhz", "1"}}, {.limits = {"core"}}));
  cases.push_back(machine_case("irrational-clocks", "a memory clock of 1000 / pi MHz", "cubes",
                               {{"gpu.memory_mhz", "318.309886183791"}}, {.limits = {"core"}}));
  cases.push_back(machine_case("one-line-caches", "every cache holds one line and asks for one at a time",
                               "cubes", one_line_caches(), {.limits = {"l2"}}));
  cases.push_back(machine_case("thousandth-bandwidth",
                               "a thousandth of the memory's bandwidth, and caches too small to hide it",
                               "cubes",
                               {{"memory.t_burst", "1000"},
                                {"l2.cache_lines", "16"},
                                {"texture.cache_lines", "16"},
                                {"rop.cache_lines", "16"},
                                {"depth.cache_lines", "16"}},
                               {.limits = {"memory"}, .memory = true}));
  cases.push_back(machine_case("cores-1", "one core", "cubes", {{"gpu.cores", "1"}}, {.limits = {"core"}}));
  cases.push_back(machine_case("cores-64", "64 cores", "overdraw", {{"gpu.cores", "64"}},
                               {.limits = {"fine_raster", "rop"}}));
  cases.push_back(machine_case("everything-64", "64 cores, 64 partitions, 64 channels", "cubes",
                               {{"gpu.cores", "64"}, {"gpu.partitions", "64"}, {"gpu.channels", "64"}},
                               {.limits = {"command_processor"}}));
  cases.back().slow = true;
}

}  // namespace quadrille::studies::stability
