/// What events cost in energy, and what parts of units take of area: a file of data that a user may replace
/// (configs/energy/45nm.toml, docs/energy.md).
///
/// The file holds constants, each with its source and that source's own low and high, and says which counter
/// of which unit is charged with which constant. Here it is read, and its entries are worked out for a
/// machine: a read of a cache costs what its size costs.
#pragma once

#include "pipeline/machine/machine_config.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// A figure with what it is at least and at most. low <= typical <= high.
struct Range {
  double low = 0, typical = 0, high = 0;
  Range& operator+=(const Range& r) {
    low += r.low, typical += r.typical, high += r.high;
    return *this;
  }
  friend Range operator*(const Range& r, double times) {
    return {r.low * times, r.typical * times, r.high * times};
  }
};

/// A constant of the file that the machine's entries use.
struct CostConstant {
  std::string name, unit, source;
  Range value;
};

/// What one event, or one unit's part, costs on the machine.
struct Cost {
  std::string unit;      ///< kind
  std::string counter;   ///< that counts the events; empty: it is an area
  std::string what;      ///< in words
  std::string constant;  ///< its name; "sram" where sizes decide
  double times = 1;      ///< of the constant
  double bytes = 0;      ///< of the array; 0 unless `constant` is "sram"
  Range each = {};       ///< pJ an event, or um2 a unit, `times` included
};

struct CostFile {
  std::string name;                     ///< as it was asked for
  std::vector<CostConstant> constants;  ///< those in use, by name, sizes of memory last
  std::vector<Cost> events, areas;
};

/// Reads the file: a path ending in .toml, or the name of one in configs/energy/. Throws `UserError` with
/// file and line, the key and what is legal.
[[nodiscard]] CostFile load_costs(const std::string& name_or_path, const MachineConfig& machine);
/// The same of a text; `file` is its name in errors.
[[nodiscard]] CostFile read_costs(std::string_view text, const std::string& file,
                                  const MachineConfig& machine);

}  // namespace quadrille::pipeline
