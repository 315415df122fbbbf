#include "studies/leave_out.h"

#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "pipeline/driver/host_cost.h"
#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "studies/child_run.h"
#include "studies/image_hash.h"

namespace quadrille::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLongestRunSeconds = 3600;

/// In the child: the whole way from the file to the figures, as one line of JSON.
std::string run_once(const LeaveOutScene& scene, const pipeline::MachineConfig& machine, bool leave_out) {
  const double start = pipeline::cpu_seconds();
  const LoadedScene scene_read = scene.load(leave_out);
  const double loaded = pipeline::cpu_seconds();
  const pipeline::RenderedFrame frame =
      pipeline::render_exact(scene_read.stream, machine, {.leave_out = leave_out});
  const double end = pipeline::cpu_seconds();
  if (!frame.figures.checks_hold())
    throw std::logic_error("the figures contradict each other\n" + pipeline::failed_checks(frame.figures));
  Json figures =
      Json::parse(pipeline::report_json({frame.figures, machine, frame.image.width, frame.image.height}));
  Json left_out = Json::array();
  for (const pipeline::LeftOut& l : scene_read.left_out)
    left_out.push_back({{"what", l.what}, {"why", l.why}, {"saved", l.saved}});
  for (const Json& l : figures.at("left_out")) left_out.push_back(l);
  for (const char* key : {"host", "left_out", "machine", "counter_definitions", "scene"}) figures.erase(key);
  const double simulate = frame.figures.host.simulate_cpu_s;
  return Json{{"load_s", loaded - start},
              {"build_s", end - loaded - simulate},
              {"simulate_s", simulate},
              {"cycles", frame.figures.frame.cycles},
              {"image", image_hash(frame.image)},
              {"figures", figures.dump()},
              {"left_out", left_out}}
      .dump();
}

LeaveOutRun parsed(const std::string& output, const ChildRun& child) {
  const Json json = Json::parse(output);
  LeaveOutRun run;
  run.load_s = json.at("load_s").get<double>();
  run.build_s = json.at("build_s").get<double>();
  run.simulate_s = json.at("simulate_s").get<double>();
  run.total_s = child.cpu_s;
  run.peak_rss_mib = child.peak_rss_mib;
  run.cycles = json.at("cycles").get<std::int64_t>();
  run.image = json.at("image").get<std::string>();
  run.figures = json.at("figures").get<std::string>();
  for (const Json& l : json.at("left_out"))
    run.left_out.push_back(
        {l.at("what").get<std::string>(), l.at("why").get<std::string>(), l.at("saved").get<std::string>()});
  return run;
}

LeaveOutRun run_in_process(const LeaveOutScene& scene, const pipeline::MachineConfig& machine,
                           bool leave_out) {
  const ChildRun child =
      run_in_child([&] { return run_once(scene, machine, leave_out); }, {.seconds = kLongestRunSeconds});
  return parsed(output_of(child, scene.name), child);
}

std::uint64_t work_of(const Json& unit) {
  std::uint64_t sum = unit.at("busy").get<std::uint64_t>();
  for (const auto& [name, value] : unit.at("counters").items()) sum += value.get<std::uint64_t>();
  return sum;
}

/// Ports of an L2 slice are numbered by client, and the complete machine has more of them.
Json without_port_numbers(Json unit) {
  unit.erase("waits");
  return unit;
}

std::string unit_disagreement(const Json& complete, const Json& reduced) {
  for (const auto& [path, unit] : complete.items()) {
    const auto other = reduced.find(path);
    if (other == reduced.end()) {
      if (work_of(unit) != 0) return fmt::format("{} was left out but works", path);
    } else if (without_port_numbers(*other) != without_port_numbers(unit)) {
      return fmt::format("{} has other cycles or counts", path);
    }
  }
  for (const auto& [path, unit] : reduced.items()) {
    if (!complete.contains(path)) return fmt::format("{} is only there when units are left out", path);
  }
  return "";
}

std::string bandwidth_disagreement(const Json& complete, const Json& reduced) {
  for (const auto& [client, bytes] : complete.items()) {
    const auto other = reduced.find(client);
    const bool same = other == reduced.end() ? bytes.at("read_bytes") == 0 && bytes.at("write_bytes") == 0
                                             : *other == bytes;
    if (!same) return fmt::format("{} moved other bytes", client);
  }
  return "";
}

Spread spread_over(const std::vector<LeaveOutRun>& runs, double LeaveOutRun::*member) {
  std::vector<double> sample;
  sample.reserve(runs.size());
  for (const LeaveOutRun& run : runs) sample.push_back(run.*member);
  return spread_of(sample);
}

}  // namespace

