/// `quadrille leave-out`: what leaving out saves, and that it changes nothing else.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/machine_arguments.h"
#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "studies/leave_out.h"

namespace quadrille::cli {
namespace {

constexpr const char* kDefaultSize = "480x270";  // every scene twice, several times each
constexpr std::int64_t kMaxRepeat = 1000;

struct LeaveOutArguments {
  std::vector<std::string> scenes;
  SceneArguments view;
  MachineArguments machine;
  std::string repeat = "5";
  std::optional<std::string> json;
};

int run_leave_out(const LeaveOutArguments& a) {
  const auto repeat = static_cast<int>(parse_whole(a.repeat, "--repeat", 1, kMaxRepeat));
  std::vector<SceneArguments> all;
  for (const std::string& scene : a.scenes) {
    SceneArguments& one = all.emplace_back(a.view);
    one.scene = scene;
    one.check();
    one.check_there();
    if (!one.is_trace() && !one.size) one.size = kDefaultSize;
  }
  pipeline::MachineConfig machine;
  a.machine.apply(machine);
  if (a.json) check_json_output("--json", *a.json);
  Progress progress;
  std::vector<studies::LeaveOutResult> results;
  for (const SceneArguments& one : all) {
    const auto load = [&one](bool leave_out) {
      SceneArguments wanted = one;
      wanted.leave_out = wanted.keep_packed = leave_out;
      SceneArguments::Loaded loaded = wanted.load();
      return studies::LoadedScene{std::move(loaded.stream), std::move(loaded.left_out)};
    };
    results.push_back(studies::measure_leave_out({one.scene, load}, machine, repeat,
                                                 [&](const std::string& what) { progress.show(what); }));
  }
  progress.clear();
  Tables(true, a.json).print(studies::leave_out_table(results, machine));
  if (a.json) write_text(*a.json, studies::leave_out_json(results, machine));
  return std::ranges::all_of(results,
                             [](const studies::LeaveOutResult& r) { return r.contradiction.empty(); })
             ? kDone
             : kFailed;
}

}  // namespace

void add_leave_out(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "leave-out", "Measures what leaving out saves, and checks that it changes nothing else.");
  const auto a = std::make_shared<LeaveOutArguments>();
  command->add_option("SCENE", a->scenes, "scenes as for render; each has its row")->required();
  a->view.add_view_to(*command, kDefaultSize);
  a->machine.add_to(*command);
  command->add_option("--repeat", a->repeat, "runs of each side; they take turns")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--json", a->json,
                   "writes all that was measured as JSON (docs/leave_out.md); - is standard output")
      ->type_name("F.json|-");
  command->footer(
      R"(Every run is a process of its own, from the file to the picture: --leave-out none beside --leave-out auto. Ends with 1 when they disagree.
Examples:
  quadrille leave-out builtin:fill builtin:triangle
  quadrille leave-out helmet.gltf --frag flat.frag
      a shader that samples nothing: no texture is unpacked
  quadrille leave-out builtin:fill --set gpu.cores=64 --set gpu.partitions=64 --set gpu.channels=64
      a machine much wider than the scene)");
  command->callback([a, &chosen] { chosen = [a] { return run_leave_out(*a); }; });
}

}  // namespace quadrille::cli
