/// Attachments that begin with texels in whole frames: the machine's pixels and laws, what they cost, the
/// reference's picture, the trace file, and what a frame leaves for the next.
#include "models/reference/compare.h"
#include "pipeline/frame_contents.h"
#include "pipeline/render.h"
#include "studies/given_reference.h"
#include "tests/pipeline/begun_stream.h"
#include "tests/pipeline/levels_stream.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/states_stream.h"
#include "traces/attachment_texels.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

/// By turns of several formats, with depth and stencil values in any of theirs, of several levels and layers.
traces::CommandStream begun(std::uint64_t seed) {
  switch (seed % 3) {
    case 0: return begun_stream(passes_stream(1 + seed / 3), seed % 2 == 0);
    case 1: return begun_stream(states_stream(seed, 64, 48), seed % 2 == 0);
    default: return begun_stream(levels_stream(1 + seed / 3), seed % 2 == 0);
  }
}

}  // namespace

TEST_CASE("begun: random machines draw the functional run's pixels over what was there, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    INFO("stream and machine " << seed);
    CHECK(machine_faults(begun(seed), seed) == "");
  }
}

TEST_CASE("begun: encoded lines are drawn over plain ones that were there before the frame") {
  const Settings both{{"depth.compression", "plane_offset"}, {"rop.compression", "samples_offset"}};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const traces::CommandStream stream = begun(seed);
    const PlanRun run = run_plan(both, false, stream);
    CHECK(run.failure.empty());
    CHECK(run.broken.empty());
    CHECK(run.digest == functional_digest(stream));
  }
}

TEST_CASE("begun: the machine's picture is the reference's in given mode") {
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    const auto pictures = studies::render_with_reference(begun(seed), {});
    const auto& ours = pictures.machine;
    const auto difference = models::reference::compare_images(
        {ours.width, ours.height, ours.color}, {ours.width, ours.height, pictures.reference.color});
    INFO("seed " << seed << ": " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
    CHECK(difference.bad_blocks == 0);
  }
}

TEST_CASE("begun: what the attachments begin with takes no cycle, whatever it is") {
  traces::CommandStream stream = passes_stream(2);
  const PlanRun without = run_plan({}, false, stream);
  for (traces::Image& image : stream.images)
    if (image.is_attachment()) image.texels.assign(traces::texel_bytes(image), std::byte{0x3e});
  traces::validate(stream);
  const PlanRun with = run_plan({}, false, stream);  // which clears them all
  CHECK(with.cycles == without.cycles);
  CHECK(with.digest == without.digest);
}

TEST_CASE("begun: a level that no pass has stored is sampled as it was before the frame") {
  const traces::CommandStream stream = levels_stream(1);
  traces::CommandStream whole = begun_stream(stream);
  whole.descriptor_sets[2].textures[0].levels = 0;  // all four; no pass draws the last one
  traces::validate(whole);
  CHECK(machine_faults(whole, 3) == "");
}

TEST_CASE("begun: streams survive their trace file") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    CHECK(traces::decode_trace(traces::encode_trace(begun(seed)), "t") == begun(seed));
}

TEST_CASE("begun: a frame leaves what its last passes stored, also depths that no draw tested") {
  traces::CommandStream stream;
  traces::BeginPass pass = traces::make_pass(
      stream, {9, 5, traces::Format::kR8G8B8A8Unorm, traces::Format::kD24UnormS8Uint}, {1, 0, 0, 1}, 0.5f);
  pass.depth.clear_stencil = 7;
  stream.commands = {pass, traces::EndPass{}};
  traces::validate(stream);
  const traces::FrameContents left = pipeline::contents_after(stream, {});
  REQUIRE(left.parts.size() == 2);
  CHECK(left.parts[0].texels.size() == 4 * 45);
  CHECK(left.parts[0].texels[0] == std::byte{0xff});
  CHECK(left.parts[0].texels[1] == std::byte{0});
  CHECK(left.parts[1].texels[3] == std::byte{7});  // stencil above 24 bits of depth
  CHECK(left.parts[1].texels[2] == std::byte{0x80});
  std::get<traces::BeginPass>(stream.commands[0]).depth.store = traces::StoreOp::kDiscard;
  CHECK(pipeline::contents_after(stream, {}).parts.size() == 1);
}
