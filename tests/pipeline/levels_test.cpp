/// Levels and layers of attachments in whole frames: the machine's pixels and laws, the reference's picture,
/// the trace file, and which of them may be sampled.
#include "tests/pipeline/levels_stream.h"

#include "models/memory/surface.h"
#include "models/reference/compare.h"
#include "pipeline/driver/frame_builder.h"
#include "scenes/scene.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

traces::BeginPass& pass(traces::CommandStream& stream, int number) {
  for (traces::Command& command : stream.commands) {
    auto* const begin = std::get_if<traces::BeginPass>(&command);
    if (begin != nullptr && number-- == 0) return *begin;
  }
  throw std::out_of_range("no such pass");
}

}  // namespace

TEST_CASE(
    "levels: random machines draw the functional run's pixels to levels and layers, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    INFO("stream and machine " << seed);
    CHECK(machine_faults(levels_stream(1 + seed / 3), seed) == "");
  }
}

TEST_CASE("levels: each has a place of its own, finest first, layer by layer") {
  const traces::CommandStream stream = levels_stream(1);
  pipeline::DeviceFrame frame(std::uint64_t{1} << 28);
  pipeline::build_frame(stream, {}, frame);
  const auto& passes = frame.frame.passes;
  const models::SurfaceLayout &first = passes[0].color[0].surface, &second = passes[2].color[0].surface,
                              &third = passes[3].color[0].surface, &other = passes[3].color[1].surface;
  CHECK(first.width == kLevelsWidth);
  CHECK(second.width == kLevelsWidth / 2);
  CHECK(third.height == kLevelsHeight / 4);
  CHECK(second.base == first.base + first.bytes());
  CHECK(third.base == second.base + second.bytes());
  CHECK(other.base < first.base);  // of layer 0
  // Samplers find the same texels there.
  const models::TextureView& chain = frame.frame.draws.back().fragment.textures[0].view;
  REQUIRE(chain.layout.levels == 3);
  for (const auto& [level, surface] : {std::pair{0u, &first}, {1u, &second}, {2u, &third}})
    for (std::uint32_t y = 0; y < surface->height; y += 3)
      for (std::uint32_t x = 0; x < surface->width; ++x)
        REQUIRE(chain.texel_address(level, x, y) == surface->pixel_address(x, y));
}

TEST_CASE("levels: the machine's picture is the reference's in given mode") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto pictures = studies::render_with_reference(levels_stream(seed), {});
    const auto difference =
        models::reference::compare_images({kLevelsWidth, kLevelsHeight, pictures.machine.color},
                                          {kLevelsWidth, kLevelsHeight, pictures.reference.color});
    INFO("seed " << seed << ": " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
    CHECK(difference.bad_blocks == 0);
  }
}

TEST_CASE("levels: texture caches forget what they held before each pass that draws a level from another") {
  const hw::contract::Outcome outcome = hw::contract::run_forked(machine_builder(levels_stream(1), 0), {});
  std::int64_t emptied = 0;
  for (const auto& [name, value] : outcome.figures)
    if (name.find("cache_emptied") != std::string::npos) emptied += value;
  // Three passes sample; of the four texture units, those that had something to do in each.
  CHECK(emptied >= 3);
  CHECK(emptied <= 12);
}

TEST_CASE("levels: encoded lines of levels are what later passes sample") {
  const Settings both{{"depth.compression", "plane_offset"}, {"rop.compression", "samples_offset"}};
  const traces::CommandStream stream = levels_stream(2);
  const PlanRun run = run_plan(both, false, stream);
  CHECK(run.failure.empty());
  CHECK(run.broken.empty());
  CHECK(run.digest == functional_digest(stream));
}

TEST_CASE("levels: passes of several samples are resolved to levels and layers") {
  const traces::CommandStream glow = [] {
    scenes::SceneOptions options;
    options.width = 48;
    options.height = 27;
    traces::CommandStream stream = scenes::load_scene("builtin:glow", options);
    traces::use_samples(stream, 4);
    traces::validate(stream);
    return stream;
  }();
  const traces::BeginPass* last_level = nullptr;
  for (const traces::Command& command : glow.commands) {
    const auto* const begin = std::get_if<traces::BeginPass>(&command);
    if (begin != nullptr && begin->colors.size() == 2 && begin->depth.image == traces::kNone)
      last_level = begin;
  }
  REQUIRE(last_level != nullptr);
  CHECK(last_level->colors[1].resolve_level == 5);
  CHECK(last_level->colors[1].resolve_layer == 1);
  CHECK(glow.images[last_level->colors[1].image].width == 1);
  for (const std::uint64_t seed : {1u, 2u}) CHECK(machine_faults(glow, seed) == "");
}

TEST_CASE("levels: one that is being drawn, or that nothing was drawn to, cannot be sampled") {
  CHECK(refusal(levels_stream(1)).empty());
  traces::CommandStream own = levels_stream(1);
  own.descriptor_sets[0].textures[0].levels = 2;  // the level that its pass draws too
  CHECK_THAT(refusal(own),
             Catch::Contains("samples level 1 of layer 1 of image 0 '0', which its own pass draws to"));
  traces::CommandStream undrawn = levels_stream(1);
  undrawn.descriptor_sets[2].textures[0].levels = 0;  // all four
  CHECK_THAT(refusal(undrawn),
             Catch::Contains("samples level 3 of layer 1 of image 0 '0' before a pass has stored it"));
  traces::CommandStream other_layer = levels_stream(1);
  other_layer.descriptor_sets[0].textures[0].layer = 0;
  CHECK_THAT(refusal(other_layer), Catch::Contains("samples level 0 of layer 0 of image 0 '0' before"));
  traces::CommandStream discarded = levels_stream(1);
  pass(discarded, 2).colors[0].store = traces::StoreOp::kDiscard;
  CHECK_THAT(refusal(discarded), Catch::Contains("samples level 1 of layer 1"));
}

TEST_CASE("levels: streams survive their trace file") {
  const traces::CommandStream stream = levels_stream(3);
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}
