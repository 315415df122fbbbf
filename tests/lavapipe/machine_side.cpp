/// Quadrille's side of the comparison, behind one function, so that the rest knows nothing of the machine.
#include "tests/lavapipe/machine_side.h"

#include <utility>

#include "models/precision.h"
#include "pipeline/render.h"

namespace quadrille::lavapipe {

Rendered render_on_machine(const traces::CommandStream& stream, const MachinePrecision& precision) {
  const models::Precision bits{
      .subpixel_bits = precision.subpixel_bits, .subtexel_bits = precision.subtexel_bits, .lod_bits = precision.lod_bits};
  pipeline::FrameResult frame = pipeline::render_functional(stream, bits);
  return {frame.width, frame.height, std::move(frame.color), std::move(frame.depth)};
}

}  // namespace quadrille::lavapipe
