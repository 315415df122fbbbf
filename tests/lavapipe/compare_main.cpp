/// quadrille_lavapipe_compare: renders a scene on Quadrille and on lavapipe and says whether the pictures
/// agree, with figures.
///
/// Exit code: 0 they agree, 1 they do not, 2 a mistake in what was given, 77 no Vulkan driver (a skipped test
/// for CTest).
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "models/base/error.h"
#include "models/reference/compare.h"
#include "scenes/image/image_io.h"
#include "scenes/scene.h"
#include "tests/lavapipe/alpha_ties.h"
#include "tests/lavapipe/compare_report.h"
#include "tests/lavapipe/frame_compare.h"
#include "tests/lavapipe/machine_side.h"
#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {
namespace {

constexpr int kSkipped = 77;

struct Arguments {
  std::string scene, environment;
  std::string size = "1920x1080";
  std::vector<float> eye, at;
  int camera = -1;
  std::string vertex_shader, fragment_shader, report, images;
  std::string shading = "pbr", order = "file", view;
  bool lavapipe_only = false, validate = false, supersample = false, alpha_to_coverage = false;
  int time_frames = 0;
  int threads = -1;
  std::uint32_t samples = 1;
  int subpixel_bits = 0, subtexel_bits = 0, lod_bits = 0;
};

void declare(CLI::App& app, Arguments& a) {
  app.add_option("scene", a.scene, "glTF file or builtin:NAME")->required();
  app.add_option("--size", a.size, "pixels, WIDTHxHEIGHT")->capture_default_str();
  app.add_option("--camera", a.camera, "index of a camera of the file");
  app.add_option("--eye", a.eye, "X,Y,Z of an own camera")->delimiter(',')->expected(3);
  app.add_option("--at", a.at, "X,Y,Z it looks at")->delimiter(',')->expected(3);
  app.add_option("--vert", a.vertex_shader, "vertex shader (GLSL or SPIR-V) instead of the materials'");
  app.add_option("--frag", a.fragment_shader, "fragment shader instead of the materials'");
  const auto one_of = [](const auto& names) {
    return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
  };
  app.add_option("--shading", a.shading, "as of quadrille render")->check(one_of(scenes::kShadingNames));
  app.add_option("--order", a.order, "as of quadrille render")->check(one_of(scenes::kDrawOrderNames));
  app.add_option("--view", a.view, "as of quadrille render")->check(one_of(scenes::kShowingNames));
  app.add_option("--environment", a.environment, "as of quadrille render");
  app.add_option("--report", a.report, "write the figures to this JSON file");
  app.add_option("--images", a.images, "write both pictures and their difference to this folder");
  app.add_option("--samples", a.samples,
                 "samples a pixel of the coloured picture: 1 or 4, which lavapipe has")
      ->check(CLI::IsMember({1, 4}));
  app.add_flag("--supersample", a.supersample, "as of quadrille render");
  app.add_flag("--alpha-to-coverage", a.alpha_to_coverage, "as of quadrille render");
  app.add_flag("--lavapipe-only", a.lavapipe_only, "render and time lavapipe; compare nothing");
  app.add_flag("--validate", a.validate,
               "run lavapipe under the Khronos validation layer; any message is a failure");
  app.add_option("--time", a.time_frames, "time lavapipe over this many frames");
  app.add_option("--threads", a.threads, "lavapipe's raster threads (0: none beside the submitting one)");
  app.add_option("--subpixel-bits", a.subpixel_bits, "Quadrille's, instead of what the driver reports");
  app.add_option("--subtexel-bits", a.subtexel_bits, "Quadrille's, instead of what the driver reports");
  app.add_option("--lod-bits", a.lod_bits, "Quadrille's, instead of what the driver reports");
}

std::optional<glm::vec3> point(const std::vector<float>& values) {
  if (values.empty()) return std::nullopt;
  return glm::vec3(values[0], values[1], values[2]);
}

scenes::SceneOptions scene_options(const Arguments& a) {
  scenes::SceneOptions options;
  char extra = 0;
  if (std::sscanf(a.size.c_str(), "%ux%u%c", &options.width, &options.height, &extra) != 2)
    throw user_error("--size {}: expected WIDTHxHEIGHT, for example 1920x1080", a.size);
  options.camera = a.camera;
  options.eye = point(a.eye);
  options.at = point(a.at);
  options.vertex_shader = a.vertex_shader;
  options.fragment_shader = a.fragment_shader;
  options.shading = scenes::named(scenes::kShadingNames, a.shading, scenes::Shading::kMinimal);
  options.order = scenes::named(scenes::kDrawOrderNames, a.order, scenes::DrawOrder::kFile);
  options.environment = a.environment;
  options.samples = a.samples;
  options.alpha_to_coverage = a.alpha_to_coverage;
  if (!a.view.empty()) options.shown = scenes::named(scenes::kShowingNames, a.view, scenes::Showing::kDepth);
  return options;
}

/// Mesa's llvmpipe reports 4 bits for the level of detail but keeps the whole fraction of a logarithm that is
/// linear between powers of two (measured bit by bit in numerics_test.cpp); 8 bits are the nearest Quadrille
/// has.
constexpr std::uint32_t kLlvmpipeLodBits = 8;

models::Precision machine_precision(const Arguments& a, const DeviceInfo& device) {
  const auto choose = [](int given, std::uint32_t reported) {
    return given > 0 ? given : static_cast<int>(reported);
  };
  const bool llvmpipe = device.name.starts_with("llvmpipe");
  return {.subpixel_bits = choose(a.subpixel_bits, device.subpixel_bits),
          .subtexel_bits = choose(a.subtexel_bits, device.subtexel_bits),
          .lod_bits = choose(a.lod_bits, llvmpipe ? kLlvmpipeLodBits : device.mipmap_bits),
          .linear_log2 = llvmpipe};
}

/// Pixels that hang on an alpha at its cut-off, in either picture. Empty when nothing needs that excuse.
std::vector<std::uint8_t> alphas_at_cutoff(const traces::CommandStream& triangles, const FramePair& ours,
                                           const FramePair& theirs, VulkanRenderer& renderer,
                                           const models::Precision& precision) {
  const std::vector<std::uint8_t> marks = unexplained_pixels(ours, theirs);
  if (std::find(marks.begin(), marks.end(), 1) == marks.end()) return {};
  std::vector<std::uint8_t> ties =
      alpha_ties(triangles, theirs.triangles, [&](const auto& stream) { return renderer.render(stream); });
  const std::vector<std::uint8_t> our_ties = alpha_ties(
      triangles, ours.triangles, [&](const auto& stream) { return render_on_machine(stream, precision); });
  for (std::size_t i = 0; i < ties.size(); ++i) ties[i] = static_cast<std::uint8_t>(ties[i] | our_ties[i]);
  return ties;
}

void save_picture(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                  const std::vector<std::uint32_t>& pixels) {
  scenes::Rgba8Image image{width, height, {}};
  image.pixels.reserve(4 * pixels.size());
  for (const std::uint32_t p : pixels) {
    for (const int shift : {0, 8, 16}) image.pixels.push_back(static_cast<std::uint8_t>(p >> shift));
    image.pixels.push_back(255);  // opaque, so that a viewer shows the colours as they are
  }
  scenes::save_png(path.string(), image);
}

void save_pictures(const std::string& folder, const FramePair& ours, const FramePair& theirs) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path base = folder;
  const std::uint32_t width = ours.color.width, height = ours.color.height;
  save_picture(base / "quadrille.png", width, height, ours.color.color);
  save_picture(base / "lavapipe.png", width, height, theirs.color.color);
  save_picture(base / "difference.png", width, height,
               models::reference::difference_heat_map({width, height, ours.color.color},
                                                      {width, height, theirs.color.color}));
  save_picture(base / "triangle_difference.png", width, height,
               models::reference::difference_heat_map({width, height, ours.triangles.color},
                                                      {width, height, theirs.triangles.color}));
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw user_error("{}: cannot be written", path);
}

