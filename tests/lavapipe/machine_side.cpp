/// Quadrille's side of the comparison, behind one function, so that the rest knows nothing of the machine.
#include "tests/lavapipe/machine_side.h"

#include <utility>

#include "pipeline/render.h"

namespace quadrille::lavapipe {

Rendered render_on_machine(const traces::CommandStream& stream, const models::Precision& precision) {
  pipeline::FrameImage image = pipeline::render_functional_frame(stream, precision).image;
  return {image.width, image.height, std::move(image.color), std::move(image.depth)};
}

}  // namespace quadrille::lavapipe
