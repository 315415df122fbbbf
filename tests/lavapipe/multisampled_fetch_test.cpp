/// Single samples of attachments, fetched by a later pass: our functional rendering beside the driver's.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/multisampled_fetch_stream.h"

namespace quadrille::lavapipe {

/// It has four samples a pixel.
TEST_CASE("lavapipe: fetched samples of colours, layers, integers and depths agree") {
  using pipeline::test::FetchShows;
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (const FetchShows shows : {FetchShows::kMean, FetchShows::kEverything, FetchShows::kIntegers}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const traces::CommandStream stream = pipeline::test::multisampled_fetch_stream(seed, {.shows = shows});
      const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
      const Rendered theirs = vulkan->render(stream);
      const auto difference =
          models::reference::compare_images({ours.image.width, ours.image.height, ours.image.color},
                                            {theirs.width, theirs.height, theirs.color});
      INFO("shows " << static_cast<int>(shows) << ", seed " << seed
                    << ": within 2: " << difference.fraction_within(2));
      CHECK(difference.fraction_within(2) >= 0.999);
      CHECK(difference.bad_blocks == 0);
    }
  }
}

}  // namespace quadrille::lavapipe
