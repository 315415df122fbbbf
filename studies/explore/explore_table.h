/// What a sweep came to, as a person and a spreadsheet read it.
#pragma once

#include <cstdint>
#include <string>

#include "studies/explore/exploration.h"

namespace quadrille::studies::explore {

/// Machines, points, and why combinations were left out.
[[nodiscard]] std::string plan_table(const Sweep& sweep, const Plan& plan, std::size_t scenes);
/// How long and how much disk the points will take that are not known.
[[nodiscard]] std::string cost_table(const Measured& measured, std::size_t machines, std::size_t known,
                                     int jobs);
/// How the points ended, the reasons of those that failed, and the best machines by the first objective.
[[nodiscard]] std::string result_table(const Sweep& sweep, const Plan& plan, const Exploration& exploration);
/// How many points of the plan are not done.
[[nodiscard]] std::size_t failed_points(const Plan& plan, const Exploration& exploration);
/// A line a point: scene, machine, values, objectives, costs.
[[nodiscard]] std::string points_csv(const Sweep& sweep, const Space& space, const Plan& plan,
                                     const Exploration& exploration);

}  // namespace quadrille::studies::explore
