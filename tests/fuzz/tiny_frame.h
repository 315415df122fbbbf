/// Draws a stream functionally when that takes little time, whatever its file asked for.
#pragma once

#include "traces/command_stream.h"

namespace quadrille::fuzz {

/// Compiles the stream's shaders and draws it if its targets, textures and vertices are few and no program
/// loops; otherwise does nothing. Throws what `build_frame` and `render_functional` throw.
void draw_if_small(const traces::CommandStream& stream);

}  // namespace quadrille::fuzz
