/// Attachments that begin with texels: our functional rendering beside the driver's.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "models/rop/depth_plane.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/begun_stream.h"
#include "tests/pipeline/levels_stream.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/states_stream.h"

namespace quadrille::lavapipe {
namespace {

/// `most` of 255 apart, in all but a part of the pixels.
void compare(const traces::CommandStream& stream, int most = 2, double least = 0.999) {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {.linear_log2 = true});
  const Rendered theirs = vulkan->render(stream);
  const auto difference = models::reference::compare_images(
      {ours.image.width, ours.image.height, ours.image.color}, {theirs.width, theirs.height, theirs.color});
  INFO("within " << most << ": " << difference.fraction_within(most));
  CHECK(difference.fraction_within(most) >= least);
  if (most == 2) CHECK(difference.bad_blocks == 0);
}

/// A frame of random states whose depths and stencil values begin with a pattern, of depths that no draw has.
traces::CommandStream patterned(std::uint64_t seed) {
  traces::CommandStream stream =
      pipeline::test::states_stream(seed, 64, 48, {.depth_bounds = false, .small_floats = false});
  auto& pass = std::get<traces::BeginPass>(stream.commands[0]);
  pass.depth.load = traces::LoadOp::kLoad;
  traces::Image& image = stream.images[pass.depth.image];
  const std::size_t bytes = traces::format_bytes(image.format);
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const models::PixelCode code =
          models::encode_depth(image.format, static_cast<float>((x * 7 + y * 13) % 32) / 32,
                               static_cast<std::uint8_t>((x / 8 + y / 8) % 4));
      const auto pixel = std::as_bytes(std::span(code.word)).first(bytes);
      image.texels.insert(image.texels.end(), pixel.begin(), pixel.end());
    }
  traces::validate(stream);
  return stream;
}

}  // namespace

TEST_CASE("lavapipe: attachments that begin with what a frame left agree") {
  using namespace pipeline::test;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    INFO("seed " << seed);
    compare(begun_stream(passes_stream(seed, 320, 200), seed % 2 == 0));
    compare(begun_stream(levels_stream(seed), seed % 2 == 0));
  }
}

// The bounds of states_test.cpp.
TEST_CASE("lavapipe: depths and stencil values that a frame begins with agree") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    INFO("seed " << seed);
    compare(patterned(seed), 4, 0.995);
  }
}

}  // namespace quadrille::lavapipe
