/// What a table of machines says: fronts, volumes and Sobol indices, by the libraries that find them.
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

/// Parts of an objective's variance.
struct SobolIndices {
  std::vector<double> first, total;  ///< by dimension: alone, and with all others
  Rows pairs;                        ///< of two together, without what each does alone
  double explained = 0;              ///< part of the variance that the fit tells of rows it was not given
};
/// Of a function of places in 0..1. `levels`: how many values each dimension has, all as likely; 0: every
/// number. Throws `UserError`.
[[nodiscard]] SobolIndices sobol_indices(const Rows& places, const std::vector<std::size_t>& levels,
                                         const std::vector<double>& values);

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
/// By objective; empty where the machines are too few, or all the same.
[[nodiscard]] std::vector<SobolIndices> indices_of(const Sweep& sweep, const std::vector<Outcome>& outcomes);

}  // namespace quadrille::studies::explore
