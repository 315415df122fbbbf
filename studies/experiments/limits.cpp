/// How often the report names the right limit: every resource of many frames and machines is doubled, and
/// what that gains is set beside what one run expected.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/report/limiter.h"
#include "scenes/scene.h"
#include "studies/experiments/experiment.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

using Settings = std::vector<std::string>;

/// Machines that are unlike in what limits them.
const std::vector<Settings>& machines() {
  static const std::vector<Settings> all{
      {},
      {"gpu.cores=16"},
      {"gpu.cores=2", "gpu.channels=4"},
      {"gpu.cores=32", "gpu.channels=8", "gpu.partitions=4"},
      {"memory.t_burst=8", "memory.t_ccd_s=8", "memory.t_ccd_l=8"},
      {"gpu.cores=16", "memory.kind=ddr4"},
      {"memory.path_clk=2000", "memory.queue_depth=4096"},
      {"core.warp_slots=4"},
      {"core.alu_clk=40", "core.warp_slots=8"},
      {"texture.filter_quads_per_clk=1", "texture.address_quads_per_clk=1", "gpu.cores=8"},
      {"texture.cache_misses=2", "gpu.cores=8"},
      {"gpu.cores=32", "fine_raster.quads_per_clk=1"},
      {"gpu.cores=16", "rop.quads_per_clk=1", "depth.quads_per_clk=1"},
      {"scan_out.lines_in_flight=4"},
      {"vertex_fetch.batch_slots=4"},
      {"gpu.cores=16", "l2.cache_lines=256", "memory.banks=4"}};
  return all;
}

/// The best doubling, or one that gains no less by more than this part of the frame.
constexpr double kNearBest = 0.02;
/// An expected gain is right within this part of the measured one, or of the frame.
constexpr double kGainPart = 1.0 / 3, kGainFrame = 0.02;
constexpr double kRightOften = 0.95;

struct Case {
  std::string scene, machine;
  /// part of the frame, by resource that a parameter doubles
  std::map<std::string, double> expected, measured;

  /// What the report names. A gain that it does not name is no gain that it was right about.
  [[nodiscard]] std::vector<std::string> named() const {
    std::vector<std::string> names;
    for (const auto& [name, gain] : expected)
      if (gain >= pipeline::kLeastNamedGain) names.push_back(name);
    std::ranges::stable_sort(names, std::ranges::greater{},
                             [&](const std::string& name) { return expected.at(name); });
    names.resize(std::min(names.size(), pipeline::kNamedGains));
    return names;
  }
  [[nodiscard]] const std::string& best() const {
    return std::ranges::max_element(measured, {}, [](const auto& gain) { return gain.second; })->first;
  }
  /// Where the report names none, none may gain more than that.
  [[nodiscard]] bool first_is_right() const {
    const std::vector<std::string> names = named();
    return (names.empty() ? 0 : measured.at(names.front())) >= measured.at(best()) - kNearBest;
  }
  [[nodiscard]] bool gain_is_right(const std::string& name) const {
    const double error = std::abs(expected.at(name) - measured.at(name));
    return error <= kGainFrame || error <= kGainPart * std::abs(measured.at(name));
  }
};

std::string machine_text(const Settings& settings) {
  return settings.empty() ? "default" : fmt::format("{}", fmt::join(settings, " "));
}

std::vector<Case> judge(const std::vector<std::pair<std::string, traces::CommandStream>>& streams,
                        const Setting& setting) {
  std::vector<Frame> bases;
  std::vector<Case> cases;
  for (const auto& [name, stream] : streams) {
    for (const Settings& settings : machines()) {
      bases.push_back({&stream, settings});
      cases.push_back({name, machine_text(settings), {}, {}});
    }
  }
  const std::vector<Readings> read = draw(bases, setting);
  std::vector<Frame> doubled;
  std::vector<std::pair<std::size_t, std::string>> whose;
  for (std::size_t i = 0; i < bases.size(); ++i) {
    pipeline::MachineConfig machine;
    apply_settings(machine, bases[i].settings);
    for (const pipeline::Doubling& doubling : pipeline::doublings()) {
      const Settings more = pipeline::settings_of(doubling, machine);
      if (more.empty()) continue;
      cases[i].expected[doubling.resource] = read[i].gain(doubling.resource);
      doubled.push_back(bases[i]);
      doubled.back().settings.insert(doubled.back().settings.end(), more.begin(), more.end());
      whose.emplace_back(i, doubling.resource);
    }
  }
  const std::vector<Readings> again = draw(doubled, setting);
  for (std::size_t j = 0; j < again.size(); ++j) {
    const auto& [i, resource] = whose[j];
    cases[i].measured[resource] = 1 - again[j]["frame.cycles"] / read[i]["frame.cycles"];
  }
  return cases;
}

}  // namespace

Result limits(const Setting& setting) {
  std::vector<std::pair<std::string, traces::CommandStream>> streams;
  for (const auto& [name, load] : setting.scenes) streams.emplace_back(name, load());
  const std::vector<Case> cases = judge(streams, setting);
  Result result;
  result.table.head = {"scene",   "machine", "expected (measured) gain of the doublings named, %",
                       "best, %", "first",   "gains"};
  std::string data;
  std::size_t firsts = 0, gains = 0, right_gains = 0;
  for (const Case& c : cases) {
    std::string text;
    bool right = true;
    for (const std::string& name : c.named()) {
      const bool one = c.gain_is_right(name);
      right = right && one;
      ++gains;
      right_gains += one;
      text += fmt::format("{}{} {:.0f} ({:.0f})", text.empty() ? "" : ", ", name, 100 * c.expected.at(name),
                          100 * c.measured.at(name));
      data += fmt::format("{} {}\n", 100 * c.measured.at(name), 100 * c.expected.at(name));
    }
    firsts += c.first_is_right();
    result.table.rows.push_back({c.scene, c.machine, text,
                                 fmt::format("{} {:.0f}", c.best(), 100 * c.measured.at(c.best())),
                                 c.first_is_right() ? "right" : "WRONG", right ? "right" : "WRONG"});
  }
  const auto part = [](std::size_t of, std::size_t all) {
    return all > 0 ? static_cast<double>(of) / static_cast<double>(all) : 0;
  };
  result.verdicts = {
      {fmt::format("frames whose first doubling is the best, or gains at most {:.0f} % of the frame less",
                   100 * kNearBest),
       part(firsts, cases.size()), kRightOften, 1},
      {"gains named within a third of the measured ones, or 2 % of the frame", part(right_gains, gains),
       kRightOften, 1}};
  result.remarks = {fmt::format(
      "{} frames and machines, each drawn again with every resource doubled that a parameter sets; the rate "
      "of the L2 slices, "
      "of scan-out and of the work distributor is fixed, and no doubling of them can be measured.",
      cases.size())};
  result.plot =
      "set xlabel 'measured gain, % of the frame'\nset ylabel 'expected gain, %'\nset grid\nset key off\n$d "
      "<< EOD\n" +
      data + "EOD\nplot $d with points pt 7 ps 0.6, x with lines lc rgb 'gray'";
  return result;
}

}  // namespace quadrille::studies::experiments
