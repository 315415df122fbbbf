#include "pipeline/report/limiter.h"

#include "pipeline/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace quadrille::pipeline {

namespace {

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

std::string kind_of(std::string_view path) { return std::string(without_number(path)); }

/// A wait of all units of a kind together.
struct KindWait {
  std::int64_t cycles = 0;
  bool input = true;
  const LinkFigures* link = nullptr;  ///< one of its class: the one waited for longest
  std::int64_t longest = 0;
};

/// Units of a kind: what they did with their cycles, and whom they waited for (by class of link and
/// direction).
struct Kind {
  std::int64_t cycles = 0, busy = 0;
  /// by key of the link and kind of the other end
  std::map<std::pair<std::string, std::string>, KindWait> waits;
};

class Graph {
 public:
  explicit Graph(const Figures& figures) {
    std::map<std::string_view, const LinkFigures*> links;
    for (const LinkFigures& link : figures.links) links.emplace(link.path, &link);
    for (const UnitFigures& unit : figures.units) {
      Kind& kind = kinds_[kind_of(unit.path)];
      kind.cycles += unit.cycles;
      kind.busy += unit.busy + unit.waiting;
      for (const WaitFigure& wait : unit.waits) {
        const auto found = links.find(wait.link);
        if (found == links.end()) continue;
        const LinkFigures& link = *found->second;
        KindWait& sum = kind.waits[{link.key, kind_of(wait.input ? link.producer : link.consumer)}];
        sum.cycles += wait.cycles;
        sum.input = wait.input;
        if (wait.cycles > sum.longest) sum.link = &link;
        sum.longest = std::max(sum.longest, wait.cycles);
      }
    }
  }
  [[nodiscard]] const std::map<std::string, Kind>& kinds() const { return kinds_; }
  [[nodiscard]] const Kind* find(const std::string& name) const {
    const auto found = kinds_.find(name);
    return found == kinds_.end() ? nullptr : &found->second;
  }

 private:
  std::map<std::string, Kind> kinds_;
};

std::string arrows(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " <- ") + name;
  return text;
}

/// The part of the frame's time that comes after the last pass was flushed: nothing but scan-out works then.
double scan_part(const FrameFigures& frame) {
  return share(frame.cycles - frame.render_cycles, frame.cycles);
}

/// The walk where the command processor waited longer for scan-out than for anything else. It ends there:
/// what units that serve others too waited for was mostly for those.
Limiter scanning(const Graph& graph, double part) {
  Limiter limiter;
  limiter.kind = Limiter::Kind::kWork;
  limiter.name = "scan_out";
  limiter.share = part;
  limiter.walk = {"command_processor", "scan_out"};
  limiter.loop = limiter.walk.size();
  limiter.text = fmt::format("scan-out: {:.1f} % of the frame, after all passes were flushed", 100 * part);
  const Kind* const unit = graph.find("scan_out");
  if (unit == nullptr) return limiter;
  limiter.text += fmt::format("; busy {:.1f} %", 100 * share(unit->busy, unit->cycles));
  std::map<std::string, std::int64_t> waits;
  for (const auto& [end, wait] : unit->waits) {
    // that one was waited for while the passes were drawn
    if (end.second != "command_processor") waits[end.second] += wait.cycles;
  }
  const auto longest = std::ranges::max_element(waits, {}, [](const auto& w) { return w.second; });
  if (longest != waits.end())
    limiter.text +=
        fmt::format(", waits for {} {:.1f} %", longest->first, 100 * share(longest->second, unit->cycles));
  return limiter;
}

