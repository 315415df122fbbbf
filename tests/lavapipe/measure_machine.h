/// The same experiments on the simulated machine, with its counters under the names of Vulkan's statistics.
#pragma once

#include <functional>

#include "tests/lavapipe/measured_points.h"
#include "tests/lavapipe/measurement.h"

namespace quadrille::lavapipe {

/// All points on the default machine with these settings `KEY=VALUE`, `jobs` at a time, each in a process of
/// its own. Call it with no other thread running. Throws `UserError` as a refused run does.
[[nodiscard]] Measurement simulate_all(const std::vector<MeasuredExperiment>& experiments,
                                       const std::vector<std::string>& settings, int jobs,
                                       const std::function<void(const std::string&)>& progress);

}  // namespace quadrille::lavapipe
