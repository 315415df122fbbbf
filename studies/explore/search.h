/// The search for a front: machines are chosen round by round from what was drawn before.
#pragma once

#include "studies/explore/exploration.h"
#include "studies/explore/space.h"

namespace quadrille::studies::explore {

/// The machines that a search begins with: a part of a Sobol design. Throws `UserError`.
[[nodiscard]] Plan first_machines(const Sweep& sweep, const Space& space);

/// Draws up to `sweep.points` machines: `first_machines`, then those that the search asks for. What the
/// results hold is not drawn again, so a search that was ended goes on. The machines do not depend on how
/// many are drawn at a time. Throws `UserError`.
[[nodiscard]] Plan search(const Sweep& sweep, const Space& space, Exploration& exploration);

}  // namespace quadrille::studies::explore
