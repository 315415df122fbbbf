/// Attachments of integers: every bit of them beside the driver's, at one and at four samples.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/integers_stream.h"

namespace quadrille::lavapipe {
namespace {

/// Pictures that hash what the attachments hold, so a bit anywhere is seen.
double part_alike(VulkanRenderer& vulkan, const traces::CommandStream& stream) {
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
  const Rendered theirs = vulkan.render(stream);
  return models::reference::compare_images({ours.image.width, ours.image.height, ours.image.color},
                                           {theirs.width, theirs.height, theirs.color})
      .fraction_within(0);
}

}  // namespace

TEST_CASE("lavapipe: attachments of integers hold the driver's bits in every format") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  std::uint64_t seed = 1;
  for (const traces::Format format : pipeline::test::integer_formats()) {
    for (const std::uint32_t samples : {1u, 4u}) {
      const traces::CommandStream stream = pipeline::test::integers_stream(seed++, {format}, samples);
      INFO(models::format_info(format).name << ", " << samples << " samples");
      CHECK(part_alike(*vulkan, stream) >= 0.999);
    }
  }
}

}  // namespace quadrille::lavapipe
