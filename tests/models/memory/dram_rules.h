/// The rules of DRAM that are pairs of commands, made from a table of numbers (dram_checker.h says how they
/// are read).
#pragma once

#include "tests/models/memory/dram_checker.h"

#include <vector>

namespace quadrille::models {

/// Rules whose distance is 0 or less are left out: the order of the trace already says as much.
std::vector<DramPairRule> dram_pair_rules(const DramNumbers& numbers);

}  // namespace quadrille::models
