/// Arrays of descriptors beside the driver's.
#include <catch2/catch.hpp>

#include <cstring>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/descriptor_arrays_stream.h"

namespace quadrille::lavapipe {

TEST_CASE("lavapipe: arrays of textures, samplers, blocks and buffers agree") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const traces::CommandStream stream = pipeline::test::descriptor_arrays_stream(seed, true);
    const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
    const Rendered theirs = vulkan->render(stream);
    const auto difference = models::reference::compare_images(
        {ours.image.width, ours.image.height, ours.image.color}, {theirs.width, theirs.height, theirs.color});
    INFO("stream " << seed);
    CHECK(difference.fraction_within(2) >= 0.999);
    REQUIRE(ours.buffers.size() == theirs.buffers.size());
    auto mine = ours.buffers.begin();
    for (const auto& [index, data] : theirs.buffers) CHECK((mine++)->data == data);
  }
}

}  // namespace quadrille::lavapipe
