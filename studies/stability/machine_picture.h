/// The picture of a machine's case: the frame, and below it how each kind of unit spent its cycles.
#pragma once

#include "studies/stability/observed.h"

namespace quadrille::studies::stability {

/// The frame, and a bar for each kind of unit in the order of the pipeline: busy green, starved blue, blocked
/// red, idle grey.
[[nodiscard]] scenes::Rgba8Image machine_picture(const Observed& observed);

}  // namespace quadrille::studies::stability
