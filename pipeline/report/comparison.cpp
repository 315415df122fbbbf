#include "pipeline/report/comparison.h"

#include "pipeline/report/figures_document.h"
#include "pipeline/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <vector>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

/// A number, whole where it is.
Json number(double value) {
  constexpr double kExact = 9e15;  // whole numbers are exact in a double up to here
  if (std::abs(value) < kExact && std::floor(value) == value) return static_cast<std::int64_t>(value);
  return value;
}

/// A number of each side, and how far they are apart.
Json pair(const Json& a, const Json& b) {
  return {{"a", a}, {"b", b}, {"difference", number(b.get<double>() - a.get<double>())}};
}
Json pair(double a, double b) { return pair(number(a), number(b)); }

double size_of(const Json& entry, const char* key) {
  return std::abs(entry[key]["difference"].get<double>());
}

/// Largest difference first; equal ones keep their order.
void sort_by(std::vector<Json>& entries, const char* key) {
  std::ranges::stable_sort(entries,
                           [&](const Json& a, const Json& b) { return size_of(a, key) > size_of(b, key); });
}

/// Values of an object by key, with 0 where one side has none; in the order of the first, then the second.
template <class Take>
void over_both(const Json& a, const Json& b, const Take& take) {
  const Json none = 0;
  for (const auto& [key, value] : a.items()) take(key, value, b.contains(key) ? b[key] : none);
  for (const auto& [key, value] : b.items())
    if (!a.contains(key)) take(key, none, value);
}

Json subject(const std::string& file, const Json& d) {
  return {{"file", file},
          {"scene", d["scene"]},
          {"machine", d["machine"]["name"]},
          {"fidelity", d["fidelity"]},
          {"width", d["frame"]["width"]},
          {"height", d["frame"]["height"]},
          {"limit", d["limit"]["text"]}};
}

/// Of the machine, and how many times as fast as it some of its units ran.
Json parameters_of(const Json& document) {
  Json all = document["machine"]["parameters"];
  const Json faster = document.value("faster", Json::object());
  for (const auto& [kind, times] : faster.items()) all["faster." + kind] = times;
  return all;
}

Json parameters(const Json& a, const Json& b) {
  Json all = Json::array();
  const Json of_a = parameters_of(a), of_b = parameters_of(b);
  for (const auto& [path, value] : of_a.items()) {
    const Json other = of_b.contains(path) ? of_b[path] : Json(nullptr);
    if (value != other) all.push_back({{"path", path}, {"a", value}, {"b", other}});
  }
  for (const auto& [path, value] : of_b.items())
    if (!of_a.contains(path)) all.push_back({{"path", path}, {"a", nullptr}, {"b", value}});
  return all;
}

Json frame(const Json& a, const Json& b) {
  Json all = Json::object();
  over_both(a["frame"], b["frame"],
            [&](const std::string& key, const Json& x, const Json& y) { all[key] = pair(x, y); });
  return all;
}

/// All units of a kind: sums of their cycles and counters, and the greatest use.
struct KindSums {
  std::int64_t units = 0;
  double use = 0;
  std::map<std::string, double> cycles;
  Json counters = Json::object();
};

constexpr std::array<const char*, 5> kStates{"busy", "waiting", "starved", "blocked", "idle"};

/// By kind, in the order of the document.
std::vector<std::pair<std::string, KindSums>> by_kind(const Json& d) {
  std::vector<std::pair<std::string, KindSums>> all;
  for (const auto& [path, unit] : d["units"].items()) {
    const std::string kind(without_number(path));
    auto found = std::ranges::find(all, kind, [](const auto& entry) { return entry.first; });
    if (found == all.end()) found = all.insert(all.end(), {kind, {}});
    KindSums& sums = found->second;
    ++sums.units;
    sums.use = std::max(sums.use, unit["use"].get<double>());
    for (const char* state : kStates) sums.cycles[state] += unit[state].get<double>();
    for (const auto& [name, count] : unit["counters"].items())
      sums.counters[name] = number(sums.counters.value(name, 0.0) + count.get<double>());
  }
  return all;
}

using Kinds = std::vector<std::pair<std::string, KindSums>>;

const KindSums& sums_of(const Kinds& kinds, const std::string& kind) {
  static const KindSums kNone;
  const auto found = std::ranges::find(kinds, kind, [](const auto& entry) { return entry.first; });
  return found == kinds.end() ? kNone : found->second;
}

std::vector<std::string> names(const Kinds& a, const Kinds& b) {
  std::vector<std::string> all;
  for (const Kinds* kinds : {&a, &b})
    for (const auto& [kind, sums] : *kinds)
      if (std::ranges::find(all, kind) == all.end()) all.push_back(kind);
  return all;
}

