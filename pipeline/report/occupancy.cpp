#include "pipeline/report/occupancy.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <initializer_list>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

OccupancyBound fewest(std::initializer_list<OccupancyBound> bounds) {
  return *std::ranges::min_element(bounds, {}, &OccupancyBound::warps);
}

/// A core's share of what all cores share, rounded up: it may have the greater part.
int share(int of_all, int cores) { return (of_all + cores - 1) / cores; }

Json bound_json(const OccupancyBound& bound) { return {{"most_warps", bound.warps}, {"limit", bound.limit}}; }

}  // namespace

Occupancy occupancy_of(const DrawRegisters& registers, const MachineConfig& machine) {
  const int cores = machine.gpu.cores, rows = machine.core.register_rows;
  // A slot and registers for one fragment warp are kept from vertex warps.
  return {
      fewest({{machine.core.warp_slots - 1, "core.warp_slots"},
              {std::max(0, rows - registers.fragment) / std::max(1, registers.vertex), "core.register_rows"},
              {share(machine.vertex_fetch.batch_slots * machine.gpu.front_ends, cores),
               "vertex_fetch.batch_slots"}}),
      fewest({{machine.core.warp_slots, "core.warp_slots"},
              {rows / std::max(1, registers.fragment), "core.register_rows"},
              {share(machine.warp_packer.warp_slots * machine.gpu.partitions, cores),
               "warp_packer.warp_slots"}})};
}

std::vector<CounterBySquare> counters_by_square() {
  return {{"quads", {"warp_packer", "quads"}, {}, 0, 0}, {"simd_cycles", {"core", "simd_busy"}, {}, 0, 0}};
}

std::string figures_with_kept(std::string_view figures_json, const KeptCounters& kept,
                              const MachineConfig& machine) {
  Json document = Json::parse(figures_json);
  if (document.contains("draws")) {
    for (std::size_t i = 0; i < kept.registers.size(); ++i) {
      const Occupancy o = occupancy_of(kept.registers[i], machine);
      document["draws"][i]["occupancy"] = {{"vertex", bound_json(o.vertex)},
                                           {"fragment", bound_json(o.fragment)}};
    }
  }
  if (document.contains("tiles")) {
    Json& tiles = document["tiles"];
    Json outside = std::move(tiles["outside_tiles"]);  // stays last
    tiles.erase("outside_tiles");
    for (const CounterBySquare& c : kept.by_square) {
      tiles[c.key] = c.squares;
      outside[c.key] = c.outside;
    }
    tiles["outside_tiles"] = std::move(outside);
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::pipeline
