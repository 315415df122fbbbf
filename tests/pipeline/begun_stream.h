/// Frames whose attachments begin with what an earlier frame left in them.
#pragma once

#include "traces/command_stream.h"

namespace quadrille::pipeline::test {

/// The frame again, on top of what `stream` leaves, upside down, so that no depth meets its own: attachments
/// of one sample a pixel begin with that, and passes load it; with `clears_depths`, depths are cleared as
/// before. It is validated.
[[nodiscard]] traces::CommandStream begun_stream(const traces::CommandStream& stream,
                                                 bool clears_depths = false);

}  // namespace quadrille::pipeline::test