/// Mean cycles of a unit in each state. Its own time is what it works and waits for itself; what it waits
/// for others only follows from those.
Json units(const Kinds& of_a, const Kinds& of_b) {
  std::vector<Json> all;
  for (const std::string& kind : names(of_a, of_b)) {
    const KindSums &a = sums_of(of_a, kind), &b = sums_of(of_b, kind);
    const auto mean = [](const KindSums& sums, const char* state) {
      const auto found = sums.cycles.find(state);
      return found == sums.cycles.end() ? 0.0 : std::round(found->second / static_cast<double>(sums.units));
    };
    const auto own = [&](const KindSums& sums) { return mean(sums, "busy") + mean(sums, "waiting"); };
    Json entry = {{"kind", kind},
                  {"units", pair(static_cast<double>(a.units), static_cast<double>(b.units))},
                  {"own", pair(own(a), own(b))}};
    for (const char* state : kStates) entry[state] = pair(mean(a, state), mean(b, state));
    entry["use"] = pair(a.use, b.use);
    all.push_back(std::move(entry));
  }
  sort_by(all, "own");
  return all;
}

/// By unit, or link and who waited for it: both paths add up to their frames, so the differences add up to
/// that of the frames.
Json critical_path(const Json& of_a, const Json& of_b) {
  std::map<std::array<std::string, 3>, std::array<double, 2>> sums;
  for (std::size_t side = 0; side < 2; ++side)
    for (const Json& part : (side == 0 ? of_a : of_b)["parts"])
      sums[{part["of"].get<std::string>(), part["part"].get<std::string>(), part["by"].get<std::string>()}]
          [side] += part["cycles"].get<double>();
  std::vector<Json> all;
  all.reserve(sums.size());
  for (const auto& [key, cycles] : sums)
    all.push_back({{"of", key[0]}, {"part", key[1]}, {"by", key[2]}, {"cycles", pair(cycles[0], cycles[1])}});
  sort_by(all, "cycles");
  return all;
}

/// How many times as much the one is as the other, at least 1; counts that appear or vanish come first.
double factor(const Json& entry) {
  const double a = entry["a"].get<double>(), b = entry["b"].get<double>();
  if (a <= 0 || b <= 0) return HUGE_VAL;
  return std::max(a / b, b / a);
}

/// Counters that differ, those first that changed by the greatest factor.
Json counters(const Kinds& of_a, const Kinds& of_b) {
  std::vector<Json> all;
  for (const std::string& kind : names(of_a, of_b)) {
    over_both(sums_of(of_a, kind).counters, sums_of(of_b, kind).counters,
              [&](const std::string& name, const Json& x, const Json& y) {
                if (x == y) return;
                Json entry = {{"kind", kind}, {"name", name}};
                entry.update(pair(x, y));
                all.push_back(std::move(entry));
              });
  }
  std::ranges::stable_sort(all, [](const Json& x, const Json& y) {
    const double of_x = factor(x), of_y = factor(y);
    if (of_x != of_y) return of_x > of_y;
    return std::abs(x["difference"].get<double>()) > std::abs(y["difference"].get<double>());
  });
  return all;
}

Json resources(const Json& a, const Json& b) {
  std::vector<Json> all;
  over_both(a["limit"]["uses"], b["limit"]["uses"],
            [&](const std::string& name, const Json& x, const Json& y) {
              all.push_back({{"name", name}, {"use", pair(x, y)}});
            });
  sort_by(all, "use");
  return all;
}

Json bandwidth(const Json& a, const Json& b) {
  std::vector<Json> all;
  const auto bytes = [](const Json& client) {
    return client.is_object() ? client["read_bytes"].get<double>() + client["write_bytes"].get<double>()
                              : 0.0;
  };
  over_both(a["bandwidth"], b["bandwidth"], [&](const std::string& name, const Json& x, const Json& y) {
    all.push_back({{"client", name}, {"bytes", pair(bytes(x), bytes(y))}});
  });
  sort_by(all, "bytes");
  return all;
}

/// Pairs of draws that are the same one: by their numbers where both frames have the same labels, else by
/// label, in order. A draw that only one frame has stays alone.
std::vector<std::pair<const Json*, const Json*>> matched(const Json& a, const Json& b) {
  std::map<std::string, std::deque<const Json*>> waiting;
  for (const Json& draw : b) waiting[draw["label"].get<std::string>()].push_back(&draw);
  std::vector<std::pair<const Json*, const Json*>> all;
  for (const Json& draw : a) {
    auto& same = waiting[draw["label"].get<std::string>()];
    all.emplace_back(&draw, same.empty() ? nullptr : same.front());
    if (!same.empty()) same.pop_front();
  }
  for (const auto& [label, left] : waiting)
    for (const Json* draw : left) all.emplace_back(nullptr, draw);
  return all;
}

