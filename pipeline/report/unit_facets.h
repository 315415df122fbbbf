/// What is worth saying of each kind of unit in a table: which of its counters, and the rates and shares made
/// of them.
#pragma once

#include "pipeline/report/figures.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// Units that share a row.
struct UnitGroup {
  std::string kind, name;  ///< "core", and "core_0" of the first
  std::vector<const UnitFigures*> units;

  [[nodiscard]] std::int64_t sum(std::int64_t UnitFigures::*member) const;
  [[nodiscard]] std::int64_t cycles() const { return sum(&UnitFigures::cycles); }
  /// Sum over the units. The counter has to exist.
  [[nodiscard]] std::uint64_t counter(std::string_view counter_name) const;
  /// Largest distance of a unit's busy share from the mean, in percentage points.
  [[nodiscard]] double busy_spread() const;
};

/// Rows in the order of first appearance: one a kind when `folded`, else one a unit.
[[nodiscard]] std::vector<UnitGroup> group_units(std::span<const UnitFigures> units, bool folded);

/// What the units show in their row (hw/base/facet.h): "L1 hit 97.1 %", "quads 1.20/clk (30 % of 4)", ...
[[nodiscard]] std::vector<std::string> unit_facets(const UnitGroup& group);

/// 1234567 as 1,234,567.
[[nodiscard]] std::string grouped(std::uint64_t value);

}  // namespace quadrille::pipeline
