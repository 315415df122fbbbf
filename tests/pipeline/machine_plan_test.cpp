/// The machine plan says what the machine is: the order of the flow that is derived from it, and the links
/// and ports of an elaborated machine against it.
#include "pipeline/machine/machine.h"
#include "pipeline/machine/planned_links.h"
#include "pipeline/report/figures.h"
#include "pipeline/report/report.h"
#include "pipeline/report/sensitivity.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/plan_run.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <set>

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

const hw::PortBase& port_at(const hw::Unit& unit, const hw::FifoBase& link) {
  return **std::ranges::find_if(unit.ports(), [&](const hw::PortBase* p) { return &p->fifo() == &link; });
}

/// "from to": of the wires of a class.
std::set<std::string> planned_ends(std::string_view key) {
  std::set<std::string> ends;
  for (const PlannedLink& link : planned_links())
    if (key == fmt::format("link.{}", link.name)) ends.insert(fmt::format("{} {}", link.from, link.to));
  return ends;
}

LinkWay planned_way(std::string_view key) {
  return std::ranges::find_if(
             planned_links(),
             [&](const PlannedLink& link) { return key == fmt::format("link.{}", link.name); })
      ->way;
}

/// What of a machine is not as the plan says; one line a link.
std::string differences(const Machine& machine) {
  std::string text;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < machine.links().size(); ++i) {
    const hw::FifoBase& link = *machine.links()[i];
    const std::string& key = machine.link_keys()[i];
    const std::string ends = fmt::format("{} {}", without_number(link.producer()->name()),
                                         without_number(link.consumer()->name()));
    if (!planned_ends(key).contains(ends)) text += fmt::format("{}: {}\n", link.path(), ends);
    seen.insert(key + " " + ends);
    const bool reply = port_at(*link.consumer(), link).role() == hw::LinkRole::kReply;
    if (reply != (planned_way(key) == LinkWay::kBack)) text += fmt::format("{}: its way\n", link.path());
  }
  for (const PlannedLink& link : planned_links()) {
    const std::string wire = fmt::format("link.{} {} {}", link.name, link.from, link.to);
    if (!seen.contains(wire)) text += fmt::format("{}: planned and not there\n", wire);
  }
  return text;
}

/// All kinds of places of a machine, from up- to downstream.
constexpr std::array<std::string_view, 20> kPlaces{"command_processor.draws_in_flight",
                                                   "vertex_fetch.batch_slots",
                                                   "triangle_setup.triangle_slots",
                                                   "depth.tiles_in_flight",
                                                   "warp_packer.warp_slots",
                                                   "core.register_rows",
                                                   "core.warp_slots",
                                                   "rop.warps_in_flight",
                                                   "texture.groups_in_flight",
                                                   "load_store.groups_in_flight",
                                                   "vertex_fetch.cache_misses",
                                                   "depth.cache_misses",
                                                   "rop.cache_misses",
                                                   "texture.cache_misses",
                                                   "load_store.cache_misses",
                                                   "load_store.requests_queued",
                                                   "scan_out.lines_in_flight",
                                                   "l2.cache_misses",
                                                   "memory.write_queue",
                                                   "memory.queue_depth"};

/// The figures as if nothing of a machine had been used but these places, which were full all the time.
Figures full(Figures figures, const std::set<std::string_view>& places) {
  figures.slice_cycles = 0;
  for (LinkFigures& link : figures.links) link.use = 0;
  for (UnitFigures& unit : figures.units) {
    for (ResourceFigure& r : unit.resources) {
      const bool is_full = places.contains(fmt::format("{}.{}", without_number(unit.path), r.name));
      r.cycles = is_full ? static_cast<double>(unit.cycles) : 0;
      r.at_end_of.clear();
    }
  }
  return figures;
}

}  // namespace

TEST_CASE("machine_plan: kinds of units from up- to downstream, as work comes to them") {
  CHECK(kinds_downstream() ==
        std::vector<std::string_view>{"command_processor", "vertex_fetch", "primitive_assembly", "clipper",
                                      "triangle_setup", "coarse_raster", "fine_raster", "depth",
                                      "warp_packer", "work_distributor", "core", "rop", "texture",
                                      "load_store", "scan_out", "l2", "memory"});
}

TEST_CASE("machine_plan: all onward links but the one that closes the loop of the cores lead downstream") {
  const auto place = [](std::string_view kind) {
    return std::ranges::find(kinds_downstream(), kind) - kinds_downstream().begin();
  };
  std::string upstream;
  for (const PlannedLink& link : planned_links())
    if (link.way == LinkWay::kOnward && place(link.to) <= place(link.from))
      upstream += fmt::format("{} ", link.name);
  CHECK(upstream == "core_to_assembly ");
}

TEST_CASE("machine_plan: the links of a machine join the units that the plan says, in the planned way") {
  const std::string found = hw::contract::in_child([] {
    MachineConfig config;
    config.gpu.cores.set(3);
    config.gpu.channels.set(4);
    DeviceFrame frame(std::uint64_t{1} << 30);
    build_frame(test::plan_frame(), config.precision(), frame);
    Machine machine(config, frame, {});
    machine.run({});  // producers and consumers are known once SystemC has elaborated
    return differences(machine) + "end";
  });
  CHECK(found == "end");
}

TEST_CASE("machine_plan: of two kinds of full places the one that lies further downstream holds a frame up") {
  const std::string found = hw::contract::in_child([] {
    MachineConfig config;
    DeviceFrame frame(std::uint64_t{1} << 30);
    build_frame(test::plan_frame(), config.precision(), frame);
    Machine machine(config, frame, {});
    machine.run({});
    const Figures figures = collect_figures(machine, frame);
    std::string text;
    for (std::size_t i = 0; i + 1 < kPlaces.size(); ++i) {
      for (std::size_t j = i + 1; j < kPlaces.size(); ++j) {
        const std::string blamed =
            sensitivity(full(figures, {kPlaces[i], kPlaces[j]})).gains.front().resource;
        if (blamed != kPlaces[j]) text += fmt::format("{} before {}: {}\n", kPlaces[i], kPlaces[j], blamed);
      }
    }
    for (const ResourceUse& use : sensitivity(full(figures, {})).uses)
      if (use.places && std::ranges::find(kPlaces, use.name) == kPlaces.end()) text += use.name + " is new\n";
    return text + "end";
  });
  CHECK(found == "end");
}