std::string disagreement(const LeaveOutRun& complete, const LeaveOutRun& reduced) {
  if (complete.image != reduced.image) return "the pictures differ";
  if (complete.cycles != reduced.cycles)
    return fmt::format("{} cycles with everything, {} with less", complete.cycles, reduced.cycles);
  const Json a = Json::parse(complete.figures), b = Json::parse(reduced.figures);
  if (a.at("frame") != b.at("frame")) return "the frame's figures differ";
  if (std::string units = unit_disagreement(a.at("units"), b.at("units")); !units.empty()) return units;
  return bandwidth_disagreement(a.at("bandwidth"), b.at("bandwidth"));
}

LeaveOutResult measure_leave_out(const LeaveOutScene& scene, const pipeline::MachineConfig& machine,
                                 int repeat, const std::function<void(const std::string&)>& progress) {
  LeaveOutResult result;
  result.name = scene.name;
  for (int round = 0; round < repeat; ++round) {
    for (const std::size_t side :
         round_order(2, static_cast<std::size_t>(round), static_cast<std::size_t>(repeat))) {
      if (progress)
        progress(fmt::format("{}: run {} of {}, {}", scene.name, round + 1, repeat,
                             side == 0 ? "everything" : "what is needed"));
      (side == 0 ? result.everything : result.needed).push_back(run_in_process(scene, machine, side == 1));
    }
    if (result.contradiction.empty())
      result.contradiction = disagreement(result.everything.back(), result.needed.back());
  }
  result.everything_s = spread_over(result.everything, &LeaveOutRun::total_s);
  result.needed_s = spread_over(result.needed, &LeaveOutRun::total_s);
  result.everything_simulate_s = spread_over(result.everything, &LeaveOutRun::simulate_s);
  result.needed_simulate_s = spread_over(result.needed, &LeaveOutRun::simulate_s);
  result.everything_mib = spread_over(result.everything, &LeaveOutRun::peak_rss_mib);
  result.needed_mib = spread_over(result.needed, &LeaveOutRun::peak_rss_mib);
  return result;
}

std::string leave_out_table(const std::vector<LeaveOutResult>& results,
                            const pipeline::MachineConfig& machine) {
  std::string out = fmt::format(
      "LEAVE OUT  machine {}, {} runs of each side; processor time of the whole process, medians and half "
      "the distance between "
      "quartiles\n\n",
      machine.title(), results.front().everything.size());
  out += fmt::format("  {:<34} {:>11} {:>15} {:>15} {:>9} {:>7} {:>7} {:>8}  {}\n", "scene", "cycles",
                     "everything s", "needed s", "speed-up", "in run", "MiB", "needed",
                     "same picture, cycles and counts");
  for (const LeaveOutResult& r : results) {
    const auto seconds = [](const Spread& s) {
      return fmt::format("{:.3f} +-{:.3f}", s.median, 0.5 * (s.upper_quartile - s.lower_quartile));
    };
    out += fmt::format("  {:<34} {:>11} {:>15} {:>15} {:>8.2f}x {:>6.2f}x {:>7.0f} {:>8.0f}  {}{}\n", r.name,
                       r.needed.front().cycles, seconds(r.everything_s), seconds(r.needed_s), r.speed_up(),
                       r.everything_simulate_s.median / r.needed_simulate_s.median, r.everything_mib.median,
                       r.needed_mib.median, r.contradiction.empty() ? "yes" : "NO: " + r.contradiction,
                       r.slower() ? ", SLOWER" : "");
    for (const pipeline::LeftOut& l : r.needed.front().left_out)
      out += fmt::format("      {}: {} ({})\n", l.what, l.why, l.saved);
  }
  return out +
         "\n  in run: the same ratio for the simulation alone, without loading, compiling and elaborating\n";
}

std::string leave_out_json(const std::vector<LeaveOutResult>& results,
                           const pipeline::MachineConfig& machine) {
  const auto runs_json = [](const std::vector<LeaveOutRun>& runs) {
    Json all = Json::array();
    for (const LeaveOutRun& r : runs) {
      all.push_back({{"load_s", r.load_s},
                     {"build_s", r.build_s},
                     {"simulate_s", r.simulate_s},
                     {"total_s", r.total_s},
                     {"peak_rss_mib", r.peak_rss_mib}});
    }
    return all;
  };
  Json scenes = Json::array();
  for (const LeaveOutResult& r : results) {
    Json left_out = Json::array();
    for (const pipeline::LeftOut& l : r.needed.front().left_out)
      left_out.push_back({{"what", l.what}, {"why", l.why}, {"saved", l.saved}});
    scenes.push_back({{"scene", r.name},
                      {"cycles", r.needed.front().cycles},
                      {"agrees", r.contradiction.empty()},
                      {"contradiction", r.contradiction},
                      {"speed_up", r.speed_up()},
                      {"everything", runs_json(r.everything)},
                      {"needed", runs_json(r.needed)},
                      {"left_out", std::move(left_out)}});
  }
  const Json document{{"schema", kLeaveOutSchema},
                      {"machine", Json::parse(pipeline::machine_json(machine))},
                      {"scenes", std::move(scenes)}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::studies
