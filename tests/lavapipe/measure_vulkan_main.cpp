/// quadrille_measure_vulkan: draws the experiments' meshes, or a scene, on a Vulkan device without a window,
/// and writes times and statistics as JSON.
///
/// Exit code: 0 measured, 2 a mistake in what was given or a device that is not there or cannot do it.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>

#include "models/base/error.h"
#include "tests/lavapipe/measure_vulkan.h"

namespace quadrille::lavapipe {
namespace {

struct Arguments {
  std::string device, size = "1920x1080", out = "-", pictures;
  std::vector<std::string> experiments, scenes;
  int repeats = MeasureOptions{}.repeats, seconds = 240;
  bool no_times = false, no_statistics = false, validate = false, list = false, quiet = false;
};

void declare(CLI::App& app, Arguments& a) {
  app.add_option("experiment", a.experiments, "which experiments; default: all");
  app.add_option("--device", a.device,
                 "part of the device's name, which may be a software driver's (llvmpipe); default: a GPU");
  app.add_option("--scene", a.scenes,
                 "measure this instead: builtin:NAME, a glTF file or a trace (.qtrace); again for more")
      ->allow_extra_args(false);
  app.add_option("--size", a.size, "of the target in pixels, WIDTHxHEIGHT; a trace has its own")
      ->capture_default_str();
  app.add_option("--repeats", a.repeats, "times that each frame is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seconds", a.seconds, "after this long, the frames that are left are timed once")
      ->take_last()
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_option("--out", a.out, "JSON file; -: standard output; the last of several counts")
      ->take_last()
      ->capture_default_str();
  app.add_option("--pictures", a.pictures, "folder that receives what each point drew, as .ppm");
  app.add_flag("--no-times", a.no_times, "statistics alone");
  app.add_flag("--no-statistics", a.no_statistics, "times alone");
  app.add_flag("--validate", a.validate, "run under the Khronos validation layer; a message is an error");
  app.add_flag("--list", a.list, "name the experiments and their points; draw nothing");
  app.add_flag("-q,--quiet", a.quiet, "say nothing while measuring");
}

int run(const Arguments& a) {
  const auto [width, height] = parse_target_size(a.size);
  const std::vector<MeasuredExperiment> experiments = chosen_points(a.experiments, a.scenes, width, height);
  if (a.list) {
    fmt::print("{}", listed(experiments));
    return 0;
  }
  if (a.no_times && a.no_statistics)
    throw user_error("--no-times with --no-statistics leaves nothing to measure");
  std::error_code error;
  if (!a.pictures.empty() && !std::filesystem::is_directory(a.pictures, error))
    throw user_error("--pictures: {}: not a folder", a.pictures);
  const DeviceWish::Kind kind = a.device.empty() ? DeviceWish::Kind::kGpu : DeviceWish::Kind::kNamed;
  const VulkanDevice device({.kind = kind, .name = a.device, .validate = a.validate});
  const MeasureOptions options{.times = !a.no_times,
                               .statistics = !a.no_statistics,
                               .repeats = a.repeats,
                               .enough = std::chrono::steady_clock::now() + std::chrono::seconds(a.seconds),
                               .pictures = a.pictures};
  const auto progress = [&](const std::string& text) {
    if (!a.quiet) fmt::print(stderr, "{}: {}\n", device.info().name, text);
  };
  Measurement measurement = measure_all(device, experiments, options, progress);
  measurement.width = width;
  measurement.height = height;
  write_measurement(a.out, measurement);
  for (const std::string& message : device.messages()) fmt::print(stderr, "validation: {}\n", message);
  return device.messages().empty() ? 0 : 1;
}

}  // namespace
}  // namespace quadrille::lavapipe

int main(int argc, char** argv) {
  CLI::App app(
      "Draws the experiments' meshes, or a scene, on a Vulkan device and writes times and statistics as "
      "JSON.");
  quadrille::lavapipe::Arguments arguments;
  quadrille::lavapipe::declare(app, arguments);
  try {
    app.parse(argc, argv);
    return quadrille::lavapipe::run(arguments);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : (fmt::print(stderr, "{}\n", error.what()), 2);
  } catch (const quadrille::UserError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
