/// Several passes, attachments and formats: our functional rendering beside the driver's.
#include <catch2/catch.hpp>

#include "models/base/error.h"
#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/vulkan_renderer.h"
#include "tests/pipeline/passes_stream.h"

using namespace quadrille;

TEST_CASE("lavapipe: five passes over attachments of six formats agree") {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const traces::CommandStream stream = pipeline::test::passes_stream(seed, 320, 200);
    std::optional<lavapipe::Rendered> theirs;
    try {
      theirs = lavapipe::VulkanRenderer().render(stream);
    } catch (const UserError& error) {
      WARN("skipped: " << error.what());
      return;
    }
    const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
    const auto difference =
        models::reference::compare_images({320, 200, ours.image.color}, {320, 200, theirs->color});
    INFO("seed " << seed << ": within 2: " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
    CHECK(difference.bad_blocks == 0);
  }
}
