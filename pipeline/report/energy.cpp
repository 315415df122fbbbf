#include "pipeline/report/energy.h"

#include "pipeline/machine/planned_links.h"
#include "pipeline/report/report.h"

#include <algorithm>

namespace quadrille::pipeline {

namespace {

std::uint64_t count_of(const Figures& figures, const Cost& cost) {
  std::uint64_t sum = 0;
  for (const UnitFigures& unit : figures.units) {
    if (without_number(unit.path) != cost.unit) continue;
    for (const CounterFigure& c : unit.counters) sum += c.name == cost.counter ? c.value : 0;
  }
  return sum;
}

/// Adds up the parts that are of a kind of unit; kinds without any are left out.
template <class Parts>
RangesByKind by_kind(const Parts& parts, const auto& value_of) {
  RangesByKind sums;
  for (const PlannedUnit& unit : planned_units()) {
    Range sum;
    bool any = false;
    for (const auto& part : parts) {
      if (part.cost.unit != unit.kind) continue;
      sum += value_of(part);
      any = true;
    }
    if (any) sums.emplace_back(unit.kind, sum);
  }
  return sums;
}

Range total_of(const RangesByKind& sums) {
  Range total;
  for (const auto& sum : sums) total += sum.second;
  return total;
}

Range energy_of_draw(const std::vector<std::uint64_t>& counts, const std::vector<EnergyEvent>& events) {
  Range sum;
  for (std::size_t i = 0; i < events.size(); ++i) sum += events[i].cost.each * static_cast<double>(counts[i]);
  return sum;
}

}  // namespace

CountersByDraw counters_of(const CostFile& costs) {
  CountersByDraw counters;
  for (const Cost& cost : costs.events) counters.asked.push_back({cost.unit, cost.counter});
  return counters;
}

EnergyFigures energy_of(const Figures& figures, const MachineConfig& machine, const CostFile& costs,
                        const CountersByDraw* by_draw) {
  EnergyFigures e;
  e.file = costs.name;
  e.constants = costs.constants;
  for (const Cost& cost : costs.events) {
    const std::uint64_t count = count_of(figures, cost);
    e.events.push_back({cost, count, cost.each * static_cast<double>(count)});
  }
  e.units = by_kind(e.events, [](const EnergyEvent& event) { return event.energy; });
  e.total = total_of(e.units);
  if (by_draw != nullptr) {
    for (const std::vector<std::uint64_t>& draw : by_draw->draws)
      e.draws.push_back(energy_of_draw(draw, e.events));
    e.outside_draws = energy_of_draw(by_draw->outside, e.events);
  }
  for (const Cost& cost : costs.areas) {
    const auto unit = std::ranges::find(planned_units(), cost.unit, &PlannedUnit::kind);
    const int units = pipeline::count_of(unit->stands, machine.gpu);
    e.areas.push_back({cost, units, cost.each * units});
  }
  e.unit_areas = by_kind(e.areas, [](const AreaPart& part) { return part.area; });
  e.total_area = total_of(e.unit_areas);
  return e;
}

}  // namespace quadrille::pipeline
