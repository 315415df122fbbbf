/// The hostile run: every case of every group through the program.
#include "tests/hostile/hostile_case.h"

#include <catch2/catch.hpp>

using namespace quadrille::hostile;

namespace {

void run_group(const Group& group) {
  for (const Case& c : group.cases) {
    const Outcome outcome = run_case(c);
    for (const std::string& problem : outcome.problems)
      FAIL_CHECK(group.name << ": " << c.name << ": " << problem
                            << "; it said: " << outcome.error.substr(0, 500));
  }
  SUCCEED(group.cases.size() << " cases");
}

}  // namespace

TEST_CASE("hostile glTF is drawn or refused in one line") { run_group(scene_cases()); }
TEST_CASE("hostile GLB is drawn or refused in one line") { run_group(binary_scene_cases()); }
TEST_CASE("glTF in numbers that nobody draws is drawn in time or refused in one line", "[slow]") {
  run_group(large_scene_cases());
}
TEST_CASE("hostile images are read or refused in one line", "[slow]") { run_group(image_cases()); }
TEST_CASE("hostile traces are drawn or refused in one line") { run_group(trace_cases()); }
TEST_CASE("hostile captures are drawn or refused in one line") { run_group(capture_cases()); }
TEST_CASE("hostile machine files and settings are refused in one line") { run_group(machine_cases()); }
TEST_CASE("hostile files of costs are read or refused in one line") { run_group(energy_cases()); }
TEST_CASE("hostile flags are refused in one line") { run_group(flag_cases()); }
TEST_CASE("hostile shaders end and are refused in one line", "[slow]") { run_group(shader_cases()); }
TEST_CASE("outputs that cannot be written are refused in one line") { run_group(output_cases()); }
TEST_CASE("hostile files of others are drawn or refused in one line", "[slow]") {
  const Group group = outside_cases();
  if (group.cases.empty()) WARN("skipped: no folder of hostile scenes");
  run_group(group);
}
