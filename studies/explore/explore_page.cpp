#include "studies/explore/explore_page.h"

#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "pipeline/report/page.h"
#include "studies/explore/analysis.h"

namespace quadrille::studies::explore {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// The scene with its options, as the command line of `render` has them.
std::string render_arguments(const SceneEntry& entry) {
  std::string text = entry.scene;
  for (const Entry& option : entry.options) {
    std::string flag = option.key;
    for (char& c : flag)
      if (c == '_') c = '-';
    if (option.value == "false") continue;
    text += fmt::format(" --{}{}", flag, option.value == "true" ? "" : " " + option.value);
  }
  return text;
}

Json objectives_json(const Sweep& sweep) {
  Json all = Json::array();
  for (const Objective& o : sweep.objectives)
    all.push_back({{"name", o.name},
                   {"unit", o.unit},
                   {"formula", o.formula.text()},
                   {"most", o.most},
                   {"at_most", or_null(o.at_most)},
                   {"at_least", or_null(o.at_least)},
                   {"noise", o.noise}});
  return all;
}

Json dimensions_json(const Sweep& sweep) {
  Json all = Json::array();
  for (const Dimension& d : sweep.dimensions)
    all.push_back({{"name", d.name}, {"levels", d.continuous() ? Json(nullptr) : Json(d.levels)}});
  return all;
}

/// The machines of which every point is done, with what each scene came to.
class Machines {
 public:
  explicit Machines(const PageSubject& subject) : subject_(subject) {}

  Json json(const std::vector<Outcome>& outcomes) {
    Json all = Json::array();
    for (const Outcome& outcome : outcomes) {
      const Candidate& candidate = *outcome.candidate;
      Json machine = {{"machine", candidate.machine}, {"values", candidate.values},
                      {"objectives", outcome.values}, {"holds", outcome.holds},
                      {"front", outcome.on_front},    {"by_scene", Json::array()},
                      {"pictures", Json::array()},    {"seconds", 0.0}};
      double seconds = 0;
      for (std::size_t s = 0; s < subject_.exploration.scenes().size(); ++s) {
        const std::optional<PointRow> row = subject_.exploration.point(s, candidate);
        QUADRILLE_CHECK(row.has_value(), "a machine that is drawn lacks a point");
        machine["by_scene"].push_back(
            objective_values(subject_.sweep, subject_.space, candidate.values, figures_of(row->figures)));
        machine["pictures"].push_back(picture(row->picture));
        machine["settings"] = row->settings;
        seconds += row->wall_s;
      }
      machine["seconds"] = seconds;
      all.push_back(std::move(machine));
    }
    return all;
  }
  /// As addresses that hold the files.
  [[nodiscard]] const Json& pictures() const { return pictures_; }

 private:
  /// Its number among the pictures.
  std::size_t picture(const std::string& hash) {
    const auto [entry, fresh] = numbers_.emplace(hash, numbers_.size());
    if (fresh) pictures_.push_back(pipeline::png_data_uri(subject_.results.picture(hash)));
    return entry->second;
  }

  const PageSubject& subject_;
  std::map<std::string, std::size_t> numbers_;
  Json pictures_ = Json::array();
};

Json failed_json(const Plan& plan, const Exploration& exploration) {
  Json all = Json::array();
  for (const Candidate& candidate : plan.candidates)
    for (std::size_t s = 0; s < exploration.scenes().size(); ++s) {
      const std::optional<PointRow> row = exploration.point(s, candidate);
      if (row && !row->done())
        all.push_back({{"scene", row->scene},
                       {"machine", fmt::format("{} {}", row->machine, fmt::join(row->settings, " "))},
                       {"status", row->status},
                       {"reason", row->reason},
                       {"log", row->log}});
    }
  return all;
}

Json indices_json(const std::vector<SobolIndices>& all) {
  Json json = Json::array();
  for (const SobolIndices& indices : all)
    json.push_back(indices.first.empty() ? Json(nullptr)
                                         : Json{{"first", indices.first},
                                                {"total", indices.total},
                                                {"pairs", indices.pairs},
                                                {"explained", indices.explained}});
  return json;
}

}  // namespace

std::string sweep_json(const PageSubject& subject) {
  const auto& [sweep, space, plan, exploration, results] = subject;
  const std::vector<Outcome> drawn = outcomes(sweep, plan, exploration);
  Machines machines(subject);
  Json json = {{"schema", "quadrille-sweep-1"},
               {"title", sweep.file},
               {"design", kDesignNames[static_cast<std::size_t>(sweep.design)]},
               {"seed", sweep.seed},
               {"versions", results.versions()},
               {"objectives", objectives_json(sweep)},
               {"dimensions", dimensions_json(sweep)},
               {"scenes", Json::array()},
               {"machines", machines.json(drawn)},
               {"failed", failed_json(plan, exploration)},
               {"excluded", Json::array()}};
  json["pictures"] = machines.pictures();
  // A search looks where it is good, so its machines are no fair sample of the space.
  const bool fair = sweep.design != DesignKind::kSearch;
  json["indices"] = fair ? indices_json(indices_of(sweep, drawn)) : Json::array();
  for (const LoadedScene& scene : exploration.scenes())
    json["scenes"].push_back({{"name", scene.entry.name}, {"arguments", render_arguments(scene.entry)}});
  for (const auto& [reason, count] : plan.excluded)
    json["excluded"].push_back({{"reason", reason}, {"count", count}});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string sweep_page(const PageSubject& subject) {
  return pipeline::page_of_sweep(subject.sweep.file, sweep_json(subject));
}

}  // namespace quadrille::studies::explore
