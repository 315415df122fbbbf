#include "studies/explore/space.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "models/base/error.h"
#include "studies/explore/design.h"
#include "studies/explore/expression.h"
#include "tests/studies/explore/sweep_folder.h"

namespace quadrille::studies::explore {
namespace {

using Catch::Contains;

double value(const std::string& text, double x = 0) {
  return Expression(text, "here").value([&](const std::string& name) {
    if (name != "a.x") throw user_error("no {}", name);
    return x;
  });
}

}  // namespace

TEST_CASE("expression: operators, functions and names with dots") {
  CHECK(value("2 * a.x + 1", 3) == 7);
  CHECK(value("max(1, floor(a.x / 2))", 5) == 2);
  CHECK(value("mod(a.x, 4) == 1 && a.x > 2 ? 10 : 20", 5) == 10);
  CHECK(value("ceil(log2(a.x))", 9) == 4);
  CHECK(Expression("b + a.x * b", "").names() == std::vector<std::string>{"a.x", "b"});
  CHECK_THROWS_WITH(value("1 / a.x", 0), Contains("here") && Contains("no finite number"));
  CHECK_THROWS_WITH(value("sqrt(a.x", 1), Contains("here"));
  CHECK_THROWS_AS(value("1, 2"), UserError);
}

TEST_CASE("space: the grid is every combination, less what is left out, each with its reason") {
  const SweepFolder folder;
  const Sweep sweep =
      folder.sweep(std::string("constraints = [\"gpu.cores * gpu.channels <= 8\"]\n") + kTriangleScene +
                   "[vary]\ngpu.cores = [1, 2, 4]\ngpu.channels = [1, 2, 4]\n"
                   "texture.cache_ways = [4, 3]\n");
  const Space space(sweep);
  const Plan plan = space.grid();
  CHECK(plan.tried == 18);
  CHECK(plan.candidates.size() == 8);  // all but 4 x 4, and whole sets alone
  std::uint64_t by_constraint = 0, by_machine = 0;
  for (const auto& [reason, count] : plan.excluded)
    (reason.find("does not hold") != std::string::npos ? by_constraint : by_machine) += count;
  CHECK(by_constraint == 1);
  CHECK(by_machine == 9);
  std::set<std::string> hashes;
  for (const Candidate& candidate : plan.candidates) hashes.insert(candidate.hash);
  CHECK(hashes.size() == 8);
}

TEST_CASE("space: derived values follow, and what was set makes the machine again") {
  const SweepFolder folder;
  const Sweep sweep =
      folder.sweep(std::string("machines = [\"large\"]\n") + kTriangleScene +
                   "[set]\ngpu.clock_mhz = 900\n[vary]\ngpu.cores = [2, 4]\nscale = [3]\n"
                   "[derive]\nlanes = \"scale * 4\"\n\"gpu.channels\" = \"lanes * gpu.cores / 2\"\n");
  const Space space(sweep);
  const Plan plan = space.grid();
  REQUIRE(plan.candidates.size() == 2);
  pipeline::MachineConfig machine, again;
  space.configure(plan.candidates[1].values, machine);
  CHECK(machine.gpu.channels == 24);
  CHECK(machine.gpu.cores == 4);
  CHECK(space.value("lanes", plan.candidates[1].values, machine) == 12);
  CHECK(space.value("gpu.clock_mhz", plan.candidates[1].values, machine) == 900);
  CHECK_FALSE(space.value("gpu.nothing", plan.candidates[1].values, machine).has_value());
  pipeline::load_machine(again, "large");
  pipeline::MachineConfig large;
  pipeline::load_machine(large, "large");
  for (const std::string& setting : machine_settings(large, machine)) {
    const std::size_t equals = setting.find('=');
    again.set(setting.substr(0, equals), setting.substr(equals + 1), "");
  }
  CHECK(machine_hash(again) == plan.candidates[1].hash);
  CHECK(machine_hash(large) != plan.candidates[1].hash);
}

TEST_CASE("design: same seed, same places, and another seed, others") {
  for (const std::string kind : {"random", "latin_hypercube", "sobol"}) {
    CAPTURE(kind);
    const std::vector<double> places = design_places(kind, 3, 32, 7);
    REQUIRE(places.size() == 96);
    CHECK(std::ranges::all_of(places, [](double p) { return p >= 0 && p <= 1; }));
    CHECK(places == design_places(kind, 3, 32, 7));
    CHECK(places != design_places(kind, 3, 32, 8));
  }
}

TEST_CASE("design: a Latin hypercube has one point in each layer, a Sobol design is more even than chance") {
  const std::vector<double> latin = design_places("latin_hypercube", 4, 20, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    std::set<int> layers;
    for (std::size_t row = 0; row < 20; ++row) layers.insert(static_cast<int>(latin[row * 4 + i] * 20));
    CHECK(layers.size() == 20);
  }
  // The mean of a function of two places comes out much nearer than at random.
  const auto error = [](const std::string& kind) {
    double squares = 0;
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
      const std::vector<double> places = design_places(kind, 2, 256, seed);
      double sum = 0;
      for (std::size_t row = 0; row < 256; ++row) sum += places[2 * row] * places[2 * row + 1];
      squares += std::pow(sum / 256 - 0.25, 2);
    }
    return std::sqrt(squares / 4);
  };
  CHECK(error("sobol") < error("random") / 2);
}

TEST_CASE("design: levels that come up again are one machine") {
  const SweepFolder folder;
  const Sweep sweep = folder.sweep(std::string("design = \"sobol\"\npoints = 64\nseed = 3\n") +
                                   kTriangleScene + "[vary]\ngpu.cores = [1, 2]\ngpu.channels = [1, 2, 4]\n");
  const Space space(sweep);
  const Plan plan = planned(sweep, space);
  CHECK(plan.candidates.size() == 6);
  CHECK(plan.tried == 64);
  CHECK(plan.repeated == 58);
}

}  // namespace quadrille::studies::explore
