/// `quadrille explore`: many machines draw many scenes, as a sweep file says.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <thread>
#include <utility>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "models/base/error.h"
#include "models/base/near_name.h"
#include "models/base/say.h"
#include "studies/explore/design.h"
#include "studies/explore/explore_page.h"
#include "studies/explore/explore_table.h"
#include "studies/explore/screening.h"
#include "studies/explore/search.h"
#include "studies/explore/slurm.h"
#include "studies/explore/version.h"
#include "traces/whole_file.h"

namespace quadrille::cli {
namespace {

namespace explore = studies::explore;

constexpr std::int64_t kMostJobs = 1024, kMostParts = 1000;

struct ExploreArguments {
  std::string sweep;
  std::optional<std::string> out, csv, report, jobs, parts, only;
  std::vector<std::string> sbatch;
  std::string backend = "local";
  bool dry_run = false, retry_failed = false, mix_versions = false;
};

/// The options of a [[scene]], by their keys.
using TextOption = std::optional<std::string> SceneArguments::*;
const std::map<std::string, TextOption>& text_options() {
  static const std::map<std::string, TextOption> options{
      {"size", &SceneArguments::size},
      {"scene", &SceneArguments::scene_choice},
      {"camera", &SceneArguments::camera},
      {"eye", &SceneArguments::eye},
      {"at", &SceneArguments::at},
      {"time", &SceneArguments::time},
      {"animation", &SceneArguments::animation},
      {"exposure", &SceneArguments::exposure},
      {"environment", &SceneArguments::environment},
      {"shading", &SceneArguments::shading},
      {"order", &SceneArguments::order},
      {"view", &SceneArguments::view},
      {"color_format", &SceneArguments::color_format},
      {"depth_format", &SceneArguments::depth_format},
      {"vert", &SceneArguments::vert},
      {"frag", &SceneArguments::frag},
      {"samples", &SceneArguments::samples},
      {"transparency", &SceneArguments::transparency},
      {"transparency_layers", &SceneArguments::transparency_layers}};
  return options;
}
const std::map<std::string, bool SceneArguments::*>& switches() {
  static const std::map<std::string, bool SceneArguments::*> options{
      {"supersample", &SceneArguments::supersample},
      {"alpha_to_coverage", &SceneArguments::alpha_to_coverage}};
  return options;
}

/// The arguments that `render` would have been given. Throws `UserError` with the line of the sweep.
SceneArguments arguments_of(const explore::SceneEntry& entry) {
  SceneArguments arguments;
  arguments.scene = entry.scene;
  for (const explore::Entry& option : entry.options) {
    if (const auto text = text_options().find(option.key); text != text_options().end()) {
      arguments.*text->second = option.value;
    } else if (const auto flag = switches().find(option.key); flag != switches().end()) {
      if (option.value != "true" && option.value != "false")
        throw user_error("{}: {}: true or false is expected", option.where, option.key);
      arguments.*flag->second = option.value == "true";
    } else {
      std::vector<std::string> legal{"file", "name"};
      for (const auto& [key, unused] : text_options()) legal.push_back(key);
      for (const auto& [key, unused] : switches()) legal.push_back(key);
      throw user_error("{}: unknown key '{}'; a scene has {}{}", option.where, option.key,
                       fmt::join(legal, ", "), did_you_mean(option.key, legal));
    }
  }
  try {
    arguments.check();
    arguments.check_there();
  } catch (const UserError& error) { throw user_error("{}: {}", entry.where, error.what()); }
  return arguments;
}

/// How far the points are: a bar on a terminal, else a line now and then.
class ProgressLine {
 public:
  void show(const explore::ExploreProgress& p) {
    const std::string text =
        fmt::format("{} of {} points{}, {:.0f} s left: {}", p.done, p.total,
                    p.failed > 0 ? fmt::format(", {} failed", p.failed) : "", p.seconds_left, p.last);
    if (isatty(STDERR_FILENO) == 1) {
      constexpr std::size_t kWidth = 24;
      const std::size_t full = kWidth * p.done / std::max<std::size_t>(1, p.total);
      bar_.show(fmt::format("[{}{}] {}", std::string(full, '='), std::string(kWidth - full, ' '), text));
    } else if (watch_.seconds() >= next_ || p.done == p.total) {
      say(text + "\n");
      next_ = watch_.seconds() + kSecondsBetweenLines;
    }
  }
  void clear() { bar_.clear(); }
  void show(const std::string& text) { bar_.show(text); }