int report_validation(const VulkanRenderer& renderer) {
  for (const std::string& message : renderer.validation_messages())
    fmt::print(stderr, "validation: {}\n", message);
  return renderer.validation_messages().empty() ? 0 : 1;
}

int run(const Arguments& arguments, VulkanRenderer& renderer) {
  scenes::SceneOptions options = scene_options(arguments);
  traces::CommandStream color = scenes::load_scene(arguments.scene, options);
  traces::use_samples(color, arguments.samples);
  if (arguments.supersample) traces::use_sample_shading(color);
  options.visibility = true;
  const traces::CommandStream triangles = scenes::load_scene(arguments.scene, options);

  Report report;
  report.scene = arguments.scene;
  report.width = options.width;
  report.height = options.height;
  report.device = renderer.info();
  report.precision = machine_precision(arguments, report.device);
  const FramePair theirs{renderer.render(color), renderer.render(triangles)};
  if (arguments.time_frames > 0) report.lavapipe_times = renderer.time_frames(color, arguments.time_frames);
  if (arguments.lavapipe_only) {
    fmt::print("{} {}x{}: lavapipe median {:.2f} ms, least {:.2f} ms, processor {:.2f} ms, of {} frames\n",
               report.scene, report.width, report.height, report.lavapipe_times.median_ms,
               report.lavapipe_times.min_ms, report.lavapipe_times.median_cpu_ms,
               report.lavapipe_times.frames);
    if (!arguments.images.empty()) save_pictures(arguments.images, theirs, theirs);
    return report_validation(renderer);
  }

  const auto begin = std::chrono::steady_clock::now();
  Rendered our_color = render_on_machine(color, report.precision);
  report.machine_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  const FramePair ours{std::move(our_color), render_on_machine(triangles, report.precision)};
  if (!arguments.images.empty()) save_pictures(arguments.images, ours, theirs);
  report.result = compare_frames(
      ours, theirs, alphas_at_cutoff(triangles, ours, theirs, renderer, report.precision), report.limits);
  fmt::print("{}", to_text(report));
  if (!arguments.report.empty()) write_file(arguments.report, to_json(report));
  const int validation = report_validation(renderer);
  return report.result.passed() ? validation : 1;
}

int compare(const Arguments& arguments) {
  if (arguments.threads >= 0) ::setenv("LP_NUM_THREADS", std::to_string(arguments.threads).c_str(), 1);
  std::optional<VulkanRenderer> renderer;
  try {
    renderer.emplace(arguments.validate);
  } catch (const UserError& error) {
    fmt::print(stderr, "skipped: {}\n", error.what());
    return kSkipped;
  }
  return run(arguments, *renderer);
}

}  // namespace
}  // namespace quadrille::lavapipe

/// SystemC's library refers to it; a program with a main of its own never calls it.
extern "C" int sc_main(int, char**) { return 0; }

int main(int argc, char** argv) {
  CLI::App app("Renders a scene on Quadrille and on lavapipe and says whether the pictures agree.");
  quadrille::lavapipe::Arguments arguments;
  quadrille::lavapipe::declare(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    return quadrille::lavapipe::compare(arguments);
  } catch (const quadrille::UserError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
