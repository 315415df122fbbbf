/// Queries of random streams beside the driver's: samples that pass, and what stages before the shaders
/// count.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>

#include "pipeline/driver/frame_builder.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/states_stream.h"

namespace quadrille::lavapipe {
namespace {

traces::CommandStream queried(traces::CommandStream stream) {
  traces::query_everything(stream);
  return stream;
}

/// By draw: its program forces early tests. Vulkan would have its samples counted before it discards, which
/// it leaves to drivers in later versions; this one counts afterwards. [VK1.3 #fragops]
std::vector<bool> forces_early_tests(const traces::CommandStream& stream) {
  pipeline::DeviceFrame frame(std::uint64_t{1} << 30);
  pipeline::build_frame(stream, {}, frame);
  std::vector<bool> early;
  for (const hw::DrawState& draw : frame.frame.draws) early.push_back(draw.counts_before_shading());
  return early;
}

std::vector<std::uint64_t> ours(const traces::CommandStream& stream) {
  std::vector<std::uint64_t> samples;
  for (const pipeline::QueryFigures& q : pipeline::render_functional_frame(stream, {}).figures.queries)
    if (q.range.type == traces::QueryType::kOcclusion) samples.push_back(q.values.at(0).value.value());
  return samples;
}

std::vector<std::uint64_t> theirs(VulkanRenderer& vulkan, const traces::CommandStream& stream) {
  std::vector<std::uint64_t> samples;
  for (const auto& values : vulkan.render(stream).queries)
    if (values.size() == 1) samples.push_back(values[0]);
  return samples;
}

}  // namespace

TEST_CASE("queries: samples that pass are the driver's, draw by draw, at one and at four samples") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const traces::CommandStream stream = queried(pipeline::test::states_stream(
        seed, 64, 48, {.depth_bounds = false, .small_floats = false, .samples = seed % 2 == 0 ? 4u : 1u}));
    const std::vector<std::uint64_t> here = ours(stream), there = theirs(*vulkan, stream);
    const std::vector<bool> early = forces_early_tests(stream);
    REQUIRE(here.size() == early.size());
    REQUIRE(there.size() == early.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      INFO("stream " << seed << ", draw " << i);
      if (early[i]) CHECK(here[i] >= there[i]);
      else CHECK(here[i] == there[i]);
    }
  }
}

TEST_CASE("queries: samples of slanted triangles differ by those that lie on other depths by a rounding") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const traces::CommandStream stream = queried(pipeline::test::passes_stream(seed));
    const std::vector<std::uint64_t> here = ours(stream), there = theirs(*vulkan, stream);
    REQUIRE(here.size() == there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      INFO("stream " << seed << ", draw " << i << ": " << here[i] << " and " << there[i]);
      CHECK(std::max(here[i], there[i]) - std::min(here[i], there[i]) <= 2);
    }
  }
}

TEST_CASE("queries: what input assembly and clipping take in is what the driver says") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const traces::CommandStream stream =
        queried(pipeline::test::states_stream(seed, 64, 48, {.depth_bounds = false, .small_floats = false}));
    // Twelve draws of six triangles, none of which the view's sides cut.
    for (const std::vector<std::uint64_t>& values : vulkan->render(stream).queries)
      if (values.size() == 6)
        CHECK(fmt::format("{} {} {} {}", values[0], values[1], values[3], values[4]) == "216 72 72 72");
  }
}

}  // namespace quadrille::lavapipe
