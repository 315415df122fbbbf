#include "studies/explore/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "models/base/error.h"
#include "studies/explore/analysis.h"
#include "studies/explore/design.h"
#include "studies/explore/designs_library.h"

namespace quadrille::studies::explore {
namespace {

constexpr double kDesigned = 0.4;   // of the machines: those of the first design
constexpr std::size_t kRounds = 8;  // for the others

class Search {
 public:
  Search(const Sweep& sweep, const Space& space, Exploration& exploration)
      : sweep_(sweep), space_(space), exploration_(exploration) {}

  Plan run() {
    const std::size_t width = sweep_.dimensions.size();
    const auto designed = static_cast<std::size_t>(std::ceil(kDesigned * sweep_.points));
    add_designed(std::min<std::size_t>(sweep_.points, std::max(designed, 2 * width + 2)));
    const std::size_t batch = std::max<std::size_t>(1, (sweep_.points - plan_.candidates.size()) / kRounds);
    while (plan_.candidates.size() < sweep_.points) {
      const std::size_t before = plan_.candidates.size();
      const std::size_t wanted = std::min(batch, sweep_.points - before);
      add(next_places(wanted), wanted);
      if (plan_.candidates.size() == before) add_designed(wanted);
      if (plan_.candidates.size() == before) break;  // the space has no more machines
    }
    return std::move(plan_);
  }

 private:
  /// Draws machines of a design that are new.
  void add_designed(std::size_t wanted) {
    constexpr std::size_t kTries = 16;  // places for each machine that is wanted: many come up again
    const std::uint64_t seed = sweep_.seed + 1000 * designs_++;
    add(design_places("sobol", sweep_.dimensions.size(), kTries * wanted, seed), wanted);
  }
  void add(const std::vector<double>& places, std::size_t wanted) {
    const Plan found = space_.at(places);
    plan_.tried += found.tried;
    plan_.repeated += found.repeated;
    for (const auto& [reason, count] : found.excluded) plan_.excluded[reason] += count;
    std::vector<Candidate> fresh;
    for (const Candidate& candidate : found.candidates)
      if (fresh.size() < wanted && taken_.insert(candidate.values).second) fresh.push_back(candidate);
    exploration_.run(fresh);
    plan_.candidates.insert(plan_.candidates.end(), fresh.begin(), fresh.end());
  }
  /// Objectives that no frame tells: a cost by formula.
  [[nodiscard]] std::vector<double> known_without_frame(std::span<const std::string> values,
                                                        const pipeline::MachineConfig& machine) const {
    std::vector<double> all;
    for (const Objective& objective : sweep_.objectives) {
      bool known = true;
      const auto lookup = [&](const std::string& name) {
        for (std::size_t i = 0; i < all.size(); ++i)
          if (sweep_.objectives[i].name == name) return all[i];
        return space_.value(name, values, machine).value_or(std::nan(""));
      };
      for (const std::string& name : objective.formula.names()) known &= !std::isnan(lookup(name));
      all.push_back(known ? objective.formula.value(lookup) : std::nan(""));
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (sweep_.objectives[i].over == Objective::Over::kSum)
        all[i] *= static_cast<double>(exploration_.scenes().size());
      if (sweep_.objectives[i].most) all[i] = -all[i];
    }
    return all;
  }
  /// In the process of the library: whether there is a machine at a place that could be drawn.
  [[nodiscard]] bool judge(const double* place, double* values) const {
    const Plan one = space_.at({place, sweep_.dimensions.size()});
    if (one.candidates.empty() || failed_.contains(one.candidates[0].values)) return false;
    pipeline::MachineConfig machine;
    space_.configure(one.candidates[0].values, machine);
    std::ranges::copy(known_without_frame(one.candidates[0].values, machine), values);
    return true;
  }
  [[nodiscard]] std::vector<double> limits() const {
    std::vector<double> most;
    for (const Objective& objective : sweep_.objectives)
      most.push_back(objective.most && objective.at_least    ? -*objective.at_least
                     : !objective.most && objective.at_most ? *objective.at_most
                                                            : std::numeric_limits<double>::infinity());
    return most;
  }
  [[nodiscard]] std::vector<double> next_places(std::size_t wanted) {
    const std::vector<Outcome> drawn = outcomes(sweep_, plan_, exploration_);
    std::vector<double> places, values;
    failed_ = taken_;
    for (const Outcome& outcome : drawn) {
      failed_.erase(outcome.candidate->values);
      const std::vector<double> place = place_of(sweep_, *outcome.candidate);
      places.insert(places.end(), place.begin(), place.end());
      values.insert(values.end(), outcome.costs.begin(), outcome.costs.end());
    }
    if (drawn.size() < sweep_.dimensions.size() + 2) return {};  // too few to guess from
    std::vector<std::size_t> levels;
    for (const Dimension& d : sweep_.dimensions) levels.push_back(d.levels.size());
    const std::vector<double> most = limits();
    const QuadrilleSearch asked{sweep_.dimensions.size(),
                                sweep_.objectives.size(),
                                drawn.size(),
                                wanted,
                                levels.data(),
                                places.data(),
                                values.data(),
                                most.data(),
                                sweep_.seed + plan_.candidates.size(),
                                [](void* owner, const double* place, double* out) {
                                  return static_cast<const Search*>(owner)->judge(place, out);
                                },
                                this};
    return in_designs_library("search", [&](QuadrilleMessage* message) {
      std::vector<double> out(wanted * sweep_.dimensions.size());
      std::size_t found = 0;
      (void)of_designs_library<QuadrilleSearchRound>("quadrille_search")(&asked, out.data(), &found, message);
      out.resize(found * sweep_.dimensions.size());
      return out;
    });
  }

  const Sweep& sweep_;
  const Space& space_;
  Exploration& exploration_;
  Plan plan_;
  std::set<std::vector<std::string>> taken_, failed_;
  std::uint64_t designs_ = 0;
};

}  // namespace

Plan search(const Sweep& sweep, const Space& space, Exploration& exploration) {
  return Search(sweep, space, exploration).run();
}

}  // namespace quadrille::studies::explore
