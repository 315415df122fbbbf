#include "studies/why.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "pipeline/render.h"
#include "pipeline/report/limiter.h"
#include "pipeline/report/report.h"
#include "studies/child_run.h"
#include "studies/experiments/experiment.h"
#include "studies/image_hash.h"

namespace quadrille::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLongestRunSeconds = 3600;

/// A run of the frame.
struct Variant {
  std::string about;  ///< for messages and progress
  std::vector<std::pair<std::string, double>> faster;
  std::vector<std::string> settings;  ///< "core.simd_lanes=16"
};

struct RunResult {
  std::int64_t cycles = 0;
  std::string image;  ///< hash of colours and depths
};

/// In the child: its machine is changed.
pipeline::RenderedFrame drawn(const traces::CommandStream& stream, pipeline::MachineConfig& machine,
                              const Variant& variant, const pipeline::DetailOptions& detail = {}) {
  experiments::apply_settings(machine, variant.settings);
  machine.check();
  pipeline::RenderedFrame frame =
      pipeline::render_exact(stream, machine, {.faster = variant.faster}, {}, detail);
  if (!frame.figures.checks_hold())
    throw std::logic_error("the figures contradict each other\n" + pipeline::failed_checks(frame.figures));
  return frame;
}

Json result_json(const pipeline::RenderedFrame& frame) {
  return {{"cycles", frame.figures.frame.cycles}, {"image", image_hash(frame.image)}};
}

/// The machine as it is: its use, and what the report of the run expects.
std::string base_figures(const traces::CommandStream& stream, pipeline::MachineConfig& machine) {
  const pipeline::RenderedFrame frame = drawn(stream, machine, {}, {.path = true});
  Json json = result_json(frame);
  json["limit"] = pipeline::find_limiter(frame.figures).text;
  struct Kind {
    double use = 0, busy = 0, cycles = 0;
  };
  std::map<std::string, Kind> kinds;
  for (const pipeline::UnitFigures& unit : frame.figures.units) {
    Kind& kind = kinds[std::string(pipeline::without_number(unit.path))];
    kind.use = std::max(kind.use, pipeline::use_of(unit));
    kind.busy += static_cast<double>(unit.busy);
    kind.cycles += static_cast<double>(unit.cycles);
  }
  for (const auto& [name, kind] : kinds)
    json["units"][name] = {{"use", kind.use}, {"busy", kind.cycles > 0 ? kind.busy / kind.cycles : 0}};
  const double clock_mhz = frame.figures.frame.clock_mhz;
  json["path"] = pipeline::path_json(*frame.figures.path, clock_mhz).at("parts");
  json["path_table"] = pipeline::path_table(*frame.figures.path, clock_mhz);
  json["gains"] = Json::array();
  for (const pipeline::Gain& gain : pipeline::sensitivity(frame.figures).gains)
    if (gain.share >= pipeline::kLeastNamedGain && json["gains"].size() < pipeline::kNamedGains)
      json["gains"].push_back({{"resource", gain.resource}, {"cycles", gain.cycles}});
  return json.dump();
}

class Measurement {
 public:
  Measurement(const traces::CommandStream& stream, pipeline::MachineConfig& machine,
              const WhySetting& setting)
      : stream_(stream), machine_(machine), setting_(setting) {}

  WhyResult run() {
    setting_.progress("the machine as it is");
    const Json base = Json::parse(output_of(
        run_in_child([&] { return base_figures(stream_, machine_); }, {.seconds = kLongestRunSeconds}),
        stream_.name));
    WhyResult result;
    result.scene = stream_.name;
    result.cycles = base.at("cycles").get<std::int64_t>();
    result.limit = base.at("limit").get<std::string>();
    check_kinds(base);
    result.path = base.at("path").dump();
    result.path_table = base.at("path_table").get<std::string>();
    list_units(base, result);
    list_doubled(base, result);
    const std::vector<RunResult> runs = run_all(base.at("image").get<std::string>());
    fill(runs, result);
    return result;
  }

