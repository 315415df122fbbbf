/// Experiments: readings are summed over the units of a kind, and a verdict is the band's.
#include "studies/experiments/experiment.h"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace quadrille::studies::experiments;

TEST_CASE("experiments: readings are those of the frame and the sums of a kind") {
  const Readings r(R"({"frame": {"cycles": 70, "memory_bytes": null},
                       "units": {"memory_0": {"cycles": 70, "busy": 5, "counters": {"reads": 3}},
                                 "memory_1": {"cycles": 70, "busy": 6, "counters": {"reads": 4}},
                                 "scan_out": {"cycles": 70, "busy": 1, "counters": {"lines": 9}}}})");
  CHECK(r["frame.cycles"] == 70);
  CHECK(r["memory.reads"] == 7);
  CHECK(r["memory.busy"] == 11);
  CHECK(r["memory.cycles"] == 140);
  CHECK(r["scan_out.lines"] == 9);
  CHECK_THROWS_AS(r["frame.memory_bytes"], std::out_of_range);
}

TEST_CASE("experiments: a figure outside its band fails, and the text and the page say so") {
  Result result;
  result.table = {{"scene", "gain"}, {{"fill", "1.5"}}};
  result.verdicts = {{"gain of fill", 1.5, 1.17, 1.93}};
  CHECK(result.holds());
  result.verdicts.push_back({"gain of overdraw", 1.94, 1.17, 1.93});
  CHECK_FALSE(result.holds());
  const Experiment& experiment = experiments().front();
  CHECK_THAT(result_text(experiment, result),
             Catch::Contains("holds  gain of fill: 1.5") && Catch::Contains("FAILS  gain of overdraw: 1.94"));
  CHECK_THAT(result_markdown(experiment, result, "x.png"), Catch::Contains("FAILS  gain of overdraw") && Catch::Contains("(x.png)"));
}
