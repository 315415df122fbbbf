/// Attachments of integers in whole frames: the machine's pixels and laws, the reference's picture, clears
/// and compression, the trace file, and what is refused.
#include "models/memory/surface.h"
#include "models/reference/compare.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/functional/functional.h"
#include "studies/given_reference.h"
#include "tests/pipeline/integers_stream.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace quadrille;
using namespace quadrille::pipeline::test;
using traces::Format;

namespace {

/// All formats, four in a stream.
std::vector<std::vector<Format>> groups() {
  std::vector<std::vector<Format>> all(1);
  for (const Format format : integer_formats()) {
    if (all.back().size() == 4) all.emplace_back();
    all.back().push_back(format);
  }
  return all;
}

traces::CommandStream small() { return integers_stream(1, {Format::kR8G8B8A8Uint, Format::kR16Sint}); }

traces::BeginPass& first_pass(traces::CommandStream& stream) {
  return std::get<traces::BeginPass>(stream.commands[0]);
}

}  // namespace

TEST_CASE("integers: random machines draw the functional run's pixels in all formats, and keep all laws") {
  std::uint64_t seed = 1;
  for (const std::vector<Format>& formats : groups()) {
    for (const std::uint32_t samples : {1u, 4u, 1u, 2u}) {
      INFO("stream and machine " << seed << ", " << samples << " samples");
      CHECK(machine_faults(integers_stream(seed, formats, samples), seed) == "");
      ++seed;
    }
  }
}

TEST_CASE("integers: encoded lines and fast clears keep every bit") {
  const Settings both{{"depth.compression", "plane_offset"}, {"rop.compression", "samples_offset"}};
  for (const std::vector<Format>& formats : groups()) {
    for (const std::uint32_t samples : {1u, 4u}) {
      const traces::CommandStream stream = integers_stream(9, formats, samples);
      const pipeline::test::PlanRun run = run_plan(both, false, stream);
      CHECK(run.failure.empty());
      CHECK(run.broken.empty());
      CHECK(run.digest == functional_digest(stream));
    }
  }
}

TEST_CASE("integers: the machine's picture is the reference's, bit for bit") {
  std::uint64_t seed = 1;
  for (const std::vector<Format>& formats : groups()) {
    for (const std::uint32_t samples : {1u, 4u}) {
      const auto pictures = studies::render_with_reference(integers_stream(seed++, formats, samples), {});
      INFO(models::format_info(formats[0]).name << " and others, " << samples << " samples");
      CHECK(pictures.machine.color == pictures.reference.color);
    }
  }
}

TEST_CASE("integers: what nothing covers holds the clear value") {
  traces::CommandStream stream = integers_stream(3, {Format::kR16G16Sint});
  first_pass(stream).colors[0].clear_integers = {static_cast<std::uint32_t>(-2), 0x7fff, 0, 0};
  for (traces::Command& command : stream.commands)
    if (auto* const scissor = std::get_if<traces::SetScissor>(&command)) scissor->width = 0;
  pipeline::DeviceFrame frame(std::uint64_t{1} << 28);
  pipeline::build_frame(stream, {}, frame);
  (void)pipeline::render_functional(frame.frame, frame.memory);
  const std::vector<models::PixelCode> codes =
      models::detile_codes(frame.memory, frame.frame.passes[0].color[0].surface);
  CHECK(std::ranges::all_of(codes, [](const models::PixelCode& c) { return c.word[0] == 0x7ffffffeu; }));
}

TEST_CASE("integers: streams survive their trace file") {
  for (const std::uint32_t samples : {1u, 4u}) {
    const traces::CommandStream stream = integers_stream(4, groups()[0], samples);
    CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
  }
}

TEST_CASE(
    "integers: blending, linear filters, alpha to coverage and clear values beyond the format are refused") {
  CHECK(refusal(small()).empty());
  traces::CommandStream blended = small();
  blended.pipelines[0].blend[1].enable = true;
  CHECK_THAT(refusal(blended), Catch::Contains("blends colour attachment 1, but R16_SINT holds integers"));
  for (traces::Filter traces::Sampler::*filter :
       {&traces::Sampler::mag, &traces::Sampler::min, &traces::Sampler::mip}) {
    traces::CommandStream filtered = small();
    filtered.samplers[0].*filter = traces::Filter::kLinear;
    CHECK_THAT(refusal(filtered),
               Catch::Contains("image 0 '0' of integers (R8G8B8A8_UINT) with a linear filter"));
  }
  traces::CommandStream covered = small();
  covered.pipelines[0].alpha_to_coverage = true;
  CHECK_THAT(refusal(covered), Catch::Contains("alpha to coverage, but colour attachment 0 holds integers"));
  traces::CommandStream cleared = small();
  first_pass(cleared).colors[0].clear_integers[2] = 256;
  CHECK_THAT(refusal(cleared), Catch::Contains("integers that R8G8B8A8_UINT does not hold"));
}

TEST_CASE("integers: a program writes and samples them as what they are, or is refused") {
  traces::CommandStream floats = small();
  floats.images[0].format = Format::kR8G8B8A8Unorm;
  CHECK_THAT(refusal(floats), Catch::Contains("writes unsigned integers to location 0") &&
                                  Catch::Contains("draws to R8G8B8A8_UNORM, which holds floats"));
  traces::CommandStream other_sign = small();
  other_sign.images[1].format = Format::kR16Uint;
  first_pass(other_sign).colors[1].clear_integers = {};
  CHECK_THAT(refusal(other_sign), Catch::Contains("writes signed integers to location 1"));
  traces::CommandStream sampled = small();
  std::swap(sampled.descriptor_sets[0].textures[0].image, sampled.descriptor_sets[0].textures[1].image);
  CHECK_THAT(refusal(sampled), Catch::Contains("samples unsigned integers from image 1 '1', whose format "
                                               "R16_SINT holds signed integers"));
}
