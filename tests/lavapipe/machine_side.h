/// Quadrille's side of the comparison, behind one function, so that the rest knows nothing of the machine.
#pragma once

#include "tests/lavapipe/vulkan_renderer.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// Fractional bits of the units whose precision Vulkan lets an implementation choose. A driver reports its own (`DeviceInfo`).
struct MachinePrecision {
  int subpixel_bits = 8, subtexel_bits = 8, lod_bits = 8;
};

/// Executes the stream on Quadrille, functions only: timing never changes pixels, and other tests hold it to that. Throws what Quadrille throws.
[[nodiscard]] Rendered render_on_machine(const traces::CommandStream& stream, const MachinePrecision& precision);

}  // namespace quadrille::lavapipe