/// The walk of longest waits from the command processor.
Limiter walk(const Graph& graph, double scan_part) {
  Limiter limiter;
  std::vector<const KindWait*> steps;  // steps[i] leads from walk[i] to the next
  std::string at = "command_processor";
  while (true) {
    const Kind* const kind = graph.find(at);
    if (kind == nullptr) break;
    limiter.walk.push_back(at);
    // Scan-out works once all passes are flushed: nothing but the command processor has waited for it.
    const auto weight = [&](const auto& w) {
      return w.first.second == "scan_out" && at != "command_processor" ? 0 : w.second.cycles;
    };
    const auto longest = std::ranges::max_element(kind->waits, {}, weight);
    if (longest == kind->waits.end() || weight(*longest) <= kind->busy) {
      limiter.kind = Limiter::Kind::kWork;
      limiter.name = at;
      limiter.share = share(kind->busy, kind->cycles);
      limiter.loop = limiter.walk.size();
      limiter.text = fmt::format("work of {}, one at a time: busy {:.1f} %; waits {}", at,
                                 100 * limiter.share, arrows(limiter.walk));
      return limiter;
    }
    if (longest->first.second == "scan_out") return scanning(graph, scan_part);
    limiter.share = share(longest->second.cycles, kind->cycles);
    steps.push_back(&longest->second);
    at = longest->first.second;
    const auto seen = std::ranges::find(limiter.walk, at);
    if (seen == limiter.walk.end()) continue;
    limiter.loop = static_cast<std::size_t>(seen - limiter.walk.begin());
    break;
  }
  if (steps.empty()) return limiter;
  limiter.kind = Limiter::Kind::kLatency;
  const auto delay = [](const KindWait* step) {
    return step->input ? step->link->latency : step->link->credit_latency;
  };
  const auto slowest = *std::ranges::max_element(
      steps.begin() + static_cast<std::ptrdiff_t>(std::min(limiter.loop, steps.size() - 1)), steps.end(), {},
      delay);
  limiter.name = slowest->link->key;
  const std::vector<std::string> around(limiter.walk.begin() + static_cast<std::ptrdiff_t>(limiter.loop),
                                        limiter.walk.end());
  limiter.text = fmt::format("latency around {} <- {}: the longest link of the loop is {}, {} clk; waits {}",
                             arrows(around), at, slowest->link->key, delay(slowest), arrows(limiter.walk));
  return limiter;
}

}  // namespace

const char* limiter_kind_name(Limiter::Kind kind) {
  switch (kind) {
    case Limiter::Kind::kNothing: return "nothing";
    case Limiter::Kind::kUnit: return "unit";
    case Limiter::Kind::kPlaces: return "places";
    case Limiter::Kind::kLink: return "link";
    case Limiter::Kind::kWork: return "work";
    case Limiter::Kind::kLatency: return "latency";
  }
  return "";
}

namespace {

/// "core.issue 38 % (plain and special lanes of the SIMDs)".
std::string gain_text(const Gain& gain) {
  const Doubling* doubling = doubling_of(gain.resource);
  const std::string words = doubling != nullptr                  ? doubling->words
                            : gain.resource.starts_with("link.") ? "depth and width"
                                                                 : "no parameter";
  return fmt::format("{} {:.0f} % ({})", gain.resource, 100 * gain.share, words);
}

}  // namespace

Limiter find_limiter(const Figures& figures) {
  if (figures.units.empty()) return {};
  const Sensitivity s = sensitivity(figures);
  if (s.gains.empty() || s.gains.front().share < kLeastGain)
    return walk(Graph(figures), scan_part(figures.frame));
  Limiter limiter;
  const Gain& first = s.gains.front();
  const auto places = std::ranges::find_if(
      s.uses, [&](const ResourceUse& use) { return use.places && use.name == first.resource; });
  const bool link = first.resource.starts_with("link.");
  limiter.kind = link                     ? Limiter::Kind::kLink
                 : places != s.uses.end() ? Limiter::Kind::kPlaces
                                          : Limiter::Kind::kUnit;
  limiter.resource = first.resource;
  limiter.name = link ? first.resource : first.resource.substr(0, first.resource.find('.'));
  limiter.share = first.share;
  limiter.text = "twice as much of this is expected to save, of the frame: ";
  for (std::size_t i = 0; i < s.gains.size() && i < kNamedGains; ++i) {
    if (s.gains[i].share < kLeastNamedGain) break;
    limiter.text += (i > 0 ? ", " : "") + gain_text(s.gains[i]);
  }
  if (s.waiting >= kLeastGain)
    limiter.text += fmt::format("; waiting that none of it explains {:.0f} %", 100 * s.waiting);
  return limiter;
}

}  // namespace quadrille::pipeline
