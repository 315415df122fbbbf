/// Frames of random pipelines on random machines, and what makes them small when they differ.
#include "tests/pipeline/random_pipelines.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/shrink_stream.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace quadrille;
using namespace quadrille::pipeline::test;

TEST_CASE("random pipelines: forty random machines draw the pixels of the functional run") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const traces::CommandStream stream = random_pipelines(seed, {.samples = seed % 3 == 0 ? 4u : 1u});
    INFO("stream and machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

TEST_CASE("random pipelines: streams survive their trace file") {
  const traces::CommandStream stream = random_pipelines(5, {.samples = 4});
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}

TEST_CASE("random pipelines: a fault of one state is shrunk to the one draw that has it") {
  const auto faulty = [](const traces::CommandStream& stream) {
    traces::Index bound = traces::kNone;
    return std::ranges::any_of(stream.commands, [&](const traces::Command& c) {
      if (const auto* bind = std::get_if<traces::BindPipeline>(&c)) bound = bind->pipeline;
      return std::holds_alternative<traces::Draw>(c) && stream.pipelines[bound].stencil.test &&
             stream.pipelines[bound].depth.write;
    });
  };
  int tried = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const traces::CommandStream stream = random_pipelines(seed, {});
    if (!faulty(stream)) continue;
    ++tried;
    const traces::CommandStream small = shrink(stream, faulty);
    CHECK(faulty(small));
    CHECK(draws_of(small) == 1);
    const auto kept = std::ranges::count_if(small.pipelines, [](const traces::Pipeline& p) {
      return p.stencil.test || p.depth.write || p.blend[0].enable || p.blend_shared.logic;
    });
    CHECK(kept == 1);
  }
  CHECK(tried >= 4);
}
