/// Frames drawn again with faster units: what must be gained, and what must not.
#include "studies/why.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "scenes/scene.h"
#include "studies/experiments/experiment.h"

namespace quadrille::studies {
namespace {

WhyResult why(const std::string& scene, const std::vector<std::string>& settings,
              const std::vector<std::string>& kinds) {
  scenes::SceneOptions options;
  options.width = 160;
  options.height = 90;
  pipeline::MachineConfig machine;
  experiments::apply_settings(machine, settings);
  return measure_why(scenes::load_scene(scene, options), machine, {.kinds = kinds, .jobs = 2});
}

/// Part of the frame on the critical path that gets shorter with a kind of units.
double on_path(const WhyResult& result, const std::string& kind) {
  const auto found = std::ranges::find(result.units, kind, &FasterUnits::kind);
  REQUIRE(found != result.units.end());
  return found->path / static_cast<double>(result.cycles);
}

/// Part of the frame.
double gain(const WhyResult& result, const std::string& kind, std::size_t speed_up) {
  const auto found = std::ranges::find(result.units, kind, &FasterUnits::kind);
  REQUIRE(found != result.units.end());
  return static_cast<double>(found->gain.at(speed_up)) / static_cast<double>(result.cycles);
}

}  // namespace

TEST_CASE("why: where lanes are few the cores are the frame, and nothing else is") {
  const WhyResult result =
      why("builtin:cubes", {"core.simd_lanes=4", "gpu.cores=2"}, {"core", "clipper", "primitive_assembly"});
  CHECK(result.units.front().kind == "core");
  CHECK(gain(result, "core", 0) == Approx(1 - 1 / 1.1).margin(0.015));
  CHECK(gain(result, "core", 1) > 0.85);
  CHECK(on_path(result, "core") > gain(result, "core", 1));
  for (const std::string kind : {"clipper", "primitive_assembly"}) CHECK(on_path(result, kind) < 0.01);
  for (const std::string kind : {"clipper", "primitive_assembly"})
    for (const std::size_t speed_up : {0u, 1u}) CHECK(std::abs(gain(result, kind, speed_up)) < 0.01);
}

TEST_CASE("why: where memory is slow it is what the frame waits for") {
  const WhyResult result = why(
      "builtin:materials", {"gpu.cores=16", "memory.t_burst=16", "memory.t_ccd_s=16", "memory.t_ccd_l=16"},
      {"memory", "core", "warp_packer"});
  CHECK(result.units.front().kind == "memory");
  CHECK(gain(result, "memory", 0) == Approx(1 - 1 / 1.1).margin(0.01));
  CHECK(gain(result, "memory", 1) > 0.5);
  CHECK(on_path(result, "memory") > gain(result, "memory", 1));
  CHECK(on_path(result, "core") < 0.1);
  for (const std::string kind : {"core", "warp_packer"}) CHECK(std::abs(gain(result, kind, 1)) < 0.01);
  REQUIRE_FALSE(result.doubled.empty());
  CHECK(result.doubled.front().resource == "memory.bus");
  CHECK(static_cast<double>(result.doubled.front().gain) ==
        Approx(result.doubled.front().expected).epsilon(0.1));
}

TEST_CASE("why: the document has what the table has") {
  const WhyResult result = why("builtin:triangle", {}, {"core", "rop"});
  const pipeline::MachineConfig machine;
  const auto json = nlohmann::ordered_json::parse(why_json(result, machine));
  CHECK(json.at("schema") == kWhySchema);
  CHECK(json.at("cycles") == result.cycles);
  REQUIRE(json.at("units").size() == 2);
  double path = 0;
  for (const auto& part : json.at("path")) path += part.at("cycles").get<double>();
  CHECK(path == Approx(static_cast<double>(result.cycles)).epsilon(1e-6));
  CHECK(json["units"][0].at("infinitely_fast_gain_cycles") == result.units[0].gain.back());
  CHECK(json["doubled"].size() == result.doubled.size());
  for (const FasterUnits& units : result.units)
    CHECK_THAT(why_table(result, machine), Catch::Contains(units.kind));
}

}  // namespace quadrille::studies
