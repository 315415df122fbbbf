/// Several viewports and scissors a draw: our functional rendering beside the driver's.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/viewports_stream.h"

namespace quadrille::lavapipe {

// Llvmpipe gives each vertex a place once, so a vertex of two primitives has the viewport of the first.
TEST_CASE("lavapipe: draws to several viewports agree at one and at four samples") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const traces::CommandStream stream = pipeline::test::viewports_stream(seed, seed % 3 == 0 ? 4 : 1, true);
    const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
    const Rendered theirs = vulkan->render(stream);
    const auto difference = models::reference::compare_images(
        {ours.image.width, ours.image.height, ours.image.color}, {theirs.width, theirs.height, theirs.color});
    INFO("seed " << seed << ": within 2: " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.99);
  }
}

}  // namespace quadrille::lavapipe
