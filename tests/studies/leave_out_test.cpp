#include "studies/leave_out.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/scene.h"

namespace quadrille::studies {
namespace {

using Json = nlohmann::ordered_json;

LeaveOutScene builtin(const std::string& name) {
  return {name, [name](bool leave_out) {
            scenes::SceneOptions options;
            options.width = 96;
            options.height = 54;
            options.leave_out = leave_out;
            return LoadedScene{scenes::load_scene(name, options), {}};
          }};
}

LeaveOutRun run_of(const Json& figures) {
  LeaveOutRun run;
  run.cycles = 100;
  run.image = "96x54 1 2";
  run.figures = figures.dump();
  return run;
}

Json unit(std::uint64_t busy, std::uint64_t count) {
  return {{"busy", busy}, {"counters", {{"requests", count}}}, {"waits", Json::object()}};
}

const Json kFigures{{"frame", {{"cycles", 100}}},
                    {"units", {{"core_0", unit(10, 5)}, {"texture_0", unit(0, 0)}}},
                    {"bandwidth",
                     {{"color", {{"read_bytes", 32}, {"write_bytes", 64}}},
                      {"texture", {{"read_bytes", 0}, {"write_bytes", 0}}}}}};

TEST_CASE("built-in scenes are the same with and without what they do not need") {
  const pipeline::MachineConfig machine;
  for (const scenes::BuiltinScene& scene : scenes::builtin_scenes()) {
    const LeaveOutResult result =
        measure_leave_out(builtin("builtin:" + std::string(scene.name)), machine, 1);
    INFO(scene.name);
    CHECK(result.contradiction.empty());
    CHECK(result.everything.size() == 1);
    CHECK(result.everything.front().cycles > 0);
    CHECK(result.everything.front().total_s > 0);
  }
}

TEST_CASE("a unit may be missing only if it did nothing") {
  Json reduced = kFigures;
  reduced["units"].erase("texture_0");
  reduced["bandwidth"].erase("texture");
  CHECK(disagreement(run_of(kFigures), run_of(reduced)).empty());
  Json working = kFigures;
  working["units"]["texture_0"]["counters"]["requests"] = 1;
  CHECK(disagreement(run_of(working), run_of(reduced)) == "texture_0 was left out but works");
  working = kFigures;
  working["bandwidth"]["texture"]["read_bytes"] = 32;
  CHECK(disagreement(run_of(working), run_of(reduced)) == "texture moved other bytes");
  CHECK(disagreement(run_of(reduced), run_of(kFigures)) == "texture_0 is only there when units are left out");
}

TEST_CASE("every difference of picture, cycles, counts and bytes is found") {
  LeaveOutRun other = run_of(kFigures);
  other.image = "96x54 1 3";
  CHECK(disagreement(run_of(kFigures), other) == "the pictures differ");
  other = run_of(kFigures);
  other.cycles = 101;
  CHECK(disagreement(run_of(kFigures), other) == "100 cycles with everything, 101 with less");
  Json changed = kFigures;
  changed["units"]["core_0"]["busy"] = 11;
  CHECK(disagreement(run_of(kFigures), run_of(changed)) == "core_0 has other cycles or counts");
  changed = kFigures;
  changed["frame"]["cycles"] = 99;
  CHECK(disagreement(run_of(kFigures), run_of(changed)) == "the frame's figures differ");
  changed = kFigures;
  changed["bandwidth"]["color"]["write_bytes"] = 32;
  CHECK(disagreement(run_of(kFigures), run_of(changed)) == "color moved other bytes");
}

}  // namespace
}  // namespace quadrille::studies
