/// Several samples a pixel in whole frames: random machines draw what the functional run draws, and edges are
/// as smooth as their samples.
#include "models/base/error.h"
#include "pipeline/render.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

#include <catch2/catch.hpp>

#include <set>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

void check_machines(const traces::CommandStream& stream, std::uint64_t first, std::uint64_t count) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

}  // namespace

TEST_CASE("samples: random machines draw random streams as the functional run does, at 2, 4 and 8 samples") {
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    traces::CommandStream stream = random_stream(seed);
    traces::use_samples(stream, 2u << seed % 3);
    INFO("stream " << seed);
    check_machines(stream, 2 * seed, 2);
  }
}

TEST_CASE("samples: so do points, lines and triangles by their edges, and programs that write memory") {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    traces::CommandStream primitives = random_primitives(seed);
    traces::use_samples(primitives, 2u << seed % 3);
    check_machines(primitives, 5 * seed, 1);
    traces::CommandStream storage = storage_stream(seed, kept_by_pixel());
    traces::use_samples(storage, 2u << seed % 3);
    check_machines(storage, seed - 1, 1);
  }
}

TEST_CASE("samples: an edge has as many shades as its samples allow, and the inside is as without") {
  StorageShape shape;
  shape.triangles = 1;
  shape.fragment_body = "o = vec4(1.0);";
  const traces::CommandStream plain = storage_stream(3, shape);
  const FrameImage one = render_functional_frame(plain, {}).image;
  for (const std::uint32_t samples : {2u, 4u, 8u}) {
    traces::CommandStream stream = plain;
    traces::use_samples(stream, samples);
    const FrameImage many = render_functional_frame(stream, {}).image;
    const std::set<std::uint32_t> shades(many.color.begin(), many.color.end());
    CHECK(shades.size() == samples + 1);
    std::size_t whole = 0;
    for (std::size_t i = 0; i < many.color.size(); ++i) {
      if (many.color[i] == 0xffffffffu) {
        ++whole;
        CHECK(one.color[i] == 0xffffffffu);
      }
    }
    CHECK(whole > 100);
  }
}

TEST_CASE("samples: a pass that others read the depth of keeps one sample, and the last one may not") {
  traces::CommandStream stream = storage_stream(1, {});
  stream.images[1].usage |= traces::kSampled;
  CHECK_THROWS_WITH(traces::use_samples(stream, 4), Catch::Contains("cannot have 4 samples"));
  stream = storage_stream(1, {});
  traces::use_samples(stream, 4);
  CHECK_THROWS_WITH(traces::use_samples(stream, 4), Catch::Contains("images of 4 samples"));
  traces::validate(stream);
}
