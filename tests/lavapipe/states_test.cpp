/// Random states of depth, stencil and blending in random formats, pixel by pixel beside the driver's.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/states_stream.h"

namespace quadrille::lavapipe {
namespace {

constexpr std::uint32_t kWidth = 64, kHeight = 48;

/// The part of the pixels that are alike: a unit of the last place may move with each of the blends that
/// follow.
double alike(VulkanRenderer& vulkan, std::uint64_t seed, int draws, std::uint32_t samples) {
  const traces::CommandStream stream = pipeline::test::states_stream(
      seed, kWidth, kHeight,
      {.depth_bounds = false, .small_floats = false, .samples = samples, .draws = draws});
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
  const Rendered theirs = vulkan.render(stream);
  return models::reference::compare_images({kWidth, kHeight, ours.image.color},
                                           {kWidth, kHeight, theirs.color})
      .fraction_within(4);
}

/// The fewest draws of a stream that still differ, for whoever looks for the cause.
int fewest_draws(VulkanRenderer& vulkan, std::uint64_t seed, int draws, std::uint32_t samples, double least) {
  int fewest = draws;
  while (fewest > 1 && alike(vulkan, seed, fewest - 1, samples) < least) --fewest;
  return fewest;
}

}  // namespace

TEST_CASE("states: random states draw the driver's pixels at one and at four samples") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  constexpr int kDraws = 12;
  constexpr double kLeast = 0.995;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::uint32_t samples = seed % 4 == 0 ? 4 : 1;
    const double part = alike(*vulkan, seed, kDraws, samples);
    const int fewest = part >= kLeast ? 0 : fewest_draws(*vulkan, seed, kDraws, samples, kLeast);
    INFO("stream " << seed << " at " << samples << " samples; its first " << fewest << " draws differ");
    CHECK(part >= kLeast);
  }
}

}  // namespace quadrille::lavapipe
