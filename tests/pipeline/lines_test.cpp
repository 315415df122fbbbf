/// Images of one dimension as attachments, in whole frames: surfaces of height 1 to the machine.
#include <catch2/catch.hpp>

#include "models/reference/compare.h"
#include "studies/given_reference.h"
#include "tests/pipeline/lines_stream.h"
#include "tests/pipeline/machine_specimen.h"
#include "traces/trace_file.h"

using namespace quadrille;
using namespace quadrille::pipeline::test;

TEST_CASE("lines: random machines draw the functional run's pixels to images of one dimension") {
  for (const std::uint32_t samples : {1u, 4u})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      INFO("machine " << seed << ", " << samples << " samples a pixel");
      CHECK(machine_faults(lines_stream(samples), seed) == "");
    }
}

TEST_CASE("lines: the machine's picture is the reference's in given mode") {
  const auto pictures = studies::render_with_reference(lines_stream(), {});
  const auto difference =
      models::reference::compare_images({kLinesWidth, kLinesHeight, pictures.machine.color},
                                        {kLinesWidth, kLinesHeight, pictures.reference.color});
  CHECK(difference.fraction_within(2) >= 0.999);
}

TEST_CASE("lines: streams survive their trace file, and lines have one sample a pixel") {
  traces::CommandStream stream = lines_stream();
  CHECK(traces::decode_trace(traces::encode_trace(stream), "trace") == stream);
  stream.images[0].samples = 4;
  stream.images[0].levels = 1;
  stream.images[0].usage = traces::kColorAttachment;
  CHECK_THROWS_WITH(traces::validate(stream),
                    Catch::Contains("4 samples a pixel of an image that is not 2D"));
}
