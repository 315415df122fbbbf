/// The values of a dimension, from what a sweep file says of it: a list, or a range.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "studies/explore/sweep.h"

namespace quadrille::studies::explore {

/// A value as `MachineConfig::set` reads it: a number, true or false, or a word. Throws `UserError`.
[[nodiscard]] std::string value_text(const toml::node& node, const std::string& where);

/// The dimension `name` from a list `[1, 2, 4]` or a table with `from` and `to`, and `step`, `factor`,
/// `count` or none of them. `whole`: the parameter takes whole numbers alone. Throws `UserError` that begins
/// with `where`.
[[nodiscard]] Dimension read_dimension(const std::string& name, const toml::node& node, bool whole,
                                       const std::string& where);

}  // namespace quadrille::studies::explore