 private:
  void check_kinds(const Json& base) const {
    for (const std::string& kind : setting_.kinds)
      if (!base.at("units").contains(kind))
        throw user_error("--units: {} needs no {}, so none can be faster", stream_.name, kind);
  }
  void list_units(const Json& base, WhyResult& result) {
    // The clocks of a machine with faster units are equal to a femtosecond; so are those of its ruler.
    variants_.push_back({"equal clocks", {{"command_processor", 1}}, {}});
    for (const std::string_view kind : pipeline::unit_kind_names()) {
      const std::string name(kind);
      const bool wanted =
          setting_.kinds.empty() || std::ranges::find(setting_.kinds, name) != setting_.kinds.end();
      if (!wanted || !base.at("units").contains(name)) continue;
      const Json& unit = base["units"][name];
      result.units.push_back({name,
                              unit.at("use").get<double>(),
                              unit.at("busy").get<double>(),
                              path_cycles(base.at("path"), name),
                              {}});
      for (const double times : kSpeedUps)
        variants_.push_back(
            {fmt::format("{} {:g} times as fast", name, times), {{name, times}}, kept(name, times)});
    }
  }
  /// Of all that gets faster with a kind of units: its own, and the links that it waited for.
  static double path_cycles(const Json& path, const std::string& kind) {
    double cycles = 0;
    for (const Json& part : path)
      if (part.at("by") == kind) cycles += part.at("cycles").get<double>();
    return cycles;
  }
  /// A packer's patience is no work: it stays as long as it is.
  [[nodiscard]] std::vector<std::string> kept(const std::string& kind, double times) const {
    if (kind != pipeline::UnitKind<hw::WarpPacker>::name) return {};
    const hw::Param<int>& patience = machine_.warp_packer.patience_clk;
    const double cycles = std::min(std::round(patience * times), static_cast<double>(patience.range().max));
    return {fmt::format("warp_packer.patience_clk={:.0f}", cycles)};
  }
  void list_doubled(const Json& base, WhyResult& result) {
    for (const Json& gain : base.at("gains")) {
      const auto resource = gain.at("resource").get<std::string>();
      const pipeline::Doubling* doubling = pipeline::doubling_of(resource);
      if (doubling == nullptr) continue;
      const std::vector<std::string> settings = pipeline::settings_of(*doubling, machine_);
      if (settings.empty()) continue;
      result.doubled.push_back({resource, doubling->words, gain.at("cycles").get<double>(), 0});
      variants_.push_back({resource + " doubled", {}, settings});
    }
  }
  std::vector<RunResult> run_all(const std::string& image) const {
    std::vector<ChildWork> works;
    works.reserve(variants_.size());
    for (const Variant& variant : variants_)
      works.push_back({[this, &variant] { return result_json(drawn(stream_, machine_, variant)).dump(); },
                       {.seconds = kLongestRunSeconds}});
    std::vector<RunResult> results(works.size());
    std::size_t done = 0;
    run_in_children(works, setting_.jobs, [&](std::size_t i, const ChildRun& run) {
      const Json json = Json::parse(output_of(run, variants_[i].about));
      results[i] = {json.at("cycles").get<std::int64_t>(), json.at("image").get<std::string>()};
      if (results[i].image != image)
        throw std::runtime_error(fmt::format("{}: another picture than the machine's", variants_[i].about));
      setting_.progress(fmt::format("{} of {} runs: {}", ++done, works.size(), variants_[i].about));
    });
    return results;
  }
  static void fill(const std::vector<RunResult>& runs, WhyResult& result) {
    std::size_t at = 0;
    const std::int64_t ruler = runs[at++].cycles;
    for (FasterUnits& units : result.units)
      for (std::int64_t& gain : units.gain) gain = ruler - runs[at++].cycles;
    for (DoubledResource& doubled : result.doubled) doubled.gain = result.cycles - runs[at++].cycles;
    std::ranges::stable_sort(result.units, std::ranges::greater{},
                             [](const FasterUnits& units) { return units.gain.back(); });
  }

  const traces::CommandStream& stream_;
  pipeline::MachineConfig& machine_;
  const WhySetting& setting_;
  std::vector<Variant> variants_;
};

}  // namespace

WhyResult measure_why(const traces::CommandStream& stream, pipeline::MachineConfig& machine,
                      const WhySetting& setting) {
  return Measurement(stream, machine, setting).run();
}

std::string why_table(const WhyResult& r, const pipeline::MachineConfig& machine) {
  const auto percent = [&](double cycles) { return 100 * cycles / static_cast<double>(r.cycles); };
  const auto gain = [&](std::int64_t cycles) {
    return fmt::format("{:>12}{:>8.1f}", cycles, percent(static_cast<double>(cycles)));
  };
  std::string out = fmt::format(
      "WHY  {}, machine {}: {} cycles\n  {}\n\nFASTER  all units of a kind at once, measured: cycles that "
      "the "
      "frame is shorter, and % of it\n  {:<20}{:>7}{:>8}{:>20}{:>20}{:>20}\n",
      r.scene, machine.title(), r.cycles, r.limit, "unit", "use", "busy", "on the path", "a tenth faster",
      "infinitely fast");
  for (const FasterUnits& units : r.units)
    out += fmt::format("  {:<20}{:>7.1f}{:>8.1f}{:>12.0f}{:>8.1f}{}{}\n", units.kind, 100 * units.use,
                       100 * units.busy, units.path, percent(units.path), gain(units.gain.front()),
                       gain(units.gain.back()));
  out += "\n" + r.path_table;
  if (!r.doubled.empty())
    out +=
        fmt::format("\nDOUBLED  what the report of one run names, and what it gains\n  {:<28}{:>20}{:>20}\n",
                    "resource", "expected", "measured");
  for (const DoubledResource& d : r.doubled)
    out += fmt::format("  {:<28}{:>12.0f}{:>8.1f}{}  {}\n", d.resource, d.expected, percent(d.expected),
                       gain(d.gain), d.words);
  return out;
}

std::string why_json(const WhyResult& r, const pipeline::MachineConfig& machine) {
  Json units = Json::array(), doubled = Json::array();
  for (const FasterUnits& u : r.units)
    units.push_back({{"unit", u.kind},
                     {"use", u.use},
                     {"busy", u.busy},
                     {"path_cycles", u.path},
                     {"tenth_faster_gain_cycles", u.gain.front()},
                     {"infinitely_fast_gain_cycles", u.gain.back()}});
  for (const DoubledResource& d : r.doubled)
    doubled.push_back({{"resource", d.resource},
                       {"doubles", d.words},
                       {"expected_gain_cycles", d.expected},
                       {"gain_cycles", d.gain}});
  const Json document = {{"schema", kWhySchema},
                         {"scene", r.scene},
                         {"machine", Json::parse(pipeline::machine_json(machine))},
                         {"cycles", r.cycles},
                         {"limit", r.limit},
                         {"infinitely_fast_times", kSpeedUps.back()},
                         {"path", Json::parse(r.path)},
                         {"units", std::move(units)},
                         {"doubled", std::move(doubled)}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::studies
