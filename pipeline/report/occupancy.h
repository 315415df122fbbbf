/// How many warps of a draw a core can hold at a time, and which parameter keeps out more.
#pragma once

#include "pipeline/machine/machine_config.h"
#include "pipeline/report/kept_counters.h"

#include <string_view>

namespace quadrille::pipeline {

struct OccupancyBound {
  int warps = 0;           ///< of the stage, on a core that holds no others
  std::string_view limit;  ///< "core.warp_slots"; the first of those that allow the fewest
};
struct Occupancy {
  OccupancyBound vertex, fragment;
};
[[nodiscard]] Occupancy occupancy_of(const DrawRegisters& registers, const MachineConfig& machine);

/// The document of figures (report.h) with what was kept: `draws[].occupancy`, and counters by square under
/// `tiles`.
[[nodiscard]] std::string figures_with_kept(std::string_view figures_json, const KeptCounters& kept,
                                            const MachineConfig& machine);
/// What is asked for by square: quads packed, and cycles of SIMD units.
[[nodiscard]] std::vector<CounterBySquare> counters_by_square();

}  // namespace quadrille::pipeline
