/// Designs by the libraries that make them, each asked in a process of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "studies/explore/space.h"
#include "studies/explore/sweep.h"

namespace quadrille::studies::explore {

/// Places in 0..1, row by row: `kind` is "random", "latin_hypercube" or "sobol". Throws `UserError` for what
/// the library refuses, or when its module is not found.
[[nodiscard]] std::vector<double> design_places(const std::string& kind, std::size_t dimensions,
                                                std::size_t points, std::uint64_t seed);
/// The machines of a sweep whose design is known before the first run. Throws `UserError`.
[[nodiscard]] Plan planned(const Sweep& sweep, const Space& space);

}  // namespace quadrille::studies::explore
