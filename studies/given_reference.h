/// The machine beside the double-precision reference that is given the machine's own snapped triangles: what
/// then differs is a rounding or a mistake.
#pragma once

#include "models/reference/reference.h"
#include "pipeline/render.h"
#include "traces/command_stream.h"

namespace quadrille::studies {

struct MachineAndReference {
  pipeline::FrameImage machine;
  models::reference::Result reference;
};

/// Draws `stream` on the machine's models, without time, which changes no pixel, and then on the reference at
/// the same precisions.
[[nodiscard]] MachineAndReference render_with_reference(const traces::CommandStream& stream,
                                                        const models::Precision& precision);

}  // namespace quadrille::studies
