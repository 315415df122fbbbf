/// What moved in each slice of a frame: it adds up to what was counted, and the tokens of links are those
/// that somebody sees who looks at the links after every action.
#include "pipeline/report/flow_log.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <numeric>

#include "hw/base/native_driver.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/random_machine.h"
#include "tests/pipeline/random_stream.h"

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

using Slices = std::vector<std::uint64_t>;

constexpr DetailOptions kTimeline{.timeline = true};

std::uint64_t sum(const Slices& slices) {
  return std::accumulate(slices.begin(), slices.end(), std::uint64_t{0});
}

/// Of all units of a kind.
std::uint64_t counted(const Figures& f, std::string_view kind, std::string_view counter) {
  std::uint64_t total = 0;
  for (const UnitFigures& unit : f.units)
    for (const CounterFigure& c : unit.counters)
      if (without_number(unit.path) == kind && c.name == counter) total += c.value;
  return total;
}

/// What slices do not add up to; empty: nothing.
std::string lost(const Figures& f) {
  std::string text;
  const auto same = [&](std::string_view what, std::uint64_t slices, std::uint64_t total) {
    if (slices != total) text += fmt::format("{}: {} in slices, {} in all; ", what, slices, total);
  };
  for (std::size_t i = 0; i < f.bandwidth.size(); ++i) {
    same(f.bandwidth[i].name, sum(f.flow->asked[i].read), f.bandwidth[i].read_bytes);
    same(f.bandwidth[i].name, sum(f.flow->asked[i].written), f.bandwidth[i].write_bytes);
  }
  std::uint64_t read = 0;
  for (const ClientCurve& c : f.flow->memory) {
    read += sum(c.read);
    const bool writes = c.client == "write_back";
    same(c.client, sum(c.read), writes ? 0 : counted(f, "memory", "read_bytes_" + c.client));
    same(c.client, sum(c.written), writes ? counted(f, "memory", "write_bytes") : 0);
  }
  same("memory", read, counted(f, "memory", "read_bytes"));
  for (const LinkCurve& link : f.flow->links) {
    std::uint64_t held = 0;
    for (const LinkFigures& l : f.links) held += l.key == link.key ? l.held_ticks : 0;
    same(link.key, sum(link.held), held);
  }
  return text;
}

/// Tokens of each class of links in each slice, seen by looking at them whenever a unit has acted.
class Watcher {
 public:
  Watcher(const Machine& machine, hw::Tick slice)
      : machine_(machine), slice_(slice), seen_(machine.links().size(), 0) {}
  void note(hw::Tick now) {
    pass(now);
    for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i] = machine_.links()[i]->occupancy();
  }
  /// Up to `end`, with all that is behind the last slice in it.
  [[nodiscard]] std::map<std::string, Slices> slices(hw::Tick end, std::size_t count) {
    pass(end);
    for (auto& [key, slices] : held_) {
      slices.resize(std::max(slices.size(), count), 0);
      for (std::size_t s = count; s < slices.size(); ++s) slices[count - 1] += slices[s];
      slices.resize(count);
    }
    return held_;
  }

 private:
  void pass(hw::Tick now) {
    while (at_ < now) {
      const auto s = static_cast<std::size_t>(at_ / slice_);
      const hw::Tick until = std::min(now, static_cast<hw::Tick>(s + 1) * slice_);
      for (std::size_t i = 0; i < seen_.size(); ++i) {
        Slices& held = held_[machine_.link_keys()[i]];
        held.resize(std::max(held.size(), s + 1), 0);
        held[s] += static_cast<std::uint64_t>(seen_[i]) * static_cast<std::uint64_t>(until - at_);
      }
      at_ = until;
    }
  }
  const Machine& machine_;
  hw::Tick slice_, at_ = 0;
  std::vector<int> seen_;
  std::map<std::string, Slices> held_;
};

}  // namespace

TEST_CASE("flow: slices add up to the counters and to what links held, whatever the machine") {
  for (const std::uint64_t seed : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U}) {
    INFO("seed " << seed);
    const std::string wrong = hw::contract::in_child([seed] {
      MachineConfig config;
      if (seed != 0) test::randomize(config, seed);
      const RenderedFrame frame = render_exact(test::random_stream(seed), config, {}, {}, kTimeline);
      return failed_checks(frame.figures) + lost(frame.figures);
    });
    CHECK(wrong.empty());
    if (!wrong.empty()) WARN(wrong);
  }
}

TEST_CASE("flow: with a window, and with several front ends and engines, slices add up too") {
  const std::string wrong = hw::contract::in_child([] {
    MachineConfig config;
    config.gpu.front_ends.set(2);
    config.gpu.engines.set(2);
    MachineOptions options;
    options.window = hw::Clock(1'000'000'000).edge(200);
    const RenderedFrame frame = render_exact(test::random_stream(4), config, options, {}, kTimeline);
    return failed_checks(frame.figures) + lost(frame.figures);
  });
  CHECK(wrong == "");
}

TEST_CASE("flow: tokens of a slice are those that are seen in the links at every moment of it") {
  const traces::CommandStream stream = test::random_stream(5);
  const MachineConfig config;
  DeviceFrame frame(std::uint64_t{1} << 30);
  build_frame(stream, config.precision(), frame, true, config.frame_target());
  hw::NativeDriver driver("native_driver");
  MachineOptions options;
  options.external_driver = &driver;
  Machine machine(config, frame, options);
  const FlowLog log(machine);
  Watcher watcher(machine, hw::Resources::kFirstSlice);
  driver.observe([&](const hw::Unit& unit) { watcher.note(unit.last_action()); });
  machine.run({});
  Figures figures = collect_figures(machine, frame);
  log.collect(figures);
  REQUIRE(figures.flow);
  const FlowFigures& flow = *figures.flow;
  REQUIRE(flow.slice == hw::Resources::kFirstSlice);
  REQUIRE(flow.slices > 3);
  const std::map<std::string, Slices> seen = watcher.slices(flow.end, flow.slices);
  REQUIRE(seen.size() == flow.links.size());
  for (const LinkCurve& link : flow.links) {
    INFO(link.key);
    CHECK(link.held == seen.at(link.key));
  }
}