/// A number of a draw, 0 where there is no draw.
Json of_draw(const Json* draw, const char* group, const char* key) {
  if (draw == nullptr) return 0;
  return group == nullptr ? (*draw)[key] : (*draw)[group][key];
}

Json draws(const Json& a, const Json& b) {
  std::vector<Json> all;
  const auto place = [](const Json& list, const Json* draw) {
    return draw == nullptr ? Json(nullptr) : Json(draw - &list[0]);
  };
  const auto limiter = [](const Json* draw) {
    return draw == nullptr ? Json("") : (*draw)["limiter"]["kind"];
  };
  for (const auto& match : matched(a, b)) {
    const Json *x = match.first, *y = match.second;
    const auto both = [&](const char* group, const char* key) {
      return pair(of_draw(x, group, key), of_draw(y, group, key));
    };
    all.push_back({{"label", (*(x != nullptr ? x : y))["label"]},
                   {"number", {{"a", place(a, x)}, {"b", place(b, y)}}},
                   {"cycles", both(nullptr, "cycles_in_flight")},
                   {"least", both("limiter", "work_cycles")},
                   {"shaded", both("fragments", "shaded")},
                   {"memory", both("bytes", "memory")},
                   {"limiter", {{"a", limiter(x)}, {"b", limiter(y)}}}});
  }
  sort_by(all, "cycles");
  return all;
}

double total(const Json& counts) {
  double sum = 0;
  for (const Json& count : counts) sum += count.get<double>();
  return sum;
}

/// Counts by square, where both frames have the same squares.
Json tiles(const Json& a, const Json& b) {
  Json all = {{"width", a["width"]}, {"height", a["height"]}, {"tile_pixels", a["tile_pixels"]}};
  Json counts = Json::object();
  for (const auto& [key, of_a] : a.items()) {
    if (!of_a.is_array() || !b.contains(key) || !b[key].is_array()) continue;
    Json difference = Json::array();
    for (std::size_t i = 0; i < of_a.size(); ++i)
      difference.push_back(pair(of_a[i], b[key][i])["difference"]);
    counts[key] = {{"total", pair(total(of_a), total(b[key]))}, {"squares", std::move(difference)}};
  }
  all["counts"] = std::move(counts);
  return all;
}

bool same_squares(const Json& a, const Json& b) {
  return std::ranges::all_of(std::array{"width", "height", "tile_pixels"},
                             [&](const char* key) { return a[key] == b[key]; });
}

/// What makes the comparison say less than it could.
Json notes(const Json& a, const Json& b) {
  Json all = Json::array();
  if (a["scene"] != b["scene"]) all.push_back("the scenes differ, so draws are paired by their labels alone");
  if (a["frame"]["width"] != b["frame"]["width"] || a["frame"]["height"] != b["frame"]["height"])
    all.push_back("the sizes differ, so squares of the screen are not compared");
  if (a["frame"]["clock_mhz"] != b["frame"]["clock_mhz"])
    all.push_back("the clocks differ: equal cycles are not equal times");
  for (const char* key : {"draws", "tiles"}) {
    if (!a.contains(key) || !b.contains(key))
      all.push_back(fmt::format("a file without --detail {0} has no {0} to compare", key));
  }
  return all;
}

}  // namespace

std::string comparison_json(const FiguresFile& file_a, const FiguresFile& file_b) {
  const Json a = read_figures(file_a.name, file_a.text), b = read_figures(file_b.name, file_b.text);
  const Kinds kinds_a = by_kind(a), kinds_b = by_kind(b);
  Json all = {{"schema", kComparisonSchema},      {"a", subject(file_a.name, a)},
              {"b", subject(file_b.name, b)},     {"notes", notes(a, b)},
              {"parameters", parameters(a, b)},   {"frame", frame(a, b)},
              {"units", units(kinds_a, kinds_b)}, {"resources", resources(a, b)},
              {"bandwidth", bandwidth(a, b)},     {"counters", counters(kinds_a, kinds_b)}};
  if (a.contains("critical_path") && b.contains("critical_path"))
    all["critical_path"] = critical_path(a["critical_path"], b["critical_path"]);
  if (a.contains("draws") && b.contains("draws")) all["draws"] = draws(a["draws"], b["draws"]);
  if (a.contains("tiles") && b.contains("tiles") && same_squares(a["tiles"], b["tiles"]))
    all["tiles"] = tiles(a["tiles"], b["tiles"]);
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::pipeline
