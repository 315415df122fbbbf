/// Quadrille's side of the comparison, behind one function, so that the rest knows nothing of the machine.
#pragma once

#include "models/precision.h"
#include "tests/lavapipe/vulkan_renderer.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// Executes the stream on Quadrille, functions only: timing never changes pixels, and other tests hold it to
/// that. `precision`: what the driver reports of itself, where Vulkan leaves a choice. Throws what Quadrille
/// throws.
[[nodiscard]] Rendered render_on_machine(const traces::CommandStream& stream,
                                         const models::Precision& precision);

}  // namespace quadrille::lavapipe
