/// Order-independent transparency in whole frames: random machines draw what the functional run draws, and
/// the order of drawing does not matter.
#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "scenes/scene.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/random_stream.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

constexpr models::TransparencyState kLists{models::Transparency::kAbuffer, 64};

models::TransparencyState layers(int count) {
  return {models::Transparency::kKbuffer, static_cast<std::uint8_t>(count)};
}

/// A random stream whose later half of draws is order-independent.
traces::CommandStream random_layers(std::uint64_t seed, models::TransparencyState kept) {
  traces::CommandStream stream = random_stream(seed, {.width = 64, .height = 40, .draws = 8, .triangles = 5});
  for (traces::Command& command : stream.commands)
    if (auto* const pass = std::get_if<traces::BeginPass>(&command)) pass->transparency = kept;
  for (std::size_t i = stream.pipelines.size() / 2; i < stream.pipelines.size(); ++i) {
    traces::Pipeline& p = stream.pipelines[i];
    using enum models::BlendFactor;
    p.order_independent = true;
    p.depth.write = false;
    p.blend[0] = {true,
                  i % 2 == 0 ? kSrcAlpha : kOne,
                  kOneMinusSrcAlpha,
                  kOne,
                  kOneMinusSrcAlpha,
                  models::BlendOp::kAdd,
                  models::BlendOp::kAdd,
                  0xf};
  }
  traces::validate(stream);
  return stream;
}

traces::CommandStream glass(models::TransparencyState kept, std::uint32_t samples = 1,
                            std::uint32_t width = 160) {
  scenes::SceneOptions options;
  options.width = width;
  options.height = width * 5 / 8;
  options.transparency = kept;
  traces::CommandStream stream = scenes::load_scene("builtin:glass", options);
  traces::use_samples(stream, samples);
  return stream;
}

}  // namespace

TEST_CASE("transparency: random machines draw random streams as the functional run does") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const models::TransparencyState kept =
        seed % 2 == 0 ? kLists : layers(1 + static_cast<int>(seed / 2 % 8));
    traces::CommandStream stream = random_layers(seed, kept);
    if (seed % 3 != 0) traces::use_samples(stream, seed % 3 == 1 ? 4 : 2);
    if (seed % 5 == 0) traces::use_sample_shading(stream);
    INFO("stream " << seed);
    CHECK(machine_faults(stream, seed) == "");
    CHECK(machine_faults(stream, seed + 100) == "");
  }
}

TEST_CASE("transparency: lists that overflow lose the same fragments on all machines") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    traces::CommandStream stream = random_layers(seed, {models::Transparency::kAbuffer, 2});
    if (seed % 2 == 0) traces::use_samples(stream, 4);
    CHECK(machine_faults(stream, seed) == "");
    CHECK(machine_faults(stream, 0) == "");
    CHECK(functional_digest(stream) != functional_digest(random_layers(seed, kLists)));
  }
}

TEST_CASE("transparency: panes of glass, on the default machine and others") {
  for (const std::uint32_t samples : {1u, 4u}) {
    for (const models::TransparencyState& kept : {kLists, layers(4)}) {
      const traces::CommandStream stream = glass(kept, samples);
      for (const std::uint64_t machine : {0u, 3u, 8u, 13u}) CHECK(machine_faults(stream, machine) == "");
    }
  }
}

TEST_CASE("transparency: both drivers, any host order, any order of creating modules: the same cycles") {
  for (const models::TransparencyState& kept : {kLists, layers(2)}) {
    const traces::CommandStream stream = random_layers(4, kept);
    hw::contract::Options options;
    options.shuffles = 2;
    options.creations = 2;
    for (const std::string& violation : hw::contract::violations(machine_builder(stream, 3), options)) {
      UNSCOPED_INFO(violation);
      CHECK(violation.empty());
    }
  }
}

TEST_CASE("transparency: an A-buffer shows the same whatever the order of its draws") {
  const traces::CommandStream stream = glass(kLists);
  const FrameImage before = render_functional_frame(stream, {}).image;
  traces::CommandStream sorted = glass({});
  CHECK(render_functional_frame(sorted, {}).image.color != before.color);
  // Sorted by boxes or not, the draws are those of the scene: mark those of the sorted stream.
  for (traces::Pipeline& p : sorted.pipelines) p.order_independent = p.blend[0].enable;
  for (traces::Command& command : sorted.commands)
    if (auto* const pass = std::get_if<traces::BeginPass>(&command)) pass->transparency = kLists;
  traces::validate(sorted);
  CHECK(sorted.commands != stream.commands);
  CHECK(render_functional_frame(sorted, {}).image.color == before.color);
}

TEST_CASE("transparency: an A-buffer is the reference's exact picture, and more layers come nearer to it") {
  const auto off = [](models::TransparencyState kept) {
    const auto both = studies::render_with_reference(glass(kept, 1, 320), {});
    return models::reference::compare_images({both.machine.width, both.machine.height, both.machine.color},
                                             {both.machine.width, both.machine.height, both.reference.color});
  };
  const auto exact = off(kLists);
  CHECK(exact.fraction_within(1) >= 0.999);
  CHECK(exact.bad_blocks == 0);
  double last = 0;
  for (const int k : {1, 2, 4, 8}) {
    const double within = off(layers(k)).fraction_within(4);
    CHECK(within >= last);
    last = within;
  }
  CHECK(last > 0.9);
}

TEST_CASE("transparency: a pass without order-independent draws keeps nothing, and takes the same cycles") {
  scenes::SceneOptions options;
  options.width = 96;
  options.height = 64;
  const traces::CommandStream plain = scenes::load_scene("builtin:cubes", options);
  traces::CommandStream asked = plain;
  for (traces::Command& command : asked.commands)
    if (auto* const pass = std::get_if<traces::BeginPass>(&command)) pass->transparency = kLists;
  const auto a = hw::contract::run_forked(machine_builder(plain, 0), {});
  const auto b = hw::contract::run_forked(machine_builder(asked, 0), {});
  CHECK(a.end == b.end);
  CHECK(a.digest == b.digest);
}

TEST_CASE(
    "transparency: a trace file keeps what passes and pipelines say of it, and another mode is refused") {
  const traces::CommandStream stream = random_layers(1, layers(3));
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
  traces::CommandStream other = stream;
  for (traces::Command& command : other.commands)
    if (auto* const pass = std::get_if<traces::BeginPass>(&command))
      pass->transparency.mode = static_cast<models::Transparency>(3);
  CHECK_THROWS_WITH(traces::decode_trace(traces::encode_trace(other), "t"),
                    Catch::Contains("is 3; the largest value there is 2"));
}
