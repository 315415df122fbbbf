/// `quadrille why`: what a frame would gain if each kind of unit were faster, measured.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/machine_arguments.h"
#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "studies/why.h"

namespace quadrille::cli {
namespace {

constexpr std::int64_t kMostJobs = 1024;

struct WhyArguments {
  SceneArguments scene;
  MachineArguments machine;
  std::vector<std::string> units;
  std::optional<std::string> jobs, json;
};

int run_why(const WhyArguments& a) {
  studies::WhySetting setting;
  setting.jobs = static_cast<int>(a.jobs ? parse_whole(*a.jobs, "--jobs", 1, kMostJobs)
                                         : std::max(1u, std::thread::hardware_concurrency()));
  for (const std::string& kind : a.units) check_unit_kind("--units", kind);
  setting.kinds = a.units;
  a.scene.check();
  pipeline::MachineConfig machine;
  a.machine.apply(machine);
  if (a.json) check_json_output("--json", *a.json);
  Progress progress;
  setting.progress = [&](const std::string& what) { progress.show(what); };
  progress.show(fmt::format("loading {}", a.scene.scene));
  const SceneArguments::Loaded loaded = a.scene.load();
  const studies::WhyResult result = studies::measure_why(loaded.stream, machine, setting);
  progress.clear();
  Tables(true, a.json).print(studies::why_table(result, machine));
  if (a.json) write_text(*a.json, studies::why_json(result, machine));
  return kDone;
}

}  // namespace

void add_why(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "why", "Draws a frame again with each kind of unit faster: where its time would go.");
  const auto a = std::make_shared<WhyArguments>();
  a->scene.add_to(*command);
  a->machine.add_to(*command);
  command->add_option("--units", a->units, "these kinds of units alone, with commas between them; else all")
      ->type_name("UNIT,...")
      ->delimiter(',');
  command->add_option("--jobs", a->jobs, "runs at a time; else as many as the host has cores")
      ->type_name("N");
  command
      ->add_option("--json", a->json,
                   "writes all that was measured as JSON (docs/why.md); - is standard output")
      ->type_name("F.json|-");
  command->footer(
      R"(Every run is a process of its own; all must draw the same picture. Two runs for each kind of unit.
Examples:
  quadrille why builtin:cubes --size 320x180
  quadrille why helmet.gltf --units core,texture,l2,memory
      four kinds alone, in a quarter of the time
  quadrille why city.gltf --machine small --json why.json)");
  command->callback([a, &chosen] { chosen = [a] { return run_why(*a); }; });
}

}  // namespace quadrille::cli
