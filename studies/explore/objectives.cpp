#include "studies/explore/objectives.h"

#include <algorithm>

#include <fmt/format.h>

#include "models/base/error.h"
#include "models/base/near_name.h"
#include "pipeline/machine/machine_plan.h"
#include "pipeline/report/report.h"

namespace quadrille::studies::explore {
namespace {

constexpr std::string_view kAll = "all.", kUnits = "units.";

bool is_unit_kind(std::string_view kind) {
  constexpr auto kKinds = pipeline::unit_kind_names();
  return std::ranges::find(kKinds, kind) != kKinds.end();
}

/// "all.l2.read_misses": over l2_0, l2_1 and so on. A machine that builds none has counted nothing.
std::optional<double> sum_of_kind(std::string_view name, const FigureMap& figures) {
  const std::string_view rest = name.substr(kAll.size());
  const std::size_t dot = rest.find('.');
  if (dot == std::string_view::npos || !is_unit_kind(rest.substr(0, dot))) return std::nullopt;
  const std::string_view kind = rest.substr(0, dot);
  const std::string counter = fmt::format(".counters.{}", rest.substr(dot + 1));
  const std::string first = fmt::format("{}{}", kUnits, kind);
  double sum = 0;
  bool found = false, built = false;
  for (auto at = figures.lower_bound(first); at != figures.end() && at->first.starts_with(first); ++at) {
    const std::string_view path = std::string_view(at->first).substr(kUnits.size());
    const std::string_view unit = path.substr(0, path.find('.'));
    if (pipeline::without_number(unit) != kind) continue;
    built = true;
    if (path.substr(unit.size()) != counter) continue;
    found = true;
    sum += at->second;
  }
  if (built && !found) return std::nullopt;  // it has no such counter
  return sum;
}

/// Where names of an objective come from.
class Names {
 public:
  Names(const Sweep& sweep, const Space& space, std::span<const std::string> values, const FigureMap& figures)
      : sweep_(sweep), space_(space), values_(values), figures_(figures) {
    space.configure(values, machine_);
  }
  /// `above`: the objectives that are known.
  [[nodiscard]] std::optional<double> find(const std::string& name, std::span<const double> above) const {
    for (std::size_t i = 0; i < above.size(); ++i)
      if (sweep_.objectives[i].name == name) return above[i];
    if (const auto value = space_.value(name, values_, machine_)) return value;
    return figure_value(name, figures_);
  }
  [[nodiscard]] std::vector<std::string> all(std::size_t above) const {
    std::vector<std::string> names = machine_.paths();
    for (const auto& [path, value] : figures_) names.push_back(path);
    for (std::size_t i = 0; i < above; ++i) names.push_back(sweep_.objectives[i].name);
    return names;
  }

 private:
  const Sweep& sweep_;
  const Space& space_;
  std::span<const std::string> values_;
  const FigureMap& figures_;
  pipeline::MachineConfig machine_;
};

}  // namespace

std::optional<double> figure_value(const std::string& name, const FigureMap& figures) {
  if (name.starts_with(kAll)) return sum_of_kind(name, figures);
  if (const auto found = figures.find(name); found != figures.end()) return found->second;
  if (!name.starts_with(kUnits)) return std::nullopt;
  const std::string_view path = std::string_view(name).substr(kUnits.size());
  const std::string unit(path.substr(0, path.find('.')));
  const std::string prefix = fmt::format("{}{}.", kUnits, unit);
  const auto next = figures.lower_bound(prefix);
  const bool built = next != figures.end() && next->first.starts_with(prefix);
  if (built || !is_unit_kind(pipeline::without_number(unit))) return std::nullopt;
  return 0;
}

void check_objectives(const Sweep& sweep, const Space& space, std::span<const std::string> values,
                      const FigureMap& figures) {
  const Names names(sweep, space, values, figures);
  std::vector<double> above;
  for (const Objective& objective : sweep.objectives) {
    for (const std::string& name : objective.formula.names())
      if (!names.find(name, above))
        throw user_error(
            "{}: '{}': '{}' is neither a figure, nor a parameter, nor a name of this file above it{}",
            objective.formula.where(), objective.formula.text(), name,
            did_you_mean(name, names.all(above.size())));
    above.push_back(1);
  }
}

std::vector<double> objective_values(const Sweep& sweep, const Space& space,
                                     std::span<const std::string> values, const FigureMap& figures) {
  const Names names(sweep, space, values, figures);
  std::vector<double> all;
  for (const Objective& objective : sweep.objectives) {
    all.push_back(objective.formula.value([&](const std::string& name) {
      const auto value = names.find(name, all);
      if (!value) throw user_error("{}: '{}' is no figure of this frame", objective.formula.where(), name);
      return *value;
    }));
  }
  return all;
}

std::vector<double> over_scenes(const Sweep& sweep, std::span<const std::vector<double>> scenes) {
  std::vector<double> all;
  for (std::size_t i = 0; i < sweep.objectives.size(); ++i) {
    const Objective& objective = sweep.objectives[i];
    double sum = 0, greatest = scenes[0][i], least = scenes[0][i];
    for (const std::vector<double>& scene : scenes) {
      sum += scene[i];
      greatest = std::max(greatest, scene[i]);
      least = std::min(least, scene[i]);
    }
    switch (objective.over) {
      case Objective::Over::kWorst: all.push_back(objective.most ? least : greatest); break;
      case Objective::Over::kMean: all.push_back(sum / static_cast<double>(scenes.size())); break;
      case Objective::Over::kSum: all.push_back(sum); break;
    }
  }
  return all;
}

bool holds_limits(const Sweep& sweep, std::span<const double> values) {
  for (std::size_t i = 0; i < sweep.objectives.size(); ++i) {
    const Objective& objective = sweep.objectives[i];
    if (objective.at_most && values[i] > *objective.at_most) return false;
    if (objective.at_least && values[i] < *objective.at_least) return false;
  }
  return true;
}

}  // namespace quadrille::studies::explore
