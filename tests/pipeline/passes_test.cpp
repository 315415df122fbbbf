/// Passes whose attachments later passes load and sample: pixels, laws, and what may not be sampled.
#include "models/reference/compare.h"
#include "scenes/scene.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/passes_stream.h"
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

/// A trace file that an earlier version of the program wrote.
traces::CommandStream kept_file(const std::string& name) {
  return traces::read_trace(QUADRILLE_SOURCE_DIR "/tests/traces/files/" + name + ".qtrace");
}
/// What such a file recorded, as it is recorded today.
traces::CommandStream triangle(std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
  scenes::SceneOptions options;
  options.width = width;
  options.height = height;
  traces::CommandStream stream = scenes::load_scene("builtin:triangle", options);
  traces::use_samples(stream, samples);
  return stream;
}

}  // namespace

TEST_CASE("passes: thirty random machines give the pixels of the functional rendering, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const traces::CommandStream stream = passes_stream(1 + seed / 3);
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

TEST_CASE("passes: the default machine keeps its contract over five passes") {
  hw::contract::Options options;
  options.shuffles = 2;
  for (const std::string& violation : hw::contract::violations(machine_builder(passes_stream(5), 0), options))
    FAIL_CHECK(violation);
}

TEST_CASE("passes: the machine's picture is the reference's in given mode") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto pictures = studies::render_with_reference(passes_stream(seed, 160, 120), {});
    const auto difference = models::reference::compare_images({160, 120, pictures.machine.color},
                                                              {160, 120, pictures.reference.color});
    INFO("seed " << seed << ": " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
    CHECK(difference.bad_blocks == 0);
  }
}

TEST_CASE("passes: a texture cache forgets what it held when a pass samples what earlier ones drew") {
  const hw::contract::Outcome outcome = hw::contract::run_forked(machine_builder(passes_stream(1), 0), {});
  std::int64_t emptied = 0;
  for (const auto& [name, value] : outcome.figures) {
    if (name.find("cache_emptied") != std::string::npos) emptied += value;
  }
  CHECK(emptied == 4);  // once in each of the four texture units: one pass samples
}

TEST_CASE("passes: what was not stored, or is being drawn, cannot be sampled") {
  CHECK(refusal(passes_stream(1)).empty());
  traces::CommandStream discarded = passes_stream(1);
  pass(discarded, 2).depth.store = traces::StoreOp::kDiscard;
  CHECK_THAT(refusal(discarded), Catch::Contains("samples image 4 '4' before a pass has stored it"));
  traces::CommandStream own = passes_stream(1);
  pass(own, 3).colors[0].image = 0;
  pass(own, 4).colors[0].load = traces::LoadOp::kClear;
  CHECK_THAT(refusal(own), Catch::Contains("samples image 0 '0', which its own pass draws to"));
}

TEST_CASE("passes: what is not cared about is zero, for colours and depths, on the machine too") {
  traces::CommandStream stream = passes_stream(4);
  for (traces::ColorAttachmentUse& color : pass(stream, 0).colors) color.load = traces::LoadOp::kDontCare;
  pass(stream, 2).depth.load = traces::LoadOp::kDontCare;
  stream.pipelines[3].depth.compare = traces::CompareOp::kGreater;  // of pass 2: nothing is nearer than zero
  const hw::contract::Outcome outcome = hw::contract::run_forked(machine_builder(stream, 0), {});
  REQUIRE(outcome.failure.empty());
  CHECK(outcome.digest == functional_digest(stream));
  const auto pictures = studies::render_with_reference(stream, {});
  const auto difference =
      models::reference::compare_images({88, 56, pictures.machine.color}, {88, 56, pictures.reference.color});
  CHECK(difference.fraction_within(2) >= 0.999);
}

TEST_CASE("passes: a stream of several passes survives its trace file") {
  const traces::CommandStream stream = passes_stream(3);
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}

TEST_CASE("passes: a trace file of version 1, with its table of targets, draws what its scene draws today") {
  const traces::CommandStream old = kept_file("triangle_version_1"), now = triangle(64, 36, 1);
  CHECK(functional_digest(old) == functional_digest(now));
  CHECK(traces::decode_trace(traces::encode_trace(old), "t") == old);
}

TEST_CASE("passes: a file from before queries draws what its scene draws today") {
  const traces::CommandStream old = kept_file("triangle_cmds_4"), now = triangle(24, 16, 2);
  CHECK(old.images == now.images);
  CHECK(old.pipelines == now.pipelines);
  CHECK(old.commands == now.commands);
  CHECK(functional_digest(old) == functional_digest(now));
}

TEST_CASE("passes: a file from before integers, levels and layers draws what its scene draws today") {
  const traces::CommandStream old = kept_file("outlines_cmds_5");
  scenes::SceneOptions options;
  options.width = 24;
  options.height = 16;
  const traces::CommandStream now = scenes::load_scene("builtin:outlines", options);
  CHECK(old.images == now.images);
  CHECK(old.descriptor_sets == now.descriptor_sets);
  CHECK(old.commands == now.commands);
  CHECK(functional_digest(old) == functional_digest(now));
}

TEST_CASE("passes: pipelines of a file from before shading by sample shade pixels and mask nothing") {
  const traces::CommandStream old = kept_file("triangle_samples_pipe_3"), now = triangle(64, 36, 4);
  CHECK(old.pipelines == now.pipelines);
  CHECK(functional_digest(old) == functional_digest(now));
}

TEST_CASE("passes: a trace file from before order-independent draws has none") {
  const traces::CommandStream old = kept_file("triangle_pipe_4"), now = triangle(64, 36, 1);
  CHECK(old.pipelines == now.pipelines);
  CHECK(old.commands == now.commands);
  CHECK(functional_digest(old) == functional_digest(now));
}
