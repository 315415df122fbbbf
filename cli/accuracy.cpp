/// `quadrille accuracy`: error against run time of every setting of the fidelity dial.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/machine_arguments.h"
#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "models/base/error.h"
#include "studies/accuracy_report.h"
#include "studies/plot.h"

namespace quadrille::cli {
namespace {

constexpr const char* kDefaultSize = "480x270";  // ten settings, several times each
constexpr std::int64_t kMaxWindow = 1'000'000, kMaxRepeat = 1000;

struct AccuracyArguments {
  std::vector<std::string> scenes;
  SceneArguments view;
  MachineArguments machine;
  std::string windows = "1,4,16,64,256,1024,4096", repeat = "5";
  std::optional<std::string> json, plot, precision_plot;
  bool no_precision = false;
};

std::vector<std::int64_t> parse_windows(const std::string& text) {
  std::vector<std::int64_t> windows;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    windows.push_back(parse_whole(text.substr(from, to - from), "--windows", 1, kMaxWindow));
    if (std::ranges::count(windows, windows.back()) > 1)
      throw user_error("--windows: {} is there twice", windows.back());
    from = to + 1;
  }
  return windows;
}

/// One scene's arguments: the common view with this scene.
SceneArguments arguments_of(const AccuracyArguments& a, const std::string& scene) {
  SceneArguments one = a.view;
  one.scene = scene;
  one.check();
  one.check_there();
  if (!one.is_trace() && !one.size) one.size = kDefaultSize;
  return one;
}

void check_outputs(const AccuracyArguments& a) {
  if (a.json) check_json_output("--json", *a.json);
  if (a.plot) check_output("--plot", *a.plot, {".svg", ".png"});
  if (a.precision_plot) check_output("--precision-plot", *a.precision_plot, {".svg", ".png"});
  check_distinct({{"--json", a.json}, {"--plot", a.plot}, {"--precision-plot", a.precision_plot}});
  if (a.precision_plot && a.no_precision)
    throw user_error("--precision-plot: not together with --no-precision");
  if (a.plot) studies::require_gnuplot("--plot");
  if (a.precision_plot) studies::require_gnuplot("--precision-plot");
}

int run_accuracy(const AccuracyArguments& a) {
  Progress progress;
  studies::AccuracyOptions options;
  options.windows = parse_windows(a.windows);
  options.repeat = static_cast<int>(parse_whole(a.repeat, "--repeat", 1, kMaxRepeat));
  options.precision = !a.no_precision;
  options.progress = [&](const std::string& what) { progress.show(what); };
  std::vector<SceneArguments> all;
  for (const std::string& scene : a.scenes) all.push_back(arguments_of(a, scene));
  pipeline::MachineConfig machine;
  a.machine.apply(machine);
  check_outputs(a);

  const Tables tables(true, a.json);
  std::vector<studies::SceneAccuracy> measured;
  for (const SceneArguments& one : all) {
    progress.show(fmt::format("loading {}", one.scene));
    studies::StudyScene scene{one.scene, one.load().stream, std::nullopt};
    if (options.precision && !one.is_trace()) scene.visibility = one.load_visibility();
    measured.push_back(studies::measure_accuracy(scene, machine, options));
    progress.clear();
    tables.print((measured.size() > 1 ? "\n" : "") + studies::accuracy_table(measured.back(), machine));
  }
  if (a.json) write_text(*a.json, studies::accuracy_json(measured, machine));
  if (a.plot) studies::draw_plot(*a.plot, studies::accuracy_plot(measured));
  if (a.precision_plot) studies::draw_plot(*a.precision_plot, studies::precision_plot(measured));
  return kDone;
}

}  // namespace

void add_accuracy(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "accuracy", "Measures error against run time: windows of look-ahead, and precisions.");
  const auto a = std::make_shared<AccuracyArguments>();
  command->add_option("SCENE", a->scenes, "scenes as for render; each has its tables")->required();
  a->view.add_view_to(*command, kDefaultSize);
  a->machine.add_to(*command);
  command->add_option("--windows", a->windows, "the windows to measure, in cycles beyond the exact bound")
      ->type_name("W,W,...")
      ->capture_default_str();
  command->add_option("--repeat", a->repeat, "runs of each setting; they take turns")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--no-precision", a->no_precision,
                    "leaves out the table of sub-pixel, sub-texel and level-of-detail bits");
  command
      ->add_option("--json", a->json,
                   "writes all that was measured as JSON (docs/accuracy.md); - is standard output")
      ->type_name("F.json|-");
  command->add_option("--plot", a->plot, "draws error against run time, a line a scene (needs gnuplot)")
      ->type_name("F.svg|F.png");
  command
      ->add_option("--precision-plot", a->precision_plot,
                   "draws the picture's error against bits (needs gnuplot)")
      ->type_name("F.svg|F.png");
  command->footer(
      R"(Every run is a process of its own. Compared are: functional (values only), exact, and each window, whose figures are approximate.
Examples:
  quadrille accuracy builtin:courtyard
  quadrille accuracy helmet.gltf city.gltf --windows 4,16,64 --json accuracy.json --plot accuracy.svg
  quadrille accuracy builtin:cubes --set memory.path_clk=400 --no-precision
      the same question on a machine that waits for its memory)");
  command->callback([a, &chosen] { chosen = [a] { return run_accuracy(*a); }; });
}

}  // namespace quadrille::cli
