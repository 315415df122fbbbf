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

std::size_t first_count(const Sweep& sweep) {
  const auto designed = static_cast<std::size_t>(std::ceil(kDesigned * sweep.points));
  return std::min<std::size_t>(sweep.points, std::max(designed, 2 * sweep.dimensions.size() + 2));
}

/// Places of the design with this number, many for each machine that is wanted: machines come up again, or
/// are left out.
std::vector<double> designed_places(const Sweep& sweep, std::size_t wanted, std::uint64_t number) {
  constexpr std::size_t kTries = 16;
  return design_places("sobol", sweep.dimensions.size(), kTries * wanted, sweep.seed + 1000 * number);
}

class Search {
 public:
  Search(const Sweep& sweep, const Space& space, Exploration& exploration)
      : sweep_(sweep), space_(space), exploration_(exploration) {}

  Plan run() {
    add(designed_places(sweep_, first_count(sweep_), 0), first_count(sweep_));
    const std::size_t batch = std::max<std::size_t>(1, (sweep_.points - first_count(sweep_)) / kRounds);
    for (std::uint64_t round = 1; plan_.candidates.size() < sweep_.points; ++round) {
      const std::size_t before = plan_.candidates.size();
      const std::size_t wanted = std::min(batch, sweep_.points - before);
      add(next_places(wanted), wanted);
      if (plan_.candidates.size() == before) add(designed_places(sweep_, wanted, round), wanted);
      if (plan_.candidates.size() == before) break;  // the space has hardly a machine more
    }
    return std::move(plan_);
  }

 private:
  /// Draws up to so many machines of these that are new.
  void add(const std::vector<double>& places, std::size_t wanted) {
    const Plan found = space_.at(places);
    plan_.tried += found.tried;
    for (const auto& [reason, count] : found.excluded) plan_.excluded[reason] += count;
    std::vector<Candidate> fresh;
    for (const Candidate& candidate : found.candidates)
      if (fresh.size() < wanted && taken_.insert(candidate.values).second) fresh.push_back(candidate);
    exploration_.run(fresh, sweep_.points - plan_.candidates.size() - fresh.size());
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
      most.push_back(objective.most && objective.at_least   ? -*objective.at_least
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
};

}  // namespace

Plan first_machines(const Sweep& sweep, const Space& space) {
  const std::size_t count = first_count(sweep);
  Plan plan = space.at(designed_places(sweep, count, 0));
  if (plan.candidates.size() > count) plan.candidates.resize(count);
  plan.repeated = 0;  // more places were asked for than machines
  return plan;
}

Plan search(const Sweep& sweep, const Space& space, Exploration& exploration) {
  return Search(sweep, space, exploration).run();
}

}  // namespace quadrille::studies::explore
