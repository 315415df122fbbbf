/// What a table of machines says: fronts and volumes, by the libraries that find them.
#pragma once

#include <cstddef>
#include <vector>

#include "studies/explore/exploration.h"
#include "studies/explore/space.h"

namespace quadrille::studies::explore {

/// Rows of a table, all of one length.
using Rows = std::vector<std::vector<double>>;

/// Which rows no other row dominates, where less is better. Throws `UserError`.
[[nodiscard]] std::vector<bool> front_of(const Rows& values);
/// The volume that the rows dominate, up to a reference that is worse than all. Throws `UserError`.
[[nodiscard]] double hypervolume(const Rows& values, const std::vector<double>& reference);

/// A machine that is drawn, with its objectives.
struct Outcome {
  const Candidate* candidate = nullptr;
  std::vector<double> values;  ///< as they are
  std::vector<double> costs;   ///< less is better: those of which more is better are negative
  bool holds = false;          ///< the limits of the objectives
  bool on_front = false;       ///< of those that hold
};
/// Every machine of the plan of which all points are done.
[[nodiscard]] std::vector<Outcome> outcomes(const Sweep& sweep, const Plan& plan,
                                            const Exploration& exploration);
/// The place of a machine in 0..1 of each dimension.
[[nodiscard]] std::vector<double> place_of(const Sweep& sweep, const Candidate& candidate);

}  // namespace quadrille::studies::explore
