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
    const auto flags = std::make_unique<bool[]>(values.size());
    std::vector<double> out;
    if (!of_designs_library<QuadrilleFront>("quadrille_front")(values.size(), values[0].size(), flat(values).data(),
                                                               flags.get(), message))
      return out;
    for (std::size_t i = 0; i < values.size(); ++i) out.push_back(flags[i] ? 1 : 0);
    return out;
  });
  std::vector<bool> front;
  for (const double flag : on) front.push_back(flag != 0);
  return front;
}

double hypervolume(const Rows& values, const std::vector<double>& reference) {
  return in_designs_library("hypervolume", [&](QuadrilleMessage* message) {
           double volume = 0;
           const bool good = of_designs_library<QuadrilleHypervolume>("quadrille_hypervolume")(
               values.size(), reference.size(), flat(values).data(), reference.data(), &volume, message);
           return good ? std::vector<double>{volume} : std::vector<double>{};
         })
      .at(0);
}

SobolIndices sobol_indices(const Rows& places, const std::vector<double>& values) {
  const std::size_t width = places.at(0).size();
  const std::vector<double> all = in_designs_library("indices", [&](QuadrilleMessage* message) {
    std::vector<double> out(2 * width + width * width + 1);
    double* const first = out.data();
    const bool good = of_designs_library<QuadrilleIndices>("quadrille_indices")(
        values.size(), width, flat(places).data(), values.data(), first, first + width, first + 2 * width,
        &out.back(), message);
    return good ? out : std::vector<double>{};
  });
  SobolIndices indices;
  const auto at = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  indices.first.assign(at(0), at(width));
  indices.total.assign(at(width), at(2 * width));
  for (std::size_t i = 0; i < width; ++i) indices.pairs.emplace_back(at((2 + i) * width), at((3 + i) * width));
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
    place.push_back(d.logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low));
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
  Rows places;
  for (const Outcome& outcome : outcomes) places.push_back(place_of(sweep, *outcome.candidate));
  std::vector<SobolIndices> all;
  for (std::size_t i = 0; i < sweep.objectives.size(); ++i) {
    std::vector<double> values;
    for (const Outcome& outcome : outcomes) values.push_back(outcome.values[i]);
    const auto [least, most] = std::ranges::minmax(values);
    // A straight line needs a row more than it has slopes.
    const bool varied = !places.empty() && places.size() > 2 * sweep.dimensions.size() + 1 && most > least;
    all.push_back(varied && !sweep.dimensions.empty() ? sobol_indices(places, values) : SobolIndices{});
  }
  return all;
}

}  // namespace quadrille::studies::explore
