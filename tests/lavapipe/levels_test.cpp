/// Levels and layers of attachments: our functional rendering beside the driver's.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/levels_stream.h"
#include "tests/pipeline/lines_stream.h"

namespace quadrille::lavapipe {

TEST_CASE("lavapipe: levels and layers that passes draw from each other agree") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const traces::CommandStream stream = pipeline::test::levels_stream(seed, seed % 2 == 0 ? 4 : 1);
    const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {.linear_log2 = true});
    const Rendered theirs = vulkan->render(stream);
    const auto difference = models::reference::compare_images(
        {ours.image.width, ours.image.height, ours.image.color}, {theirs.width, theirs.height, theirs.color});
    INFO("seed " << seed << ": within 2: " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
    CHECK(difference.bad_blocks == 0);
  }
}

TEST_CASE("lavapipe: images of one dimension that passes draw to agree") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  const traces::CommandStream stream = pipeline::test::lines_stream();
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {.linear_log2 = true});
  const Rendered theirs = vulkan->render(stream);
  const auto difference = models::reference::compare_images(
      {ours.image.width, ours.image.height, ours.image.color}, {theirs.width, theirs.height, theirs.color});
  INFO("within 2: " << difference.fraction_within(2));
  CHECK(difference.fraction_within(2) >= 0.999);
}

}  // namespace quadrille::lavapipe
