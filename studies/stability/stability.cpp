#include "studies/stability/stability.h"

#include <fnmatch.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "models/base/near_name.h"
#include "pipeline/report/limiter.h"

namespace quadrille::studies::stability {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kPictureSide = 256, kLeastSide = 64;

template <class T>
std::uint64_t different(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    count += std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i]) ? 1 : 0;
  return count;
}

/// Pixels outside every scissor that do not hold the clear colour of the functional run's corner pixel.
std::uint64_t outside_touched(const Observed& o) {
  const DrawnArea area = drawn_area(o.stream);
  const pipeline::FrameImage& image = o.image();
  if (image.color.empty() || area.holds(0, 0)) return 0;
  std::uint64_t count = 0;
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x)
      count += !area.holds(x, y) && o.pixel(x, y) != o.pixel(0, 0) ? 1 : 0;
  }
  return count;
}

std::uint64_t unbalanced_units(const pipeline::Figures& figures) {
  return static_cast<std::uint64_t>(std::ranges::count_if(figures.units, [](const pipeline::UnitFigures& u) {
    return u.busy + u.waiting + u.starved + u.blocked + u.idle != u.cycles;
  }));
}

std::uint64_t negative_accounts(const pipeline::Figures& figures) {
  return static_cast<std::uint64_t>(std::ranges::count_if(figures.units, [](const pipeline::UnitFigures& u) {
    return std::min({u.busy, u.waiting, u.starved, u.blocked, u.idle}) < 0;
  }));
}

/// What the child hands back: a line of JSON, then the picture's bytes.
std::string packed(const Observed& o, const Findings& findings, const scenes::Rgba8Image& picture) {
  Json all = Json::array();
  for (const Finding& f : findings.all())
    all.push_back({{"what", f.what}, {"measured", f.measured}, {"bound", f.bound}, {"holds", f.holds}});
  const Json head{{"findings", all},
                  {"width", o.image().width},
                  {"height", o.image().height},
                  {"cycles", o.exact.figures.frame.cycles},
                  {"limit", pipeline::find_limiter(o.exact.figures).text},
                  {"picture", {picture.width, picture.height}}};
  std::string bytes = head.dump() + "\n";
  bytes.append(reinterpret_cast<const char*>(picture.pixels.data()), picture.pixels.size());
  return bytes;
}

CaseResult unpacked(const Case& one, const ChildRun& run) {
  CaseResult result;
  result.about = &one;
  result.run = run;
  if (run.end != ChildEnd::kDone) return result;
  const std::size_t line = run.output.find('\n');
  const Json head = Json::parse(run.output.substr(0, line));
  for (const Json& f : head["findings"])
    result.findings.add({f["what"], f["measured"], f["bound"], f["holds"]});
  result.width = head["width"];
  result.height = head["height"];
  result.cycles = head["cycles"];
  result.limit = head["limit"];
  result.picture = {head["picture"][0], head["picture"][1], {}};
  result.picture.pixels.assign(run.output.begin() + static_cast<std::ptrdiff_t>(line) + 1, run.output.end());
  result.run.output.clear();
  result.findings.at_most("memory", run.peak_rss_mib, one.memory_mib, "MiB");
  return result;
}

}  // namespace

void check_always(const Observed& o, Findings& findings) {
  const pipeline::Figures& figures = o.exact.figures;
  findings.equal("pixels unlike the functional image",
                 different(o.exact.image.color, o.functional.image.color), 0);
  findings.equal("depths unlike the functional ones",
                 different(o.exact.image.depth, o.functional.image.depth), 0);
  findings.equal("laws that hold",
                 static_cast<std::uint64_t>(std::ranges::count_if(figures.checks, &pipeline::Check::holds)),
                 figures.checks.size());
  findings.equal("units whose cycles do not add up", unbalanced_units(figures) + negative_accounts(figures),
                 0);
  findings.equal("pixels touched outside the scissor", outside_touched(o), 0);
  const double cycles = std::max(1.0, static_cast<double>(figures.frame.cycles));
  findings.at_most("greatest use of a unit or link", 100 * pipeline::speed_of_light(figures).cycles / cycles,
                   100, "%");
}

const std::vector<Case>& catalogue() {
  static const std::vector<Case> all = [] {
    std::vector<Case> cases;
    add_edge_cases(cases);
    add_range_cases(cases);
    add_value_cases(cases);
    add_format_cases(cases);
    add_target_cases(cases);
    add_machine_cases(cases);
    return cases;
  }();
  return all;
}

std::vector<const Case*> select(std::span<const std::string> patterns) {
  std::vector<const Case*> chosen;
  for (const Case& one : catalogue()) {
    const auto matches = [&](const std::string& pattern) {
      return fnmatch(pattern.c_str(), one.name.c_str(), 0) == 0;
    };
    if (patterns.empty() || std::ranges::any_of(patterns, matches)) chosen.push_back(&one);
  }
  for (const std::string& pattern : patterns) {
    const auto matches = [&](const Case* one) { return fnmatch(pattern.c_str(), one->name.c_str(), 0) == 0; };
    if (std::ranges::any_of(chosen, matches)) continue;
    std::vector<std::string> names;
    for (const Case& one : catalogue()) names.push_back(one.name);
    throw user_error("stability: no case matches '{}'; --list prints their names{}", pattern,
                     did_you_mean(pattern, names));
  }
  return chosen;
}

std::string run_here(const Case& one) {
  auto machine = std::make_unique<pipeline::MachineConfig>();
  one.machine(*machine);
  const Observed o = observe(one.build(), std::move(machine));
  Findings findings;
  check_always(o, findings);
  one.check(o, findings);
  return packed(o, findings, enlarged(reduced(one.picture(o), kPictureSide), kLeastSide));
}

std::vector<CaseResult> run_cases(std::span<const Case* const> cases, int jobs,
                                  const std::function<void(const CaseResult&)>& done) {
  std::vector<CaseResult> results(cases.size());
  std::vector<ChildWork> works;
  for (const Case* one : cases) works.push_back({[one] { return run_here(*one); }, {one->seconds, 0}});
  run_in_children(works, jobs, [&](std::size_t i, const ChildRun& run) {
    results[i] = unpacked(*cases[i], run);
    done(results[i]);
  });
  return results;
}

}  // namespace quadrille::studies::stability
