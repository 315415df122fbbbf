/// `quadrille experiment`: what others measured, on the simulated machine.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "models/base/error.h"
#include "models/base/near_name.h"
#include "studies/experiments/experiment.h"
#include "studies/plot.h"

namespace quadrille::cli {
namespace {

namespace experiments = studies::experiments;
namespace fs = std::filesystem;

struct ExperimentArguments {
  std::vector<std::string> names, scenes;
  std::optional<std::string> out, size, jobs;
  bool list = false;
};

std::vector<const experiments::Experiment*> chosen_of(const std::vector<std::string>& names) {
  std::vector<const experiments::Experiment*> chosen;
  std::vector<std::string> all;
  for (const experiments::Experiment& e : experiments::experiments()) {
    all.emplace_back(e.name);
    if (names.empty()) chosen.push_back(&e);
  }
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name);
    if (found == all.end())
      throw user_error("there is no experiment '{}'; there are: {}{}", name, fmt::join(all, ", "),
                       did_you_mean(name, all));
    if (std::ranges::find(chosen,
                          &experiments::experiments()[static_cast<std::size_t>(found - all.begin())]) !=
        chosen.end())
      throw user_error("experiment: '{}' is named twice", name);
    chosen.push_back(&experiments::experiments()[static_cast<std::size_t>(found - all.begin())]);
  }
  return chosen;
}

experiments::Setting setting_of(const experiments::Experiment& e, const ExperimentArguments& a) {
  experiments::Setting setting;
  std::vector<std::string> scenes = a.scenes;
  if (scenes.empty()) scenes.assign(e.scenes.begin(), e.scenes.end());
  for (const std::string& name : scenes) {
    SceneArguments scene;
    scene.scene = name;
    if (!scene.is_trace()) scene.size = a.size.value_or(e.size);
    scene.check();
    scene.check_there();
    setting.scenes.emplace_back(fs::path(name).stem().string(), [scene] {
      traces::CommandStream stream = scene.load().stream;
      const auto draws = [](const traces::Command& c) { return std::holds_alternative<traces::Draw>(c); };
      if (std::ranges::none_of(stream.commands, draws))
        throw user_error("{}: draws nothing: no figure comes of that", scene.scene);
      return stream;
    });
  }
  std::tie(setting.width, setting.height) = parse_size(a.size.value_or(e.size), "--size");
  setting.jobs = a.jobs ? static_cast<int>(parse_whole(*a.jobs, "--jobs", 1, 64)) : 2;
  return setting;
}

std::string page_of(const ExperimentArguments& a, const experiments::Experiment& e) {
  return (fs::path(*a.out) / (std::string(e.name) + ".md")).string();
}
std::string picture_of(const ExperimentArguments& a, const experiments::Experiment& e) {
  return (fs::path(*a.out) / (std::string(e.name) + ".png")).string();
}

int run_experiments(const ExperimentArguments& a) {
  const std::vector<const experiments::Experiment*> all = chosen_of(a.names);
  std::vector<experiments::Setting> settings;
  settings.reserve(all.size());
  for (const experiments::Experiment* e : all) settings.push_back(setting_of(*e, a));
  if (a.list) {
    for (const experiments::Experiment* e : all) fmt::print("{:<24}{}\n", e->name, e->title);
    return kDone;
  }
  if (a.out) {
    studies::require_gnuplot("--out");
    std::error_code error;
    fs::create_directories(*a.out, error);
    if (error || !fs::is_directory(*a.out)) throw user_error("--out: {}: cannot be made a folder", *a.out);
    for (const experiments::Experiment* e : all) {
      check_output("--out", page_of(a, *e), {".md"});
      check_output("--out", picture_of(a, *e), {".png"});
    }
  }
  bool hold = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const experiments::Experiment* e = all[i];
    experiments::Setting& setting = settings[i];
    Progress progress;
    setting.progress = [&](const std::string& text) { progress.show(fmt::format("{}: {}", e->name, text)); };
    const experiments::Result result = e->run(setting);
    progress.clear();
    Tables(true, std::nullopt).print(experiments::result_text(*e, result));
    hold = hold && result.holds();
    if (!a.out) continue;
    studies::draw_plot(picture_of(a, *e), result.plot);
    write_text(page_of(a, *e), experiments::result_markdown(*e, result, std::string(e->name) + ".png"));
  }
  return hold ? kDone : kFailed;
}

}  // namespace

void add_experiment(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "experiment",
      "Runs what others measured on the simulated machine, and holds it to the published figures.");
  const auto arguments = std::make_shared<ExperimentArguments>();
  command->add_option("NAME", arguments->names, "experiments (default: all; --list names them)");
  command->add_flag("--list", arguments->list, "prints their names and titles, and runs none");
  command
      ->add_option("--scene", arguments->scenes,
                   "a scene or trace to draw instead of the experiment's own; may be given several times")
      ->type_name("SCENE")
      ->expected(1)
      ->take_all();
  command->add_option("--size", arguments->size, "of the pictures (default: the experiment's own)")
      ->type_name("WxH");
  command->add_option("--out", arguments->out, "writes a page and a plot of each there")->type_name("DIR");
  command->add_option("--jobs", arguments->jobs, "processes at a time (default 2)")->type_name("N");
  command->footer(R"(Exit code 1 when a figure lies outside its band.
Examples:
  quadrille experiment --list
  quadrille experiment memory-scheduling --scene helmet.gltf --out docs/experiments)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_experiments(*arguments); }; });
}

}  // namespace quadrille::cli
