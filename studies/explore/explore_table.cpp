#include "studies/explore/explore_table.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "models/base/error.h"
#include "studies/explore/analysis.h"

namespace quadrille::studies::explore {
namespace {

constexpr std::size_t kListed = 10;

/// A field of CSV [RFC 4180]: in quotes where it holds what would end it.
std::string field(const std::string& text) {
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

/// "90 s", "12 min", "3.5 h"
std::string duration(double seconds) {
  if (seconds < 120) return fmt::format("{:.3g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.3g} min", seconds / 60);
  return fmt::format("{:.3g} h", seconds / 3600);
}

std::string values_text(const Sweep& sweep, const Candidate& candidate) {
  std::string text;
  for (std::size_t i = 0; i < candidate.values.size(); ++i)
    text += fmt::format("{}{}={}", i == 0 ? "" : " ", sweep.dimensions[i].name, candidate.values[i]);
  return text.empty() ? candidate.machine : text;
}

/// Which points failed, and why.
std::string failures_text(const Sweep& sweep, const Plan& plan, const Exploration& exploration) {
  std::string failures;
  std::size_t failed = 0;
  for (const Candidate& candidate : plan.candidates)
    for (std::size_t s = 0; s < exploration.scenes().size(); ++s) {
      const std::optional<PointRow> row = exploration.point(s, candidate);
      if (!row || row->done()) continue;
      if (++failed <= kListed)
        failures += fmt::format("  {} on {}: {}: {}\n", row->scene, values_text(sweep, candidate),
                                row->status, one_line(row->reason));
    }
  if (failed == 0) return {};
  if (failed > kListed) failures += fmt::format("  and {} more\n", failed - kListed);
  return fmt::format("FAILED  {} points\n{}", failed, failures);
}

/// The first machines of these with their objectives, and a head.
std::string outcome_rows(const Sweep& sweep, const std::vector<Outcome>& machines) {
  std::string text;
  for (const Objective& objective : sweep.objectives) text += fmt::format("{:>16}", objective.name);
  text += "\n";
  for (std::size_t i = 0; i < std::min(machines.size(), kListed); ++i) {
    for (const double value : machines[i].values) text += fmt::format("{:>16.6g}", value);
    text += fmt::format("  {}\n", values_text(sweep, *machines[i].candidate));
  }
  if (machines.size() > kListed) text += fmt::format("  and {} more\n", machines.size() - kListed);
  return text;
}

}  // namespace

std::string plan_table(const Sweep& sweep, const Plan& plan, std::size_t scenes) {
  std::string text = fmt::format("EXPLORE  {}: {} machines x {} {} = {} points, design {}, seed {}\n",
                                 sweep.file, plan.candidates.size(), scenes, scenes == 1 ? "scene" : "scenes",
                                 plan.candidates.size() * scenes,
                                 kDesignNames[static_cast<std::size_t>(sweep.design)], sweep.seed);
  if (sweep.design == DesignKind::kSearch && plan.candidates.size() < sweep.points)
    text += fmt::format("  the search draws up to {} machines\n", sweep.points);
  if (plan.repeated > 0)
    text += fmt::format("  {} of {} machines came up more than once\n", plan.repeated, plan.tried);
  std::uint64_t excluded = 0;
  for (const auto& [reason, count] : plan.excluded) excluded += count;
  if (excluded > 0) text += fmt::format("  {} of {} combinations are left out:\n", excluded, plan.tried);
  std::vector<std::pair<std::uint64_t, std::string>> reasons;
  for (const auto& [reason, count] : plan.excluded) reasons.emplace_back(count, reason);
  std::sort(reasons.rbegin(), reasons.rend());
  for (std::size_t i = 0; i < std::min(reasons.size(), kListed); ++i)
    text += fmt::format("    {:>6}  {}\n", reasons[i].first, reasons[i].second);
  if (reasons.size() > kListed) text += fmt::format("    and {} reasons more\n", reasons.size() - kListed);
  return text;
}

std::string cost_table(const Measured& measured, std::size_t machines, std::size_t known, int jobs) {
  double seconds = 0;
  for (const double scene : measured.seconds) seconds += scene;
  const auto scenes = static_cast<double>(measured.seconds.size());
  const double points = static_cast<double>(machines) * scenes - static_cast<double>(known);
  return fmt::format(
      "  {} points are known; the other {:.0f} take about {} with {} at a time, and {:.3g} MiB ({} points "
      "were measured)\n",
      known, points, duration(seconds / scenes * points / jobs), jobs,
      (points * measured.bytes_a_point + measured.picture_bytes) / (1 << 20), measured.points);
}

std::size_t failed_points(const Plan& plan, const Exploration& exploration) {
  std::size_t failed = 0;
  for (const Candidate& candidate : plan.candidates)
    for (std::size_t s = 0; s < exploration.scenes().size(); ++s) {
      const std::optional<PointRow> row = exploration.point(s, candidate);
      failed += !row || !row->done();
    }
  return failed;
}

std::string result_table(const Sweep& sweep, const Plan& plan, const Exploration& exploration) {
  std::string text = failures_text(sweep, plan, exploration);
  std::vector<Outcome> holding = outcomes(sweep, plan, exploration);
  std::erase_if(holding, [](const Outcome& outcome) { return !outcome.holds; });
  std::stable_sort(holding.begin(), holding.end(),
                   [](const Outcome& a, const Outcome& b) { return a.costs[0] < b.costs[0]; });
  text += fmt::format("BEST  by {}, of {} machines that hold every limit\n", sweep.objectives.front().name,
                      holding.size());
  text += outcome_rows(sweep, holding);
  if (sweep.objectives.size() < 2) return text;
  std::erase_if(holding, [](const Outcome& outcome) { return !outcome.on_front; });
  text += fmt::format("FRONT  {} of them: no other is better in one objective and not worse in another\n",
                      holding.size());
  return text + outcome_rows(sweep, holding);
}

std::string points_csv(const Sweep& sweep, const Space& space, const Plan& plan,
                       const Exploration& exploration) {
  std::string text = "scene,machine";
  for (const Dimension& d : sweep.dimensions)
    if (d.name != "machine") text += "," + field(d.name);
  for (const Derived& derived : sweep.derived) text += "," + field(derived.name);
  text += ",status,reason";
  for (const Objective& objective : sweep.objectives) text += "," + field(objective.name);
  text += ",simulate_s,wall_s,peak_rss_mib,version,picture,settings\r\n";
  for (const Candidate& candidate : plan.candidates) {
    pipeline::MachineConfig machine;
    space.configure(candidate.values, machine);
    for (std::size_t s = 0; s < exploration.scenes().size(); ++s) {
      const std::optional<PointRow> row = exploration.point(s, candidate);
      if (!row) continue;
      text += field(exploration.scenes()[s].entry.name) + "," + field(candidate.machine);
      for (std::size_t i = 0; i < candidate.values.size(); ++i)
        if (sweep.dimensions[i].name != "machine") text += "," + field(candidate.values[i]);
      for (const Derived& derived : sweep.derived)
        text += fmt::format(",{}", *space.value(derived.name, candidate.values, machine));
      text += "," + row->status + "," + field(row->reason);
      const std::vector<double> values =
          row->done() ? objective_values(sweep, space, candidate.values, figures_of(row->figures))
                      : std::vector<double>();
      for (std::size_t i = 0; i < sweep.objectives.size(); ++i)
        text += values.empty() ? "," : fmt::format(",{}", values[i]);
      text += fmt::format(",{},{},{},{},{},{}\r\n", row->simulate_s, row->wall_s, row->peak_rss_mib,
                          field(row->version), row->picture,
                          field(fmt::format("{}", fmt::join(row->settings, " "))));
    }
  }
  return text;
}

}  // namespace quadrille::studies::explore
