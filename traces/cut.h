/// Parts of a frame: the passes up to one, or some of its draws.
#pragma once

#include <cstdint>

#include "traces/command_stream.h"

namespace quadrille::traces {

/// Ends the frame behind its pass `last`, counted from 1: what that pass draws to is the picture. Throws
/// `UserError` for a number that is 0 or beyond the passes there are.
void end_with_pass(CommandStream& stream, std::uint32_t last);

/// Keeps the draws `first` to `last`, counted from 0 as in the figures; passes and clears stay. Throws
/// `UserError` for an empty range or one beyond the draws there are.
void keep_draws(CommandStream& stream, std::uint32_t first, std::uint32_t last);

}  // namespace quadrille::traces