 private:
  static constexpr double kSecondsBetweenLines = 5;
  Progress bar_;
  Stopwatch watch_;
  double next_ = 0;
};

std::vector<explore::LoadedScene> loaded_scenes(const explore::Sweep& sweep, ProgressLine& progress) {
  std::vector<SceneArguments> arguments;
  for (const explore::SceneEntry& entry : sweep.scenes) arguments.push_back(arguments_of(entry));
  std::vector<explore::LoadedScene> scenes;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    progress.show(fmt::format("loading {}", arguments[i].scene));
    try {
      scenes.push_back(explore::with_hash(sweep.scenes[i], arguments[i].load().stream));
    } catch (const UserError& error) { throw user_error("{}: {}", sweep.scenes[i].where, error.what()); }
  }
  progress.clear();
  return scenes;
}

std::string file_text(const std::string& path) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMostBytes);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Draws the points as an array job of Slurm.
void run_on_slurm(const ExploreArguments& a, const explore::Plan& plan, explore::Exploration& exploration,
                  explore::Results& results) {
  explore::SlurmSetting setting;
  setting.folder = std::filesystem::path(a.sweep).stem().string() + ".slurm";
  setting.command = {std::filesystem::read_symlink("/proc/self/exe").string(), "explore", a.sweep};
  if (a.jobs) setting.command.insert(setting.command.end(), {"--jobs", *a.jobs});
  setting.jobs_of_node = !a.jobs;
  if (a.mix_versions) setting.command.emplace_back("--mix-versions");
  setting.options = a.sbatch;
  setting.parts = static_cast<std::size_t>(a.parts ? parse_whole(*a.parts, "--parts", 1, kMostParts) : 16);
  setting.say = [](const std::string& text) { say(text + "\n"); };
  bool retry = a.retry_failed;  // once
  explore::run_on_slurm(setting, results,
                        [&] { return exploration.missing(plan.candidates, std::exchange(retry, false)); });
}

/// What there is to draw, for a task of the array: no table is of use to it.
int run_part(const explore::Plan& plan, explore::Exploration& exploration, explore::Results& results,
             const std::set<explore::PointKey>& points) {
  exploration.run(plan.candidates);
  std::size_t failed = 0;
  for (const auto& [point, status] : results.statuses()) failed += points.contains(point) && status != "done";
  return failed == 0 ? kDone : kFailed;
}

/// From a few points, how long the sweep takes: of one that screens, both of its rounds.
std::string costs(const explore::Sweep& sweep, const explore::Space& space,
                  std::span<const explore::LoadedScene> scenes, explore::Results& results,
                  const explore::ExploreSetting& setting, const explore::Plan& plan,
                  explore::Exploration& exploration) {
  std::size_t machines = sweep.design == explore::DesignKind::kSearch ? sweep.points : plan.candidates.size();
  std::string text;
  if (sweep.screen) {
    explore::Exploration rough(sweep, space, scenes, results, setting, sweep.screen->window);
    text = fmt::format("  screening, with a window of {} cycles:\n{}", sweep.screen->window,
                       explore::cost_table(rough.measure(plan.candidates), machines,
                                           rough.known(plan.candidates), setting.jobs));
    machines = std::min<std::size_t>(sweep.screen->machines, machines);
    text += fmt::format("  the best {}, exactly:\n", machines);
  }
  const std::size_t known = std::min(exploration.known(plan.candidates), machines * scenes.size());
  return text + explore::cost_table(exploration.measure(plan.candidates), machines, known, setting.jobs);
}

