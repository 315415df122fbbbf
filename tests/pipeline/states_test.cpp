/// Random states of depth, stencil and blending, in random formats: the machine's pixels, its laws, the
/// reference's picture, and the trace file.
#include "models/reference/compare.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/states_stream.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline::test;

TEST_CASE("states: forty random machines give the pixels of the functional rendering, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const StatesOptions options{.samples = seed % 4 == 0 ? 4u : 1u};
    const traces::CommandStream stream = states_stream(seed, 56, 40, options);
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

TEST_CASE("states: the machine's picture is the reference's in given mode") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto pictures = studies::render_with_reference(states_stream(seed, 64, 48), {});
    const auto difference = models::reference::compare_images({64, 48, pictures.machine.color},
                                                              {64, 48, pictures.reference.color});
    INFO("seed " << seed << ": " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
  }
}

TEST_CASE("states: streams survive their trace file") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const traces::CommandStream stream = states_stream(seed, 32, 24);
    CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
  }
}
