#include "studies/timed_run.h"

#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "pipeline/report/report.h"
#include "studies/child_run.h"

namespace quadrille::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLongestRunSeconds = 3600;

Json cost_json(const MachineCost& cost) {
  Json units = Json::array(), clients = Json::array();
  for (const UnitBusy& u : cost.units) units.push_back({u.path, u.percent});
  for (const ClientBytes& c : cost.clients) clients.push_back({c.name, c.bytes});
  return {
      {"cycles", cost.cycles}, {"memory_bytes", cost.memory_bytes}, {"units", units}, {"clients", clients}};
}

MachineCost cost_of(const Json& json) {
  MachineCost cost;
  cost.cycles = json.at("cycles").get<std::int64_t>();
  cost.memory_bytes = json.at("memory_bytes").get<std::uint64_t>();
  for (const Json& u : json.at("units"))
    cost.units.push_back({u.at(0).get<std::string>(), u.at(1).get<double>()});
  for (const Json& c : json.at("clients"))
    cost.clients.push_back({c.at(0).get<std::string>(), c.at(1).get<std::uint64_t>()});
  return cost;
}

/// In the child: a line of JSON, then the pixels.
std::string rendered(const traces::CommandStream& stream, const pipeline::MachineConfig& machine,
                     const RunSetting& setting) {
  pipeline::RenderedFrame frame;
  if (setting.window) {
    const hw::Clock clock(static_cast<std::int64_t>(machine.gpu.clock_mhz * 1e6));
    frame = pipeline::render_exact(stream, machine, {.window = clock.edge(*setting.window)});
  } else {
    frame = pipeline::render_functional_frame(stream, setting.precision);
  }
  if (!frame.figures.checks_hold())
    throw std::logic_error("the figures contradict each other\n" + pipeline::failed_checks(frame.figures));
  const Json json{{"cpu_s", frame.figures.host.simulate_cpu_s},
                  {"wall_s", frame.figures.host.simulate_s},
                  {"width", frame.image.width},
                  {"height", frame.image.height},
                  {"cost", setting.window ? cost_json(machine_cost(frame.figures)) : Json(nullptr)}};
  std::string out = json.dump() + "\n";
  out.append(reinterpret_cast<const char*>(frame.image.color.data()),
             frame.image.color.size() * sizeof(std::uint32_t));
  return out;
}

TimedRun parsed(const std::string& text) {
  const std::size_t end = text.find('\n');
  const Json json = Json::parse(text.substr(0, end));
  TimedRun run;
  run.cpu_s = json.at("cpu_s").get<double>();
  run.wall_s = json.at("wall_s").get<double>();
  run.width = json.at("width").get<std::uint32_t>();
  run.height = json.at("height").get<std::uint32_t>();
  if (!json.at("cost").is_null()) run.cost = cost_of(json.at("cost"));
  run.color.resize((text.size() - end - 1) / sizeof(std::uint32_t));
  std::memcpy(run.color.data(), text.data() + end + 1, run.color.size() * sizeof(std::uint32_t));
  return run;
}

}  // namespace

std::string RunSetting::name() const {
  if (!window) return "functional";
  return *window == 0 ? "exact" : fmt::format("window {}", *window);
}

MachineCost machine_cost(const pipeline::Figures& figures) {
  MachineCost cost;
  cost.cycles = figures.frame.cycles;
  cost.memory_bytes = pipeline::memory_bytes(figures);
  for (const pipeline::UnitFigures& u : figures.units) {
    cost.units.push_back({u.path, u.cycles > 0 ? 100.0 * static_cast<double>(u.busy + u.waiting) /
                                                     static_cast<double>(u.cycles)
                                               : 0.0});
  }
  for (const pipeline::ClientFigures& c : figures.bandwidth)
    cost.clients.push_back({c.name, c.read_bytes + c.write_bytes});
  return cost;
}

TimedRun run_timed(const traces::CommandStream& stream, const pipeline::MachineConfig& machine,
                   const RunSetting& setting) {
  const ChildRun child =
      run_in_child([&] { return rendered(stream, machine, setting); }, {.seconds = kLongestRunSeconds});
  return parsed(output_of(child, fmt::format("{}: {}", stream.name, setting.name())));
}

}  // namespace quadrille::studies
