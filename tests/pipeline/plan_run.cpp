#include "tests/pipeline/plan_run.h"

#include "pipeline/driver/draw_culling.h"
#include "pipeline/machine/machine.h"
#include "pipeline/report/figures.h"
#include "pipeline/report/report.h"
#include "scenes/scene.h"
#include "tests/hw/base/strict_driver.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

#include <optional>
#include <sstream>

namespace quadrille::pipeline::test {

namespace {

std::string run_here(const Settings& settings, bool strict, const traces::CommandStream& stream) {
  MachineConfig config;
  config.triangle_setup.triangle_slots.set(8);
  for (const auto& [key, value] : settings) config.set(key, value, "test");
  DeviceFrame frame(std::uint64_t{1} << 30);
  build_frame(stream, config.precision(), frame, true, {{}, config.texture.layout});
  if (config.command_processor.cull_draws) find_draws_outside(frame.frame, frame.memory);
  std::optional<hw::StrictDriver> driver;
  MachineOptions options;
  if (strict) options.external_driver = &driver.emplace("strict_driver");
  Machine machine(config, frame, options);
  machine.run({});
  std::string text = fmt::format("digest {}\nactions {}\ncycles {}\n", image_digest(frame),
                                 machine.driver().actions(), machine.clock().edges_before(machine.end()));
  for (std::size_t i = 0; i < machine.links().size(); ++i)
    text += fmt::format("tokens {} {}\n", machine.link_keys()[i], machine.links()[i]->pushes());
  for (const hw::Unit* unit : machine.units())
    text += fmt::format("acted {} {}\n", without_number(unit->name()), unit->actions());
  for (const Check& check : collect_figures(machine, frame).checks)
    if (!check.holds()) text += fmt::format("broken {}\n", check.law);
  if (driver)
    for (const std::string& violation : driver->violations()) text += fmt::format("broken {}\n", violation);
  return text;
}

void read_line(const std::string& line, PlanRun& run) {
  std::istringstream words(line);
  std::string what, name;
  std::uint64_t number = 0;
  words >> what;
  if (what == "broken") {
    run.broken.push_back(line.substr(what.size() + 1));
  } else if (what == "tokens" || what == "acted") {
    words >> name >> number;
    (what == "tokens" ? run.tokens : run.acted)[name] += number;
  } else {
    words >> number;
    if (what == "digest") run.digest = number;
    if (what == "actions") run.actions = number;
    if (what == "cycles") run.cycles = static_cast<std::int64_t>(number);
  }
}

}  // namespace

const traces::CommandStream& plan_frame() {
  static const traces::CommandStream stream = [] {
    traces::CommandStream made = random_stream(5, {48, 40, 8, 5});
    add_storage_draw(made);
    return made;
  }();
  return stream;
}

PlanRun run_plan(const Settings& settings, bool strict, const traces::CommandStream& stream) {
  const std::string text = hw::contract::in_child([&] { return run_here(settings, strict, stream); });
  PlanRun run;
  if (!text.starts_with("digest")) {
    run.failure = text.empty() ? "ended without a word" : text;
    return run;
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) read_line(line, run);
  return run;
}

std::string faults_on(const Settings& settings, const traces::CommandStream& stream) {
  const PlanRun run = run_plan(settings, false, stream);
  std::string faults = run.failure;
  for (const std::string& law : run.broken) faults += law + '\n';
  if (faults.empty() && run.digest != functional_digest(stream)) faults = "another picture";
  return faults;
}

traces::CommandStream small_scene(const char* name) {
  scenes::SceneOptions options;
  options.width = 96;
  options.height = 54;
  traces::CommandStream stream = scenes::load_scene(name, options);
  traces::validate(stream);
  return stream;
}

}  // namespace quadrille::pipeline::test
