/// The objectives of a sweep, from the figures of its points.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/explore/space.h"
#include "studies/explore/sweep.h"

namespace quadrille::studies::explore {

using FigureMap = std::map<std::string, double>;

/// A figure of a frame: a path of `figure_lines`; `all.KIND.COUNTER`, the sum over all units of a kind. What
/// a unit counts that the frame did not build is 0. None for what is no figure.
[[nodiscard]] std::optional<double> figure_value(const std::string& name, const FigureMap& figures);

/// Throws `UserError` with the formula's place for a name that is neither a figure of `figures` nor known to
/// the space nor an objective above.
void check_objectives(const Sweep& sweep, const Space& space, std::span<const std::string> values,
                      const FigureMap& figures);

/// The value of each objective for one scene. Throws `UserError` for what is no finite number.
[[nodiscard]] std::vector<double> objective_values(const Sweep& sweep, const Space& space,
                                                   std::span<const std::string> values,
                                                   const FigureMap& figures);
/// The value of each objective over the scenes, of which each has its `objective_values`.
[[nodiscard]] std::vector<double> over_scenes(const Sweep& sweep,
                                              std::span<const std::vector<double>> scenes);
/// Whether the limits of the objectives hold.
[[nodiscard]] bool holds_limits(const Sweep& sweep, std::span<const double> values);

}  // namespace quadrille::studies::explore
