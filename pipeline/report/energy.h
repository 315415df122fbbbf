/// An estimate of the energy that a frame takes and of the area that its machine takes: counts of events
/// times what an event costs, with the range that the costs' sources give.
///
/// It is relative: good for which unit, draw or machine takes more of it, and not for watts of a product.
/// docs/energy.md says what is charged and what is not.
#pragma once

#include "pipeline/report/costs.h"
#include "pipeline/report/figures.h"
#include "pipeline/report/kept_counters.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::pipeline {

struct EnergyEvent {
  Cost cost;
  std::uint64_t count = 0;  ///< of all units of the kind
  Range energy;             ///< pJ
};

struct AreaPart {
  Cost cost;
  int units = 0;  ///< of the kind, whether the frame needs them or not
  Range area;     ///< um2, of all of them
};

/// Sums by kind of unit, in the order of the pipeline.
using RangesByKind = std::vector<std::pair<std::string, Range>>;

struct EnergyFigures {
  std::string file;
  std::vector<CostConstant> constants;
  std::vector<EnergyEvent> events;
  RangesByKind units;
  Range total;  ///< pJ
  /// By draw in API order, and what belongs to none; empty unless draws were kept. They add up to the total.
  std::vector<Range> draws;
  Range outside_draws;
  std::vector<AreaPart> areas;
  RangesByKind unit_areas;
  Range total_area;  ///< um2
};

/// What has to be kept by draw so that energy is told by draw: a counter for each event.
[[nodiscard]] CountersByDraw counters_of(const CostFile& costs);
/// `figures` are of a run on `machine`, for which `costs` were read; `by_draw` is null unless its counters
/// were kept.
[[nodiscard]] EnergyFigures energy_of(const Figures& figures, const MachineConfig& machine,
                                      const CostFile& costs, const CountersByDraw* by_draw = nullptr);

/// A part of the table: energy and area by unit, and what most of it is; the dearest draws of `figures`.
[[nodiscard]] std::string energy_table(const EnergyFigures& energy, const Figures& figures);
/// The document of figures (report.h) with the key `energy`.
[[nodiscard]] std::string figures_with_energy(std::string_view figures_json, const EnergyFigures& energy);

}  // namespace quadrille::pipeline
