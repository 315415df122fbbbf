#include "studies/explore/analysis.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "models/base/error.h"
#include "studies/explore/designs_library.h"

namespace quadrille::studies::explore {
namespace {

std::vector<double> flat(const Rows& rows) {
  std::vector<double> all;
  for (const std::vector<double>& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

double number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::vector<bool> front_of(const Rows& values) {
  if (values.empty()) return {};
  const std::vector<double> on = in_designs_library("front", [&](QuadrilleMessage* message) {
    std::vector<std::uint8_t> flags(values.size());
    (void)of_designs_library<QuadrilleFront>("quadrille_front")(values.size(), values[0].size(),
                                                                flat(values).data(), flags.data(), message);
    return std::vector<double>(flags.begin(), flags.end());
  });
  std::vector<bool> front;
  front.reserve(on.size());
  for (const double flag : on) front.push_back(flag != 0);
  return front;
}

double hypervolume(const Rows& values, const std::vector<double>& reference) {
  return in_designs_library(
             "hypervolume",
             [&](QuadrilleMessage* message) {
               double volume = 0;
               const bool good = of_designs_library<QuadrilleHypervolume>("quadrille_hypervolume")(
                   values.size(), reference.size(), flat(values).data(), reference.data(), &volume, message);
               return good ? std::vector<double>{volume} : std::vector<double>{};
             })
      .at(0);
}

SobolIndices sobol_indices(const Rows& places, const std::vector<std::size_t>& levels,
                           const std::vector<double>& values) {
  const std::size_t width = levels.size();
  const std::vector<double> all = in_designs_library("Sobol indices", [&](QuadrilleMessage* message) {
    std::vector<double> out(2 * width + width * width + 1);
    QuadrilleIndices found{out.data(), out.data() + width, out.data() + 2 * width, 0};
    (void)of_designs_library<QuadrilleIndicesOf>("quadrille_indices")(
        values.size(), width, levels.data(), flat(places).data(), values.data(), &found, message);
    out.back() = found.left_over;
    return out;
  });
  SobolIndices indices;
  const auto at = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  indices.first.assign(at(0), at(width));
  indices.total.assign(at(width), at(2 * width));
  indices.pairs.reserve(width);
  for (std::size_t i = 0; i < width; ++i)
    indices.pairs.emplace_back(at((2 + i) * width), at((3 + i) * width));
  indices.explained = 1 - all.back();
  return indices;
}

std::vector<double> place_of(const Sweep& sweep, const Candidate& candidate) {
  std::vector<double> place;
  for (std::size_t i = 0; i < sweep.dimensions.size(); ++i) {
    const Dimension& d = sweep.dimensions[i];
    if (!d.continuous()) {
      const auto level = std::ranges::find(d.levels, candidate.values[i]) - d.levels.begin();
      place.push_back((static_cast<double>(level) + 0.5) / static_cast<double>(d.levels.size()));
      continue;
    }
    const double half = d.whole ? 0.5 : 0, low = d.from - half, high = d.to + half;
    const double value = number(candidate.values[i]);
    place.push_back(d.logarithmic ? std::log(value / low) / std::log(high / low)
                                  : (value - low) / (high - low));
  }
  return place;
}

std::vector<Outcome> outcomes(const Sweep& sweep, const Plan& plan, const Exploration& exploration) {
  std::vector<Outcome> all;
  Rows holding;
  for (const Candidate& candidate : plan.candidates) {
    const auto values = exploration.objectives(candidate);
    if (!values) continue;
    Outcome outcome{&candidate, *values, *values, holds_limits(sweep, *values)};
    for (std::size_t i = 0; i < sweep.objectives.size(); ++i)
      if (sweep.objectives[i].most) outcome.costs[i] = -outcome.costs[i];
    if (outcome.holds) holding.push_back(outcome.costs);
    all.push_back(std::move(outcome));
  }
  const std::vector<bool> front = front_of(holding);
  std::size_t at = 0;
  for (Outcome& outcome : all)
    if (outcome.holds) outcome.on_front = front[at++];
  return all;
}

std::vector<SobolIndices> indices_of(const Sweep& sweep, const std::vector<Outcome>& outcomes) {
  std::vector<std::size_t> levels;
  levels.reserve(sweep.dimensions.size());
  for (const Dimension& dimension : sweep.dimensions) levels.push_back(dimension.levels.size());
  Rows places;
  places.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) places.push_back(place_of(sweep, *outcome.candidate));
  std::vector<SobolIndices> all(sweep.objectives.size());
  if (levels.empty() || places.size() < 2 * levels.size() + 2) return all;  // no more than two a slope
  for (std::size_t i = 0; i < sweep.objectives.size(); ++i) {
    std::vector<double> values;
    values.reserve(outcomes.size());
    for (const Outcome& outcome : outcomes) values.push_back(outcome.values[i]);
    const auto [least, most] = std::ranges::minmax(values);
    if (most > least) all[i] = sobol_indices(places, levels, values);
  }
  return all;
}

}  // namespace quadrille::studies::explore