int run_explore(const ExploreArguments& a) {
  explore::ExploreSetting setting;
  setting.jobs = static_cast<int>(a.jobs ? parse_whole(*a.jobs, "--jobs", 1, kMostJobs)
                                         : std::max(1u, std::thread::hardware_concurrency()));
  setting.retry_failed = a.retry_failed;
  setting.mix_versions = a.mix_versions;
  setting.version = explore::program_version(QUADRILLE_VERSION);
  if (a.csv) check_output("--csv", *a.csv, {".csv"});
  if (a.report) check_output("--report", *a.report, {".html"});
  if (a.out) check_output("--out", *a.out, {".db"});
  if (a.only) setting.only = explore::read_point_list(file_text(*a.only), *a.only);
  ProgressLine progress;
  setting.progress = [&](const explore::ExploreProgress& p) { progress.show(p); };
  const explore::Sweep sweep = explore::read_sweep(a.sweep);
  const explore::Space space(sweep);
  const std::vector<explore::LoadedScene> scenes = loaded_scenes(sweep, progress);
  const bool searches = sweep.design == explore::DesignKind::kSearch;
  if (searches && (a.backend == "slurm" || a.only))
    throw user_error("{}: a search chooses as it goes; --backend slurm draws other designs", a.sweep);
  if (sweep.screen && (a.backend == "slurm" || a.only))
    throw user_error("{}: screen: it chooses as it goes; --backend slurm draws sweeps without it", a.sweep);
  explore::Plan plan = searches ? explore::first_machines(sweep, space) : explore::planned(sweep, space);
  if (plan.candidates.empty())
    throw user_error("{}: no machine is left to draw with; {}", a.sweep,
                     plan.excluded.empty() ? "" : plan.excluded.begin()->first);
  const std::string out = a.out.value_or(std::filesystem::path(a.sweep).stem().string() + ".db");
  // A dry run leaves nothing behind.
  std::error_code unknown;
  explore::Results results(a.dry_run && !std::filesystem::exists(out, unknown) ? "" : out);
  explore::Exploration exploration(sweep, space, scenes, results, setting);
  exploration.check_formulas(plan.candidates.front());
  if (a.dry_run) {
    Tables(true, std::nullopt)
        .print(explore::plan_table(sweep, plan, scenes.size()) +
               costs(sweep, space, scenes, results, setting, plan, exploration));
    return kDone;
  }
  std::optional<explore::Screening> screening;
  if (a.only) return run_part(plan, exploration, results, *setting.only);
  if (a.backend == "slurm") run_on_slurm(a, plan, exploration, results);
  else if (searches) plan = explore::search(sweep, space, exploration);
  else if (sweep.screen) screening = explore::screen(sweep, space, scenes, results, setting, plan);
  else exploration.run(plan.candidates);
  progress.clear();
  if (a.csv) write_text(*a.csv, explore::points_csv(sweep, space, plan, exploration));
  if (a.report) write_text(*a.report, explore::sweep_page({sweep, space, plan, exploration, results}));
  Tables(true, std::nullopt)
      .print(explore::plan_table(sweep, plan, scenes.size()) +
             (screening ? explore::screening_table(sweep, *screening) : "") +
             explore::result_table(sweep, plan, exploration));
  const bool screened = !screening || screening->failed == 0;
  return screened && explore::failed_points(plan, exploration) == 0 ? kDone : kFailed;
}

}  // namespace

void add_explore(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("explore", "Draws scenes on many machines, as a sweep file says (docs/explore.md).");
  const auto a = std::make_shared<ExploreArguments>();
  command->add_option("SWEEP", a->sweep, "a .toml file: scenes, machines, what varies, objectives")
      ->required()
      ->type_name("SWEEP.toml");
  command
      ->add_option("--out", a->out,
                   "the results, a file of SQLite; the same command goes on where it was ended (default: "
                   "SWEEP.db here)")
      ->type_name("F.db");
  command->add_option("--csv", a->csv, "writes a line for each point: values, objectives, costs")
      ->type_name("F.csv");
  command
      ->add_option("--report", a->report,
                   "writes a page: fronts, main effects, Sobol indices, all machines, pictures")
      ->type_name("F.html");
  command
      ->add_option("--jobs", a->jobs, "points at a time, each a process; else as many as the host has cores")
      ->type_name("N");
  command
      ->add_option("--backend", a->backend, "where the points are drawn: here, or as an array job of Slurm")
      ->type_name("local|slurm")
      ->check(CLI::IsMember({"local", "slurm"}));
  command->add_option("--parts", a->parts, "tasks of the array job, at most (default: 16)")->type_name("N");
  command
      ->add_option("--sbatch", a->sbatch,
                   "an option for sbatch, as in --sbatch=--partition=all; many may be given")
      ->type_name("OPTION");
  command
      ->add_option("--only", a->only, "draws the points of a list alone: what a task of the array job does")
      ->type_name("F.points");
  command->add_flag(
      "--dry-run", a->dry_run,
      "says how many points there are, how long they take and how much disk, from a few that it "
      "draws; saves nothing");
  command->add_flag("--retry-failed", a->retry_failed, "draws points again that are known to have failed");
  command->add_flag("--mix-versions", a->mix_versions,
                    "adds to results of another version of the program; each point says which drew it");
  command->footer(R"(Examples:
  quadrille explore caches.toml --dry-run
  quadrille explore caches.toml --jobs 2 --csv caches.csv
  quadrille explore caches.toml --report caches.html
Exit code: 0 all points done, 1 some failed (the table says why), 2 something given was wrong.)");
  command->callback([a, &chosen] { chosen = [a] { return run_explore(*a); }; });
}

}  // namespace quadrille::cli
