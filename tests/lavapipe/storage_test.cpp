/// Storage buffers: what programs leave in them, and what later passes draw from them, beside the driver's.
#include <catch2/catch.hpp>

#include <cstring>

#include "models/base/error.h"
#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "tests/lavapipe/vulkan_renderer.h"
#include "tests/pipeline/storage_stream.h"

using namespace quadrille;

namespace {

std::optional<lavapipe::Rendered> by_driver(const traces::CommandStream& stream) {
  try {
    return lavapipe::VulkanRenderer().render(stream);
  } catch (const UserError& error) {
    WARN("skipped: " << error.what());
    return std::nullopt;
  }
}

/// Words that differ between both buffers.
std::size_t differing(const std::vector<std::byte>& a, const std::vector<std::byte>& b) {
  REQUIRE(a.size() == b.size());
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); i += 4) n += std::memcmp(a.data() + i, b.data() + i, 4) != 0;
  return n;
}

}  // namespace

TEST_CASE("lavapipe: counts, bounds and the last store by pixel, and the pass that draws them, agree") {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const traces::CommandStream stream =
        pipeline::test::storage_stream(seed, pipeline::test::kept_by_pixel());
    const auto theirs = by_driver(stream);
    if (!theirs) return;
    const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
    REQUIRE(ours.buffers.size() == 1);
    const std::size_t words = differing(ours.buffers[0].data, theirs->buffers.at(0));
    INFO("seed " << seed << ": " << words << " words differ");
    // Samples within a rounding error of an edge may fall to either side.
    CHECK(words <= 16);
    const auto difference =
        models::reference::compare_images({88, 56, ours.image.color}, {88, 56, theirs->color});
    CHECK(difference.fraction_within(2) >= 0.99);
  }
}

TEST_CASE("lavapipe: a vertex shader's stores and every atomic operation of one word agree") {
  pipeline::test::StorageShape shape;
  shape.vertex_declarations = "layout(std430, set = 0, binding = 0) buffer B { uint w[]; } b;";
  shape.vertex_body = "b.w[64u + vertex] = vertex * 3u + 1u;";
  shape.fragment_declarations = R"(layout(std430, set = 0, binding = 0) buffer B {
  uint u[8]; int s[8]; uint w[]; } b;)";
  shape.depth_test = false;
  shape.fragment_body = R"(
  uint x = uint(gl_FragCoord.x), y = uint(gl_FragCoord.y);
  atomicAdd(b.u[0], x * y); atomicMax(b.u[1], x); atomicOr(b.u[2], 1u << (x % 32u)); atomicXor(b.u[3], x * 31u + y);
  atomicAnd(b.u[4], ~y); atomicMin(b.s[0], int(x) - 500); atomicMax(b.s[1], int(y) - 500);
  if (atomicCompSwap(b.u[5], 0u, 77u) > 77u) o = vec4(0);
  uint size = uint(b.w.length()); o.g = float(size) / 20000.0;)";
  const traces::CommandStream stream = pipeline::test::storage_stream(7, shape);
  const auto theirs = by_driver(stream);
  if (!theirs) return;
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
  REQUIRE(ours.buffers.size() == 1);
  // The sum and the exclusive or move with one fragment at an edge.
  CHECK(differing(ours.buffers[0].data, theirs->buffers.at(0)) <= 2);
  const auto difference =
      models::reference::compare_images({88, 56, ours.image.color}, {88, 56, theirs->color});
  CHECK(difference.fraction_within(2) >= 0.99);
}
