/// quadrille_measure_simulated: the experiments of quadrille_measure_vulkan on the simulated machine, as the
/// same JSON.
///
/// Exit code: 0 measured, 2 a mistake in what was given.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>

#include "models/base/error.h"
#include "tests/lavapipe/measure_machine.h"
#include "traces/trace_file.h"

namespace quadrille::lavapipe {
namespace {

struct Arguments {
  std::string size = "1920x1080", out = "-", traces;
  std::vector<std::string> experiments, scenes, settings;
  int jobs = 1;
  bool list = false, quiet = false;
};

void declare(CLI::App& app, Arguments& a) {
  app.add_option("experiment", a.experiments, "which experiments; default: all");
  app.add_option("--scene", a.scenes,
                 "measure this instead: builtin:NAME, a glTF file or a trace (.qtrace); again for more")
      ->allow_extra_args(false);
  app.add_option("--set", a.settings, "KEY=VALUE: what differs from the default machine; again for more")
      ->allow_extra_args(false);
  app.add_option("--size", a.size, "of the target in pixels, WIDTHxHEIGHT")->capture_default_str();
  app.add_option("--jobs", a.jobs, "frames at a time")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--out", a.out, "JSON file; -: standard output; the last of several counts")
      ->take_last()
      ->capture_default_str();
  app.add_option("--traces", a.traces,
                 "folder that receives each point as a trace, for quadrille render and all its figures; "
                 "nothing is simulated");
  app.add_flag("--list", a.list, "name the experiments and their points; draw nothing");
  app.add_flag("-q,--quiet", a.quiet, "say nothing while simulating");
}

void write_traces(const std::string& folder, const std::vector<MeasuredExperiment>& experiments) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) throw user_error("--traces: {}: not a folder", folder);
  for (const MeasuredExperiment& e : experiments) {
    for (const Point& p : e.points)
      traces::write_trace(p.stream(),
                          (std::filesystem::path(folder) / (file_name(e, p) + ".qtrace")).string());
  }
}

void run(const Arguments& a) {
  const auto [width, height] = parse_target_size(a.size);
  const std::vector<MeasuredExperiment> experiments = chosen_points(a.experiments, a.scenes, width, height);
  if (a.list) {
    fmt::print("{}", listed(experiments));
    return;
  }
  if (!a.traces.empty()) {
    write_traces(a.traces, experiments);
    return;
  }
  for (const std::string& setting : a.settings) {
    if (setting.find('=') == std::string::npos) throw user_error("--set {}: expected KEY=VALUE", setting);
  }
  const auto progress = [&](const std::string& text) {
    if (!a.quiet) fmt::print(stderr, "{}\n", text);
  };
  Measurement measurement = simulate_all(experiments, a.settings, a.jobs, progress);
  measurement.width = width;
  measurement.height = height;
  write_measurement(a.out, measurement);
}

}  // namespace
}  // namespace quadrille::lavapipe

/// SystemC's library refers to it; a program with a main of its own never calls it.
extern "C" int sc_main(int, char**) { return 0; }

int main(int argc, char** argv) {
  CLI::App app(
      "Draws the experiments' meshes on the simulated machine and writes cycles and statistics as JSON.");
  quadrille::lavapipe::Arguments arguments;
  quadrille::lavapipe::declare(app, arguments);
  try {
    app.parse(argc, argv);
    quadrille::lavapipe::run(arguments);
    return 0;
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : (fmt::print(stderr, "{}\n", error.what()), 2);
  } catch (const quadrille::UserError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
