/// Every parameter of the machine, changed by itself: does it do something, and what it declares?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "models/base/error.h"
#include "studies/experiments/experiment.h"
#include "studies/experiments/parameter_effect.h"

namespace quadrille::studies::experiments {
namespace {

/// A parameter that has no effect on a machine that has enough of everything is tried on ones that do not.
struct Ground {
  const char* name;
  std::vector<std::string> settings;
};
const std::vector<Ground>& grounds() {
  static const std::vector<Ground> all{
      {"default", {}},
      {"narrow memory",
       {"gpu.channels=1", "memory.t_burst=8", "memory.t_ccd_s=8", "memory.t_ccd_l=8", "l2.cache_lines=256", "gpu.cores=8"}},
      {"many cores", {"gpu.cores=16", "gpu.channels=4"}}};
  return all;
}

/// More of a resource may not slow a frame by more than this part, and less of it may not make it faster.
constexpr double kWrong = 0.01;
/// A change of less than this part is no effect.
constexpr double kEffect = 0.0005;
/// Anomalies that are listed by name, with their cause.
constexpr std::size_t kListed = 5;
constexpr std::size_t kLongestText = 160;

std::vector<std::string> values_of(const hw::ParamBase& p) {
  std::vector<std::string> values;
  const auto numbers = [&](double value, double least, double most, bool whole) {
    for (const double factor : {0.125, 0.5, 2.0, 8.0}) {
      double other = std::clamp(value == 0 ? (factor > 1 ? factor * 4 : 0) : value * factor, least, most);
      if (whole) other = factor < 1 ? std::floor(other) : std::ceil(other);
      const std::string text = whole ? fmt::format("{:.0f}", other) : fmt::format("{}", other);
      if (other != value && std::ranges::find(values, text) == values.end()) values.push_back(text);
    }
  };
  if (const auto* n = dynamic_cast<const hw::Param<int>*>(&p)) numbers(n->value(), n->range().min, n->range().max, true);
  else if (const auto* d = dynamic_cast<const hw::Param<double>*>(&p)) numbers(d->value(), d->range().min, d->range().max, false);
  else {
    std::string words = p.legal_text() == "true or false" ? "true, false" : p.legal_text();
    for (std::size_t at = 0; at < words.size();) {
      const std::size_t end = std::min(words.find(", ", at), words.size());
      if (const std::string word = words.substr(at, end - at); word != p.value_text()) values.push_back(word);
      at = end + 2;
    }
  }
  return values;
}

struct Change {
  std::string path, value;
  std::size_t ground = 0;
  bool more = false;
};

/// What is wrong with a change; empty if nothing is.
std::string fault(const Change& c, double part) {
  const Effect effect = effect_of(c.path);
  if (effect != Effect::kFaster && effect != Effect::kSlower) return {};
  const bool should_gain = c.more == (effect == Effect::kFaster);
  const bool wrong = should_gain ? part > kWrong : part < -kWrong;
  return wrong ? fmt::format("{:+.1f} %", 100 * part) : std::string();
}

bool refused(std::vector<std::string> settings, const std::string& change) {
  settings.push_back(change);
  try {
    pipeline::MachineConfig machine;
    apply_settings(machine, settings);
    machine.check();
    return false;
  } catch (const UserError&) { return true; }
}

/// More of a number; of a word, on.
bool is_more(const hw::ParamBase& p, const std::string& value) {
  if (p.is_word() || value == "true" || value == "false") return value == "true";
  return std::stod(value) > std::stod(p.value_text());
}

/// All changes of one parameter that the machine takes.
void add_changes(std::vector<Change>& changes, std::size_t ground, const std::string& group, const hw::ParamBase& p) {
  const std::string path = group + "." + std::string(p.name());
  if (effect_of(path) == Effect::kPicture) return;
  for (const std::string& value : values_of(p)) {
    if (!refused(grounds()[ground].settings, fmt::format("{}={}", path, value)))
      changes.push_back({path, value, ground, is_more(p, value)});
  }
}

std::vector<Change> all_changes() {
  std::vector<Change> changes;
  for (std::size_t g = 0; g < grounds().size(); ++g) {
    pipeline::MachineConfig machine;
    apply_settings(machine, grounds()[g].settings);
    for (const auto& [group, params] : machine.groups())
      for (const hw::ParamBase* p : params->params()) add_changes(changes, g, group, *p);
  }
  return changes;
}

}  // namespace

Result parameters(const Setting& setting) {
  std::vector<std::pair<std::string, traces::CommandStream>> streams;
  for (const auto& [name, load] : setting.scenes) streams.emplace_back(name, load());
  const std::vector<Change> changes = all_changes();
  std::vector<Frame> frames;
  for (const Ground& ground : grounds())
    for (const auto& [name, stream] : streams) frames.push_back({&stream, ground.settings});
  const std::size_t bases = frames.size();
  for (const Change& c : changes) {
    for (const auto& [name, stream] : streams) {
      frames.push_back({&stream, grounds()[c.ground].settings});
      frames.back().settings.push_back(fmt::format("{}={}", c.path, c.value));
    }
  }
  const std::vector<Readings> read = draw(frames, setting);
  std::map<std::string, double> greatest;
  std::map<std::string, std::string> faults;
  std::string data;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Change& c = changes[i];
    // The mean of the scenes: a short frame by itself moves by some per cent when any unit acts a cycle later.
    double part = 0, most = 0;
    for (std::size_t s = 0; s < streams.size(); ++s) {
      const double one = read[bases + i * streams.size() + s]["frame.cycles"] / read[c.ground * streams.size() + s]["frame.cycles"] - 1;
      part += one / static_cast<double>(streams.size());
      most = std::max(most, std::abs(one));
    }
    greatest[c.path] = std::max(greatest[c.path], most);
    if (const std::string wrong = fault(c, part); !wrong.empty() && faults[c.path].size() < kLongestText)
      faults[c.path] += fmt::format("{}={} on {}: {}; ", c.path.substr(c.path.rfind('.') + 1), c.value, grounds()[c.ground].name, wrong);
  }
  std::erase_if(faults, [](const auto& f) { return f.second.empty(); });
  Result result;
  result.table.head = {"parameter", "declared", "greatest change of the frame, %", "against what it declares"};
  std::size_t without = 0;
  for (const auto& [path, change] : greatest) {
    const bool none = change < kEffect && effect_of(path) != Effect::kNeutral;
    without += none;
    const auto wrong = faults.find(path);
    result.table.rows.push_back({path, std::string(effect_name(effect_of(path))),
                                 fmt::format("{:.2f}{}", 100 * change, none ? " (none)" : ""), wrong == faults.end() ? "" : wrong->second});
    data += fmt::format("{}\n", std::max(0.01, 100 * change));
  }
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  result.verdicts = {{"parameters that go against what they declare by more than 1 %", count(faults.size()), 0, count(kListed)},
                     {"parameters without any effect", count(without), 0, 0}};
  result.remarks = {fmt::format(
      "{} changes: an eighth, half, twice and eight times of each number, every other word of each choice, one at a time, on {} machines.",
      changes.size(), grounds().size())};
  result.plot =
      "set logscale y\nset ylabel 'greatest change, % of the frame'\nset xlabel 'parameters, in the order of the table'\nset grid y\nset "
      "key off\n$d << EOD\n" +
      data + "EOD\nplot $d using 0:1 with impulses lw 2";
  return result;
}

}  // namespace quadrille::studies::experiments
