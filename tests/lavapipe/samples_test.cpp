/// Several samples a pixel: the machine's resolved picture against lavapipe's, pixel by pixel.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <memory>

#include "models/base/error.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

namespace quadrille::lavapipe {
namespace {

/// Pixels of which a channel is more than `limit` apart.
std::size_t unlike(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b, int limit) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    int most = 0;
    for (unsigned c = 0; c < 4; ++c)
      most = std::max(
          most, std::abs(static_cast<int>(a[i] >> 8 * c & 255u) - static_cast<int>(b[i] >> 8 * c & 255u)));
    count += most > limit ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("samples: overlapping triangles are lavapipe's at one and at four samples a pixel") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (const std::uint32_t samples : {1u, 4u}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      traces::CommandStream stream = pipeline::test::storage_stream(seed, {});
      traces::use_samples(stream, samples);
      const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
      const Rendered theirs = vulkan->render(stream);
      INFO(samples << " samples, stream " << seed);
      // Where two triangles are as deep at a sample, the two may differ.
      CHECK(unlike(ours.image.color, theirs.color, 2) <= 2 * samples);
    }
  }
}

}  // namespace quadrille::lavapipe
