#include "studies/explore/analysis.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/base/error.h"
#include "scenes/scene.h"
#include "studies/explore/design.h"
#include "studies/explore/search.h"
#include "tests/studies/explore/sweep_folder.h"

namespace quadrille::studies::explore {
namespace {

/// Ishigami's function with a = 7, b = 0.1, of places in 0..1.
double ishigami(const std::vector<double>& place) {
  const auto x = [&](std::size_t i) { return std::numbers::pi * (2 * place[i] - 1); };
  return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

/// A table of a function over a Sobol design.
SobolIndices indices_over(std::size_t width, std::size_t rows,
                          double (*function)(const std::vector<double>&)) {
  const std::vector<double> all = design_places("sobol", width, rows, 1);
  Rows places;
  std::vector<double> values;
  places.reserve(rows);
  values.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(row * width);
    places.emplace_back(at, at + static_cast<std::ptrdiff_t>(width));
    values.push_back(function(places.back()));
  }
  return sobol_indices(places, std::vector<std::size_t>(width), values);
}

/// The g-function of Sobol, with its weights.
constexpr double kWeights[] = {0, 1, 4.5, 9, 99, 99, 99, 99};
double g_function(const std::vector<double>& place) {
  double product = 1;
  for (std::size_t i = 0; i < place.size(); ++i)
    product *= (std::abs(4 * place[i] - 2) + kWeights[i]) / (1 + kWeights[i]);
  return product;
}

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

TEST_CASE("indices: those of Ishigami's function are those of its closed form") {
  const SobolIndices found = indices_over(3, 512, ishigami);
  const double pi4 = std::pow(std::numbers::pi, 4), a = 7, b = 0.1;
  const double alone1 = 0.5 * std::pow(1 + b * pi4 / 5, 2), alone2 = a * a / 8;
  const double both13 = b * b * pi4 * pi4 * (1.0 / 18 - 1.0 / 50), all = alone1 + alone2 + both13;
  CHECK(found.explained > 0.99);
  CHECK(found.first[0] == Approx(alone1 / all).margin(0.01));
  CHECK(found.first[1] == Approx(alone2 / all).margin(0.01));
  CHECK(found.first[2] == Approx(0).margin(0.01));
  CHECK(found.total[0] == Approx((alone1 + both13) / all).margin(0.01));
  CHECK(found.total[1] == Approx(alone2 / all).margin(0.01));
  CHECK(found.total[2] == Approx(both13 / all).margin(0.01));
  CHECK(found.pairs[0][2] == Approx(both13 / all).margin(0.01));
  CHECK(found.pairs[0][1] == Approx(0).margin(0.01));
}

TEST_CASE("indices: eight parameters, of which two matter together") {
  const SobolIndices found = indices_over(
      8, 200, [](const std::vector<double>& x) { return 3 * x[1] + (x[4] - 0.5) * (x[6] - 0.5) * 12; });
  // Variances: 9 / 12, and 144 / 144.
  CHECK(found.first[1] == Approx(0.75 / 1.75).margin(0.01));
  CHECK(found.pairs[4][6] == Approx(1 / 1.75).margin(0.01));
  CHECK(found.total[4] == Approx(1 / 1.75).margin(0.01));
  for (const std::size_t i : {0u, 2u, 3u, 5u, 7u}) CHECK(found.total[i] < 0.01);
}

TEST_CASE("indices: those of the g-function of eight parameters are those of its closed form [slow]",
          "[slow]") {
  const SobolIndices found = indices_over(8, 512, g_function);
  double all = 1;
  std::vector<double> alone;
  for (const double weight : kWeights) alone.push_back(1 / (3 * (1 + weight) * (1 + weight)));
  for (const double v : alone) all *= 1 + v;
  for (std::size_t i = 0; i < 8; ++i) {
    CAPTURE(i);
    CHECK(found.first[i] == Approx(alone[i] / (all - 1)).margin(0.015));
    CHECK(found.total[i] == Approx(alone[i] * all / (1 + alone[i]) / (all - 1)).margin(0.015));
  }
  CHECK(found.pairs[0][1] == Approx(alone[0] * alone[1] / (all - 1)).margin(0.015));
}

TEST_CASE("indices: a table of all combinations has those of its levels, to the last") {
  const std::vector<std::size_t> levels{2, 3, 5};
  Rows places;
  std::vector<double> values;
  const auto middle = [](std::size_t i, std::size_t of) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(of);
  };
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t c = 0; c < 5; ++c) {
        places.push_back({middle(a, 2), middle(b, 3), middle(c, 5)});
        // Whatever their order: 4 or 0, and 3, 0, -3 for the second alone; the third matters with the first.
        values.push_back((a == 0 ? 4 : 0) +
                         (b == 0   ? 3
                          : b == 1 ? -3
                                   : 0) +
                         (c == 3 ? (a == 0 ? 5 : -5) : 0));
      }
  const SobolIndices found = sobol_indices(places, levels, values);
  // The first moves the mean by 4 and, through the third's fourth level, by 2 more: 6 apart, so 9.
  const double one = 9, two = 6, both = 0.2 * 16 + 0.8, all = one + two + both;
  CHECK(found.first[0] == Approx(one / all).margin(1e-4));
  CHECK(found.first[1] == Approx(two / all).margin(1e-4));
  CHECK(found.first[2] == Approx(0).margin(1e-4));
  CHECK(found.pairs[0][2] == Approx(both / all).margin(1e-4));
  CHECK(found.total[2] == Approx(both / all).margin(1e-4));
}

TEST_CASE("indices: a fit of noise is said to explain nothing") {
  unsigned state = 1;
  const std::vector<double> all = design_places("sobol", 4, 200, 1);
  Rows places;
  std::vector<double> values;
  for (std::size_t row = 0; row < 200; ++row) {
    state = state * 1664525u + 1013904223u;
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(4 * row);
    places.emplace_back(at, at + 4);
    values.push_back(state);
  }
  CHECK(sobol_indices(places, std::vector<std::size_t>(4), values).explained < 0.2);
}

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
