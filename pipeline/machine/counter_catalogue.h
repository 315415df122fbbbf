/// Every counter of every kind of unit, from the declarations alone: no machine is built.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "hw/base/counter.h"

namespace quadrille::pipeline {

struct UnitCounters {
  std::string_view kind;  ///< "coarse_raster"; a number follows in figures where a machine has several
  std::shared_ptr<const hw::StatGroup> stats;
};

/// In the order of the pipeline.
[[nodiscard]] std::vector<UnitCounters> counter_catalogue();

}  // namespace quadrille::pipeline
