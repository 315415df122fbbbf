#include "studies/explore/sweep.h"

#include <catch2/catch.hpp>

#include <functional>

#include "models/base/error.h"
#include "tests/studies/explore/sweep_folder.h"

namespace quadrille::studies::explore {
namespace {

using Catch::Contains;

std::vector<std::string> levels(const std::string& value, const std::string& name = "gpu.cores") {
  const SweepFolder folder;
  return folder.sweep(std::string(kTriangleScene) + "[vary]\n\"" + name + "\" = " + value + "\n")
      .dimensions.at(0)
      .levels;
}

void refused(const std::string& text, const std::string& line, const std::string& words) {
  const SweepFolder folder;
  CAPTURE(text);
  CHECK_THROWS_WITH(folder.sweep(text), Contains("sweep.toml:" + line) && Contains(words));
  CHECK_THROWS_AS(folder.sweep(text), UserError);
}

using Strings = std::vector<std::string>;

}  // namespace

TEST_CASE("sweep: lists, ranges and ranges by factors") {
  CHECK(levels("[1, 2, 4]") == Strings{"1", "2", "4"});
  CHECK(levels("{ from = 1, to = 10, step = 3 }") == Strings{"1", "4", "7", "10"});
  CHECK(levels("{ from = 2, to = 64, factor = 2 }") == Strings{"2", "4", "8", "16", "32", "64"});
  CHECK(levels("{ from = 1, to = 5, count = 3 }") == Strings{"1", "3", "5"});
  // Whole numbers that meet are one.
  CHECK(levels("{ from = 1, to = 4, count = 9, log = true }") == Strings{"1", "2", "3", "4"});
  CHECK(levels("{ from = 0.1, to = 0.5, step = 0.1 }", "gpu.clock_mhz").size() == 5);
  CHECK(levels("[\"ddr4\", \"gddr6\"]", "memory.kind") == Strings{"ddr4", "gddr6"});
  CHECK(levels("[true, false]", "gpu.linear_log2") == Strings{"true", "false"});
}

TEST_CASE("sweep: a place of a dimension is one of its levels, each as often") {
  Dimension d;
  d.levels = {"a", "b", "c"};
  CHECK(d.at(0) == "a");
  CHECK(d.at(0.34) == "b");
  CHECK(d.at(1) == "c");
  Dimension whole;
  whole.from = 1;
  whole.to = 4;
  whole.whole = true;
  int each[5] = {};
  for (int i = 0; i < 1000; ++i) ++each[std::stoi(whole.at((i + 0.5) / 1000))];
  for (int v = 1; v <= 4; ++v) CHECK(each[v] == 250);
  Dimension log;
  log.from = 1;
  log.to = 100;
  log.logarithmic = true;
  CHECK(std::stod(log.at(0.5)) == Approx(10));
}

TEST_CASE("sweep: tables may be nested or dotted, and formulas name what follows") {
  const SweepFolder folder;
  const Sweep sweep =
      folder.sweep(std::string("machines = [\"small\", \"large\"]\n"
                               "constraints = [\"k * gpu.cores <= 8\"]\n") +
                   kTriangleScene +
                   "[set.core]\nsimd_lanes = 16\n"
                   "[vary]\ngpu.cores = [1, 2]\nk = [1, 8]\n"
                   "[derive]\n\"gpu.channels\" = \"2 * gpu.cores\"\n"
                   "[[objective]]\nname = \"ms\"\nformula = \"frame.cycles / gpu.clock_mhz\"\n"
                   "at_most = 16.7\nover = \"sum\"\n");
  REQUIRE(sweep.dimensions.size() == 3);
  CHECK(sweep.dimensions[0].name == "machine");
  CHECK(sweep.dimensions[1].name == "gpu.cores");
  CHECK(sweep.settings.at(0).key == "core.simd_lanes");
  CHECK(sweep.derived.at(0).name == "gpu.channels");
  CHECK(sweep.objectives.at(0).over == Objective::Over::kSum);
  CHECK(sweep.objectives.at(0).at_most == 16.7);
}

TEST_CASE("sweep: what is wrong is named with its line, before anything runs") {
  const std::string scene = kTriangleScene;
  refused("desing = \"grid\"\n" + scene, "1", "did you mean 'design'");
  refused("design = \"gird\"\n" + scene, "1", "grid, random, latin_hypercube");
  refused("machines = [\"huge\"]\n" + scene, "1", "machine 'huge' is unknown");
  refused("design = \"random\"\n" + scene + "[vary]\ngpu.cores = [1, 2]\n", "", "points is missing");
  refused("points = 4\n" + scene, "1", "a grid has all of its points");
  refused("seconds = -1\n" + scene, "1", "more than 0");
  refused(scene + "[vary]\ngpu.corse = [1, 2]\n", "5", "did you mean 'gpu.cores'");
  refused(scene + "[vary]\ngpu.cores = [1, 65]\n", "5", "gpu.cores");
  refused(scene + "[vary]\ngpu.cores = [1, 1]\n", "5", "listed twice");
  refused(scene + "[vary]\ngpu.cores = 3\n", "5", "a list of values is expected");
  refused(scene + "[vary]\ngpu.cores = { from = 4, to = 1, step = 1 }\n", "5", "not below");
  refused(scene + "[vary]\ngpu.cores = { from = 1, to = 4, step = 0.5 }\n", "5", "not a whole number");
  refused(scene + "[vary]\ngpu.cores = { from = 1, to = 4, setp = 1 }\n", "5", "did you mean 'step'");
  refused(scene + "[vary]\ngpu.clock_mhz = { from = 100, to = 1000 }\n", "5", "a step, a factor or a count");
  refused(scene + "[set]\ngpu.cores = 2\n[vary]\ngpu.cores = [1, 2]\n", "7", "sweep.toml:5 too");
  refused(scene + "[derive]\ngpu.cores = \"2 *\"\n", "5", "2 *");
  refused(scene + "[[objective]]\nname = \"a b\"\nformula = \"1\"\n", "4", "letters, digits");
  refused(scene + "[[objective]]\nname = \"a\"\nformula = \"1\"\ngoal = \"best\"\n", "7", "least, most");
  refused("design = \"search\"\npoints = 9\n" + scene + "[vary]\ngpu.cores = [1, 2]\n", "1",
          "two [[objective]] or more");
  refused("design = \"search\"\npoints = 9999\n" + scene + "[vary]\ngpu.cores = [1, 2]\n", "2",
          "at most 2000 machines");
  refused("design = \"grid\"\n", "", "no scene");
  refused(scene + scene, "4", "two scenes are called 'triangle'");
  refused("a = [\n", "", "");
}

TEST_CASE("sweep: names of formulas are checked before anything runs") {
  const SweepFolder folder;
  const auto space_of = [&](const std::string& text) { const Space space(folder.sweep(text)); };
  CHECK_THROWS_WITH(space_of("constraints = [\"gpu.corse > 1\"]\n" + std::string(kTriangleScene)),
                    Contains("sweep.toml:1") && Contains("did you mean 'gpu.cores'"));
  CHECK_THROWS_WITH(space_of(std::string(kTriangleScene) + "[derive]\na = \"b\"\nb = \"1\"\n"),
                    Contains("sweep.toml:5") && Contains("'b'"));
}

}  // namespace quadrille::studies::explore
