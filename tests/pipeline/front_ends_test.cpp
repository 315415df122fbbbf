/// Machines of several geometry front ends draw what the functional run draws: topologies that can be cut
/// into ranges and those that cannot, instances, engines, links of one place. Where geometry is the limit,
/// they are as many times as fast.
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

TEST_CASE("front ends: random primitives, with strips that restart, are drawn to the bit") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    INFO("seed " << seed);
    const traces::CommandStream stream = seed % 2 == 0 ? random_primitives(seed) : random_stream(seed);
    const char* count = seed % 3 == 0 ? "2" : seed % 3 == 1 ? "3" : "4";
    CHECK(faults_on({{"gpu.front_ends", count},
                     {"vertex_fetch.range_primitives", seed % 2 == 0 ? "1" : "4"},
                     {"vertex_fetch.reuse", seed % 4 == 3 ? "fifo" : "batch"},
                     {"gpu.partitions", "4"},
                     {"gpu.engines", seed % 4 < 2 ? "4" : "1"}},
                    stream) == "");
    CHECK(faults_on({{"gpu.front_ends", count},
                     {"vertex_fetch.range_primitives", "2"},
                     {"vertex_fetch.batch_slots", "2"},
                     {"link.clipper_to_setup.depth", "1"},
                     {"link.assembly_to_clipper.depth", "1"},
                     {"link.fetch_to_assembly.depth", "1"},
                     {"link.command_to_fetch.depth", "1"}},
                    stream) == "");
  }
}

TEST_CASE("front ends: built-in scenes are drawn to the bit, with several passes and samples") {
  for (const char* name : {"builtin:cubes", "builtin:primitives", "builtin:deferred", "builtin:glass"}) {
    INFO(name);
    traces::CommandStream stream = small_scene(name);
    if (std::string(name) == "builtin:cubes") traces::use_samples(stream, 4);
    CHECK(faults_on({{"gpu.front_ends", "4"}, {"vertex_fetch.range_primitives", "16"}}, stream) == "");
  }
}

TEST_CASE("front ends: programs that write memory leave there what the functional run does") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    CHECK(faults_on({{"gpu.front_ends", "3"}, {"vertex_fetch.range_primitives", "2"}},
                    storage_stream(seed, kept_by_pixel())) == "");
}

TEST_CASE("front ends: n of them look up the indices of a frame in an nth of the time") {
  // 379,440 triangles of three indices, one a cycle and front end; links that hold a part of a range let
  // front ends run ahead of the one whose turn it is.
  const traces::CommandStream stream = small_scene("builtin:courtyard");
  constexpr double kIndices = 3 * 379440;
  for (const int front_ends : {1, 2, 4}) {
    const PlanRun run = run_plan({{"gpu.front_ends", std::to_string(front_ends)},
                                  {"gpu.cores", "64"},
                                  {"gpu.channels", "16"},
                                  {"gpu.partitions", "16"},
                                  {"gpu.engines", "4"},
                                  {"link.clipper_to_setup.depth", "64"},
                                  {"vertex_fetch.indices_per_clk", "1"},
                                  {"triangle_setup.triangle_slots", "1024"}},
                                 false, stream);
    REQUIRE(run.failure == "");
    CAPTURE(front_ends);
    CHECK(static_cast<double>(run.cycles) == Approx(kIndices / front_ends).epsilon(0.05));
    CHECK(static_cast<double>(run.cycles) >= kIndices / front_ends);
  }
}

TEST_CASE("front ends: the widest machine draws a frame that needs every unit") {
  CHECK(faults_on({{"gpu.front_ends", "16"},
                   {"gpu.engines", "16"},
                   {"gpu.cores", "64"},
                   {"gpu.partitions", "64"},
                   {"gpu.channels", "64"}},
                  plan_frame()) == "");
}
