#include "studies/explore/analysis.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "models/base/error.h"
#include "scenes/scene.h"
#include "studies/explore/search.h"
#include "tests/studies/explore/sweep_folder.h"

namespace quadrille::studies::explore {
namespace {

std::vector<std::string> hashes(const Plan& plan) {
  std::vector<std::string> all;
  for (const Candidate& candidate : plan.candidates) all.push_back(candidate.hash);
  return all;
}

/// The volume that the machines dominate, each objective as a part of its spread over the whole space.
double volume(const std::vector<Outcome>& some, const std::vector<Outcome>& all) {
  const std::size_t width = all.at(0).costs.size();
  Rows scaled;
  for (const Outcome& outcome : some) {
    std::vector<double> row;
    for (std::size_t i = 0; i < width; ++i) {
      const auto [least, most] =
          std::ranges::minmax_element(all, {}, [&](const Outcome& o) { return o.costs[i]; });
      row.push_back((outcome.costs[i] - least->costs[i]) / (most->costs[i] - least->costs[i]));
    }
    scaled.push_back(row);
  }
  return hypervolume(scaled, std::vector<double>(width, 1.1));
}

}  // namespace

TEST_CASE("front: what no other row dominates, in tables of any length") {
  CHECK(front_of({{1, 5}, {2, 2}, {5, 1}, {3, 3}, {2, 6}}) ==
        std::vector<bool>{true, true, true, false, false});
  CHECK(front_of({{4}}) == std::vector<bool>{true});
  CHECK(front_of({}).empty());
  Rows many;
  for (int i = 0; i < 5000; ++i)
    many.push_back({static_cast<double>(i % 71), static_cast<double>((i * 37) % 101)});
  const std::vector<bool> found = front_of(many);
  for (std::size_t i = 0; i < many.size(); i += 53) {
    const bool dominated = std::ranges::any_of(many, [&](const std::vector<double>& row) {
      return row[0] <= many[i][0] && row[1] <= many[i][1] && (row[0] < many[i][0] || row[1] < many[i][1]);
    });
    CHECK(found[i] == !dominated);
  }
}

TEST_CASE("hypervolume: of two rows by hand") {
  CHECK(hypervolume({{0, 1}, {1, 0}}, {2, 2}) == Approx(3));
  CHECK_THROWS_AS(hypervolume({{3, 0}}, {2, 2}), UserError);
}

TEST_CASE("search: a tenth of the machines finds the front of the whole grid [slow]", "[slow]") {
  const std::string scene = "[[scene]]\nfile = \"builtin:materials\"\nsize = \"48x27\"\n";
  const std::string space_text =
      "[vary]\ngpu.cores = { from = 1, to = 8, step = 1 }\n"
      "texture.cache_lines = { from = 16, to = 512, factor = 2 }\n"
      "core.simd_lanes = [4, 8, 16, 32]\ngpu.channels = [1, 2]\n"
      "[[objective]]\nname = \"cycles\"\nformula = \"frame.cycles\"\n"
      "[[objective]]\nname = \"area\"\nformula = \"gpu.cores * (core.simd_lanes + texture.cache_lines / 16 + "
      "8) + 24 * gpu.channels\"\n";
  const SweepFolder folder;
  const Sweep grid = folder.sweep(scene + space_text);
  scenes::SceneOptions options;
  options.width = 48;
  options.height = 27;
  const std::vector<LoadedScene> scenes{
      with_hash(grid.scenes[0], scenes::load_scene("builtin:materials", options))};
  const Space whole(grid);
  const Plan plan = whole.grid();
  REQUIRE(plan.candidates.size() == 384);
  Results results("");
  ExploreSetting setting{.version = "one", .jobs = 2};
  Exploration exploration(grid, whole, scenes, results, setting);
  exploration.run(plan.candidates);
  const std::vector<Outcome> all = outcomes(grid, plan, exploration);
  REQUIRE(all.size() == 384);
  for (const int seed : {1, 2, 3}) {
    CAPTURE(seed);
    const Sweep sweep = folder.sweep("design = \"search\"\npoints = 38\nseed = " + std::to_string(seed) +
                                     "\n" + scene + space_text);
    const Space space(sweep);
    Exploration searched(sweep, space, scenes, results, setting);
    const Plan found = search(sweep, space, searched);
    CHECK(found.candidates.size() == 38);
    const double part = volume(outcomes(sweep, found, searched), all) / volume(all, all);
    CAPTURE(part);
    CHECK(part >= 0.99);
    CHECK(hashes(search(sweep, space, searched)) == hashes(found));  // same seed, same machines
  }
}

}  // namespace quadrille::studies::explore
