/// Order-independent transparency, exactly: all fragments of a sample, by their depths there. Internal to the
/// reference.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "models/reference/draw_state.h"
#include "traces/command_stream.h"

namespace quadrille::models::reference {

/// Keeps a fragment of an order-independent draw. `source` is what the program wrote.
void keep_fragment(const traces::BlendState& state, traces::Format format, double depth,
                   const std::array<double, 4>& source, KeptFragments& fragments);

/// Puts the fragments of each place over its colour, from the farthest to the nearest; of equal depths the
/// one drawn later is nearer. Rounds once, and forgets them.
void put_over(std::vector<KeptFragments>& kept, ColorTarget& target);

}  // namespace quadrille::models::reference
