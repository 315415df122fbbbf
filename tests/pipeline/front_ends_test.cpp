/// Machines of several geometry front ends draw what the functional run draws: topologies that can be cut
/// into ranges and those that cannot, instances, engines, links of one place. Where geometry is the limit,
/// they are as many times as fast.
#include "pipeline/machine/machine_config.h"
#include "scenes/scene.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

traces::CommandStream scene(const char* name) {
  scenes::SceneOptions options;
  options.width = 96;
  options.height = 54;
  traces::CommandStream stream = scenes::load_scene(name, options);
  traces::validate(stream);
  return stream;
}

void check_same(const traces::CommandStream& stream, const Settings& settings) {
  const PlanRun run = run_plan(settings, false, stream);
  REQUIRE(run.failure == "");
  CHECK(run.digest == functional_digest(stream));
  CHECK(run.broken.empty());
}

}  // namespace

TEST_CASE("front ends: random primitives, with strips that restart, are drawn to the bit") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    INFO("seed " << seed);
    const traces::CommandStream stream = seed % 2 == 0 ? random_primitives(seed) : random_stream(seed);
    const char* count = seed % 3 == 0 ? "2" : seed % 3 == 1 ? "3" : "4";
    check_same(stream, {{"gpu.front_ends", count},
                        {"vertex_fetch.range_primitives", seed % 2 == 0 ? "1" : "4"},
                        {"vertex_fetch.reuse", seed % 4 == 3 ? "fifo" : "batch"},
                        {"gpu.partitions", "4"},
                        {"gpu.engines", seed % 4 < 2 ? "4" : "1"}});
    check_same(stream, {{"gpu.front_ends", count},
                        {"vertex_fetch.range_primitives", "2"},
                        {"vertex_fetch.batch_slots", "2"},
                        {"link.clipper_to_setup.depth", "1"},
                        {"link.assembly_to_clipper.depth", "1"},
                        {"link.fetch_to_assembly.depth", "1"},
                        {"link.command_to_fetch.depth", "1"}});
  }
}

TEST_CASE("front ends: built-in scenes are drawn to the bit, with several passes and samples") {
  for (const char* name : {"builtin:cubes", "builtin:primitives", "builtin:deferred", "builtin:glass"}) {
    INFO(name);
    traces::CommandStream stream = scene(name);
    if (std::string(name) == "builtin:cubes") traces::use_samples(stream, 4);
    check_same(stream, {{"gpu.front_ends", "4"}, {"vertex_fetch.range_primitives", "16"}});
  }
}

TEST_CASE("front ends: programs that write memory leave there what the functional run does") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    check_same(storage_stream(seed, kept_by_pixel()),
               {{"gpu.front_ends", "3"}, {"vertex_fetch.range_primitives", "2"}});
}

TEST_CASE("front ends: n of them look up the indices of a frame in an nth of the time") {
  // 379,440 triangles of three indices, one a cycle and front end; links that hold a part of a range let
  // front ends run ahead of the one whose turn it is.
  const traces::CommandStream stream = scene("builtin:courtyard");
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
  const PlanRun run = run_plan({{"gpu.front_ends", "16"},
                                {"gpu.engines", "16"},
                                {"gpu.cores", "64"},
                                {"gpu.partitions", "64"},
                                {"gpu.channels", "64"}});
  REQUIRE(run.failure == "");
  CHECK(run.broken.empty());
  CHECK(run.digest == functional_digest(plan_frame()));
}
