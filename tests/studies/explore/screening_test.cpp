/// Screening: the best machines are drawn exactly, and what is said of the others is true.
#include "studies/explore/screening.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "models/base/error.h"
#include "studies/explore/analysis.h"
#include "tests/studies/explore/sweep_run.h"

namespace quadrille::studies::explore {
namespace {

using Catch::Contains;

/// Twelve machines that draw a small picture.
std::string twelve(const std::string& head, const std::string& tail = {}) {
  return head + "[[scene]]\nfile = \"builtin:cubes\"\n[vary]\ngpu.cores = [1, 2, 3, 4]\n" +
         "core.simd_lanes = [2, 4, 8]\n" + tail;
}

struct Screened : SweepRun {
  explicit Screened(const std::string& text) : SweepRun(text, "builtin:cubes", 64) { setting.jobs = 2; }
  Results results{results_file()};
};

const std::string kCost =
    "[[objective]]\nname = \"cycles\"\nformula = \"frame.cycles\"\n"
    "[[objective]]\nname = \"lanes\"\nformula = \"gpu.cores * core.simd_lanes\"\n";

std::string refusal(const std::string& text) {
  try {
    (void)SweepFolder().sweep(text);
  } catch (const UserError& error) { return error.what(); }
  return "taken";
}

}  // namespace

TEST_CASE("screening: the best machine of the grid is among those that are drawn exactly") {
  Screened s(twelve("[screen]\nwindow = 100\nmachines = 3\n"));
  const Plan grid = s.plan;
  Exploration exact(s.sweep, s.space, s.scenes, s.results, s.setting);
  const Screening screening = screen(s.sweep, s.space, s.scenes, s.results, s.setting, s.plan);
  CHECK(screening.screened == 12);
  CHECK(screening.exactly == 3);
  CHECK(s.plan.candidates.size() == 3);
  CHECK(s.results.statuses().size() == 15);  // twelve with the window, three without
  REQUIRE(screening.errors.size() == 1);
  CHECK(screening.errors[0].pairs == 3);
  CHECK(screening.errors[0].greatest < 0.2);
  exact.run(grid.candidates);
  const std::vector<Outcome> all = outcomes(s.sweep, grid, exact), kept = outcomes(s.sweep, s.plan, exact);
  const auto best = [](const std::vector<Outcome>& of) {
    return std::ranges::min(of, {}, [](const Outcome& o) { return o.costs[0]; }).candidate->hash;
  };
  const bool said_so = screening.maybe_better == 0;
  CHECK((best(all) == best(kept) || !said_so));
}

TEST_CASE("screening: a front is kept, and an objective of parameters is never off") {
  Screened s(twelve("[screen]\nwindow = 100\nmachines = 8\n", kCost));
  const Plan grid = s.plan;
  const Screening screening = screen(s.sweep, s.space, s.scenes, s.results, s.setting, s.plan);
  REQUIRE(screening.errors.size() == 2);
  CHECK(screening.errors[1].greatest == 0);
  CHECK(screening.errors[1].turned == 0);
  Exploration exact(s.sweep, s.space, s.scenes, s.results, s.setting);
  exact.run(grid.candidates);
  std::size_t lost = 0;
  for (const Outcome& o : outcomes(s.sweep, grid, exact))
    lost += o.on_front && std::ranges::find(s.plan.candidates, o.candidate->hash, &Candidate::hash) ==
                              s.plan.candidates.end();
  CHECK(lost <= screening.maybe_better);
  const std::string table = screening_table(s.sweep, screening);
  CHECK_THAT(table, Contains("SCREENED  12 machines with a window of 100 cycles; the best 8"));
  CHECK_THAT(table, Contains("lanes: the window was off by 0.00 % at most; 0 of 28 pairs"));
}

TEST_CASE("screening: more machines than there are is all of them, and nothing is left to be better") {
  Screened s(twelve("[screen]\nwindow = 50\nmachines = 100\n"));
  const Screening screening = screen(s.sweep, s.space, s.scenes, s.results, s.setting, s.plan);
  CHECK(screening.exactly == 12);
  CHECK(screening.maybe_better == 0);
  CHECK(screening.errors[0].pairs == 66);
  CHECK(s.results.statuses().size() == 24);
}

TEST_CASE("screening: a machine that cannot be drawn is counted, and the others go on") {
  Screened s(twelve("[screen]\nwindow = 100\nmachines = 2\n"));
  const std::string bad = s.plan.candidates[5].hash;
  s.setting.in_process = [&](const SceneEntry&, const Candidate& candidate) {
    if (candidate.hash == bad) throw UserError("not this one");
  };
  const Screening screening = screen(s.sweep, s.space, s.scenes, s.results, s.setting, s.plan);
  CHECK(screening.failed == 1);
  CHECK(screening.exactly == 2);
  CHECK_THAT(screening_table(s.sweep, screening), Contains("1 points could not be drawn with the window"));
}

TEST_CASE("screening: what makes no sense is refused by line") {
  const std::string rest = std::string(kTriangleScene) + "[vary]\ngpu.cores = [1, 2]\n";
  CHECK_THAT(refusal("[screen]\nwindow = 5\n" + rest), Contains("sweep.toml:1: machines is missing"));
  CHECK_THAT(refusal("[screen]\nwindow = 0\nmachines = 2\n" + rest),
             Contains("sweep.toml:2: window: a whole number within 1..1000000 is expected"));
  CHECK_THAT(refusal("[screen]\nwindow = 5\nmachines = 2\nbest = 1\n" + rest),
             Contains("unknown key 'best'"));
  CHECK_THAT(refusal("window = 3\n[screen]\nwindow = 5\nmachines = 2\n" + rest),
             Contains("screen: the window above is of all points"));
  CHECK_THAT(refusal("design = \"search\"\npoints = 9\n[screen]\nwindow = 5\nmachines = 2\n" + rest + kCost),
             Contains("screen: a search chooses by exact frames"));
}

}  // namespace quadrille::studies::explore
