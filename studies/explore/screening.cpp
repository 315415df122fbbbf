#include "studies/explore/screening.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "models/base/error.h"
#include "studies/explore/analysis.h"
#include "studies/explore/explore_table.h"

namespace quadrille::studies::explore {
namespace {

using ByMachine = std::map<const Candidate*, Outcome>;

/// Front after front of those that hold the limits, then the others by the first objective; within a front
/// too.
std::vector<Outcome> best_first(std::vector<Outcome> left) {
  const auto by_first = [](const Outcome& a, const Outcome& b) { return a.costs[0] < b.costs[0]; };
  std::vector<Outcome> ordered, others;
  std::ranges::copy_if(left, std::back_inserter(others), [](const Outcome& o) { return !o.holds; });
  std::erase_if(left, [](const Outcome& o) { return !o.holds; });
  std::ranges::stable_sort(left, by_first);
  std::ranges::stable_sort(others, by_first);
  while (!left.empty()) {
    Rows costs;
    costs.reserve(left.size());
    for (const Outcome& outcome : left) costs.push_back(outcome.costs);
    const std::vector<bool> on_front = front_of(costs);
    std::vector<Outcome> behind;
    for (std::size_t i = 0; i < left.size(); ++i)
      (on_front[i] ? ordered : behind).push_back(std::move(left[i]));
    left = std::move(behind);
  }
  ordered.insert(ordered.end(), others.begin(), others.end());
  return ordered;
}

/// Do two machines stand the other way round, by more than what counts as no difference?
bool turned(double rough_a, double rough_b, double exact_a, double exact_b, double noise) {
  const double least = noise * std::max(std::abs(exact_a), std::abs(exact_b));
  return std::abs(exact_a - exact_b) > least && (rough_a - rough_b) * (exact_a - exact_b) < 0;
}

Screening::Error error_of(const Sweep& sweep, std::size_t objective, const ByMachine& rough,
                          const std::vector<Outcome>& exact) {
  Screening::Error error;
  const auto rough_cost = [&](const Outcome& o) { return rough.at(o.candidate).costs[objective]; };
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double cost = exact[i].costs[objective], off = std::abs(cost - rough_cost(exact[i]));
    if (off > 0)
      error.greatest =
          std::max(error.greatest, off / std::max(std::abs(cost), std::abs(rough_cost(exact[i]))));
    for (std::size_t j = 0; j < i; ++j) {
      ++error.pairs;
      error.turned += turned(rough_cost(exact[i]), rough_cost(exact[j]), cost, exact[j].costs[objective],
                             sweep.objectives[objective].noise);
    }
  }
  return error;
}

/// The best that the machine may come to if the window is off as much as elsewhere.
Outcome at_best(const Sweep& sweep, Outcome outcome, const std::vector<Screening::Error>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double off = errors[i].greatest * std::abs(outcome.costs[i]);
    outcome.costs[i] -= off;
    outcome.values[i] += sweep.objectives[i].most ? off : -off;
  }
  outcome.holds = outcome.holds || holds_limits(sweep, outcome.values);
  return outcome;
}

std::size_t count_maybe_better(const Sweep& sweep, const std::vector<Outcome>& others,
                               const std::vector<Outcome>& exact,
                               const std::vector<Screening::Error>& errors) {
  return static_cast<std::size_t>(std::ranges::count_if(others, [&](const Outcome& other) {
    const Outcome best = at_best(sweep, other, errors);
    return best.holds && std::ranges::none_of(exact, [&](const Outcome& drawn) {
             return drawn.holds && std::ranges::equal(drawn.costs, best.costs, std::less_equal{});
           });
  }));
}

}  // namespace

Screening screen(const Sweep& sweep, const Space& space, std::span<const LoadedScene> scenes,
                 Results& results, const ExploreSetting& setting, Plan& plan) {
  Screening screening;
  screening.window = sweep.screen->window;
  screening.screened = plan.candidates.size();
  Exploration rough(sweep, space, scenes, results, setting, screening.window);
  rough.run(plan.candidates);
  screening.failed = failed_points(plan, rough);
  const std::vector<Outcome> all = best_first(outcomes(sweep, plan, rough));
  if (all.empty()) throw user_error("{}: screen: no machine could be drawn with the window", sweep.file);
  screening.exactly = std::min<std::size_t>(sweep.screen->machines, all.size());
  Plan best = plan;
  best.candidates.clear();
  for (std::size_t i = 0; i < screening.exactly; ++i) best.candidates.push_back(*all[i].candidate);
  Exploration exploration(sweep, space, scenes, results, setting);
  exploration.run(best.candidates);
  ByMachine rough_of;
  for (std::size_t i = 0; i < screening.exactly; ++i) rough_of.emplace(&best.candidates[i], all[i]);
  const std::vector<Outcome> exact = outcomes(sweep, best, exploration);
  for (std::size_t i = 0; i < sweep.objectives.size(); ++i)
    screening.errors.push_back(error_of(sweep, i, rough_of, exact));
  screening.maybe_better =
      count_maybe_better(sweep, {all.begin() + static_cast<std::ptrdiff_t>(screening.exactly), all.end()},
                         exact, screening.errors);
  plan = std::move(best);
  return screening;
}

std::string screening_table(const Sweep& sweep, const Screening& s) {
  std::string text =
      fmt::format("SCREENED  {} machines with a window of {} cycles; the best {} were drawn exactly\n",
                  s.screened, s.window, s.exactly);
  for (std::size_t i = 0; i < s.errors.size(); ++i)
    text += fmt::format("  {}: the window was off by {:.2f} % at most; {} of {} pairs changed their order\n",
                        sweep.objectives[i].name, 100 * s.errors[i].greatest, s.errors[i].turned,
                        s.errors[i].pairs);
  if (s.failed > 0)
    text += fmt::format("  {} points could not be drawn with the window; the results have their reasons\n",
                        s.failed);
  const std::size_t others = s.screened - s.exactly;
  if (others == 0) return text;
  return text +
         (s.maybe_better == 0
              ? fmt::format("  none of the other {} is better, if the window is off no more there\n", others)
              : fmt::format("  {} of the other {} may be better, if the window is off as much there: draw "
                            "more exactly\n",
                            s.maybe_better, others));
}

}  // namespace quadrille::studies::explore
