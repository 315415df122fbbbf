/// Machines that walk edges draw what the functional run draws, which tests edge functions: scenes,
/// primitives of every kind, samples, engines and links of one place.
#include "models/base/error.h"
#include "pipeline/machine/machine_config.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/random_stream.h"

#include <catch2/catch.hpp>

#include <utility>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

const Settings kWalking{{"coarse_raster.traversal", "edge_walking"}};

Settings walking_with(const Settings& more) {
  Settings all = kWalking;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

TEST_CASE("edge walking: built-in scenes are drawn to the bit, at 1, 2, 4 and 8 samples") {
  const std::pair<const char*, std::uint32_t> scenes[] = {
      {"builtin:cubes", 2}, {"builtin:primitives", 4}, {"builtin:flag", 8}, {"builtin:overdraw", 4}};
  for (const auto& [name, several] : scenes) {
    for (const std::uint32_t count : {1u, several}) {
      INFO(name << " " << count);
      traces::CommandStream stream = small_scene(name);
      if (count > 1) traces::use_samples(stream, count);
      CHECK(faults_on(kWalking, stream) == "");
    }
  }
}

TEST_CASE("edge walking: random points, lines and triangles are drawn to the bit, whatever the machine") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    traces::CommandStream stream = seed % 2 == 0 ? random_primitives(seed) : random_stream(seed);
    if (seed > 2) traces::use_samples(stream, 2u << seed % 3);
    CHECK(faults_on(walking_with({{"gpu.partitions", "4"}, {"gpu.engines", seed % 3 == 0 ? "4" : "2"}}),
                    stream) == "");
    CHECK(faults_on(walking_with({{"link.coarse_to_fine.depth", "1"},
                                  {"link.setup_to_coarse.depth", "1"},
                                  {"coarse_raster.tiles_per_clk", "64"},
                                  {"coarse_raster.rows_per_clk", "16"},
                                  {"coarse_raster.segments_per_clk", "16"},
                                  {"coarse_raster.walk_setup_clk", "1"}}),
                    stream) == "");
  }
}

TEST_CASE("edge walking: a machine of another order than by rows is refused with what it can be") {
  MachineConfig config;
  config.coarse_raster.traversal.set(hw::kEdgeWalking);
  CHECK_NOTHROW(config.check());
  config.coarse_raster.order.set(models::kHilbertTileOrder);
  CHECK_THROWS_WITH(config.check(), Catch::Contains("coarse_raster.order is hilbert") &&
                                        Catch::Contains("it can be scan") &&
                                        Catch::Contains("traversal=edge_functions"));
  config.coarse_raster.traversal.set(hw::kEdgeFunctions);
  CHECK_NOTHROW(config.check());
}
