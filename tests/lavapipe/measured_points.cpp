#include "tests/lavapipe/measured_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/near_name.h"
#include "scenes/scene.h"
#include "studies/experiments/measured_meshes.h"
#include "traces/trace_file.h"

namespace quadrille::lavapipe {
namespace {

namespace meshes = studies::experiments;
using meshes::DrawOptions, meshes::TriangleMesh;

struct Frame {
  std::uint32_t width, height;
};

template <class Mesh>
Point point(std::string name, double x, Mesh mesh, const DrawOptions& options = {}) {
  return {std::move(name), x, mesh, [=] { return meshes::stream_of(mesh(), options); }};
}

constexpr std::uint32_t kLargestTile = 128, kLargestArea = 1024, kMostLayers = 10;
/// Around the places where devices are known to begin a batch of vertices: 32, 64, 128 and 256 triangles, and
/// the 32nd and 128th index.
constexpr std::uint32_t kTriangleCounts[] = {1,  2,  4,  8,   11,  16,  31,  32,  33,  34,
                                             42, 43, 44, 63,  64,  65,  66,  84,  85,  86,
                                             96, 97, 98, 127, 128, 129, 130, 255, 256, 257};
/// Triangles of a frame that measures the rate of set-up, at least: enough for a time that can be told from
/// that of an empty pass.
constexpr std::uint32_t kSetupTriangles = 1 << 17;

MeasuredExperiment vertex_reuse(Frame f) {
  MeasuredExperiment e{"vertex-reuse", "indices 0, 1, 2 again and again: indices", {}};
  for (const std::uint32_t n : kTriangleCounts)
    e.points.push_back(point(fmt::format("{}", 3 * n), 3.0 * n,
                             [=] { return meshes::same_triangle(f.width, f.height, n); }));
  return e;
}

Point tiles(Frame f, std::uint32_t width, std::uint32_t height, double x) {
  return point(fmt::format("{}x{}", width, height), x,
               [=] { return meshes::tiled_frame(f.width, f.height, width, height); });
}
MeasuredExperiment small_triangles(Frame f) {
  MeasuredExperiment e{"small-triangles", "edge of a tile of two triangles, pixels", {}};
  for (std::uint32_t tile = kLargestTile; tile > 0; tile /= 2) e.points.push_back(tiles(f, tile, tile, tile));
  return e;
}
MeasuredExperiment thin_triangles(Frame f) {
  return {"thin-triangles",
          "width of a tile of 256 pixels, pixels",
          {tiles(f, 16, 16, 16), tiles(f, 4, 64, 4), tiles(f, 64, 4, 64), tiles(f, 1, 256, 1),
           tiles(f, 256, 1, 256)}};
}

MeasuredExperiment setup_rate(Frame f) {
  // A tile of 2x1 pixels is two triangles of one pixel each: the centres lie to either side of the diagonal.
  const auto pixels = [=] {
    TriangleMesh once = meshes::tiled_frame(f.width, f.height, 2, 1);
    const auto triangles = static_cast<std::uint32_t>(once.triangles.size());
    return meshes::repeated(std::move(once), (kSetupTriangles + triangles - 1) / triangles);
  };
  return {"setup-rate",
          "culled (1), off screen (2), of one pixel (3)",
          {point("culled", 1, pixels, {.cull = traces::CullMode::kBack}),
           point("off screen", 2, [=] { return meshes::moved_right(pixels(), 2 * f.width); }),
           point("one pixel", 3, pixels)}};
}

MeasuredExperiment quad_overhead(Frame f) {
  MeasuredExperiment e{"quad-overhead", "area of a triangle, pixels", {}};
  for (std::uint32_t area = kLargestArea; area > 0; area /= 2)
    e.points.push_back(
        point(fmt::format("{}", area), area, [=] { return meshes::scattered(f.width, f.height, area); }));
  return e;
}

MeasuredExperiment hidden_surfaces(Frame f, bool front_first) {
  MeasuredExperiment e{front_first ? "front-to-back" : "back-to-front", "layers over the whole frame", {}};
  for (std::uint32_t n = 1; n <= kMostLayers; ++n)
    e.points.push_back(point(fmt::format("{}", n), n,
                             [=] { return meshes::layers(f.width, f.height, n, front_first); },
                             {.depth = true}));
  return e;
}

MeasuredExperiment colour_layers(Frame f, bool blended) {
  MeasuredExperiment e{
      blended ? "blended-layers" : "opaque-layers", "layers over the whole frame, without depth", {}};
  for (std::uint32_t n = 1; n <= kMostLayers; ++n)
    e.points.push_back(point(fmt::format("{}", n), n,
                             [=] { return meshes::layers(f.width, f.height, n, false); },
                             {.blends = blended}));
  return e;
}

/// Few layers and many of them: their difference is what layers cost, without what begins and ends a pass.
constexpr std::uint32_t kFewLayers = 2;

void add_layers(MeasuredExperiment& e, Frame f, const std::string& name, const DrawOptions& options,
                std::uint32_t samples = 1) {
  for (const std::uint32_t n : {kFewLayers, kMostLayers}) {
    const auto mesh = [=] { return meshes::layers(f.width, f.height, n, false); };
    e.points.push_back({fmt::format("{} {}", name, n), static_cast<double>(e.points.size() + 1), mesh, [=] {
                          traces::CommandStream stream = meshes::stream_of(mesh(), options);
                          if (samples > 1) traces::use_samples(stream, samples);
                          return stream;
                        }});
  }
}

MeasuredExperiment colour_formats(Frame f, bool blended) {
  using traces::Format;
  MeasuredExperiment e{blended ? "blended-formats" : "opaque-formats",
                       "format of the colour attachment, and layers over the whole frame",
                       {}};
  for (const Format format :
       {Format::kR8G8B8A8Unorm, Format::kR16G16B16A16Float, Format::kR32G32B32A32Float, Format::kR8G8Unorm,
        Format::kR16G16Float, Format::kR32G32Float, Format::kR8Unorm, Format::kR16Float, Format::kR32Float,
        Format::kA2B10G10R10Unorm, Format::kB10G11R11Ufloat}) {
    add_layers(e, f, std::string(models::format_info(format).name), {.blends = blended, .format = format});
  }
  return e;
}

MeasuredExperiment depth_formats(Frame f) {
  using traces::Format;
  MeasuredExperiment e{
      "depth-formats", "format of depth, and layers over the whole frame, back to front", {}};
  for (const Format format :
       {Format::kD32Float, Format::kD16Unorm, Format::kD24UnormS8Uint, Format::kD32FloatS8Uint}) {
    add_layers(e, f, std::string(models::format_info(format).name), {.depth = true, .depth_format = format});
  }
  return e;
}

MeasuredExperiment samples(Frame f, bool depth) {
  MeasuredExperiment e{
      depth ? "samples-with-depth" : "samples", "samples a pixel, and layers over the whole frame", {}};
  // What every Vulkan device has.
  for (const std::uint32_t count : {1U, 4U})
    add_layers(e, f, fmt::format("{}", count), {.depth = depth}, count);
  return e;
}

MeasuredExperiment near_plane(Frame f) {
  MeasuredExperiment e{"near-plane", "corners of a triangle before the near plane", {}};
  for (std::uint32_t behind = 0; behind <= 3; ++behind) {
    e.points.push_back(point(fmt::format("{}", behind), behind,
                             [=] { return meshes::through_near_plane(f.width, f.height, behind); },
                             {.depth = true}));
  }
  return e;
}

traces::CommandStream load(const std::string& scene, Frame f) {
  if (scene.ends_with(".qtrace")) return traces::read_trace(scene);
  scenes::SceneOptions options;
  options.width = f.width;
  options.height = f.height;
  return scenes::load_scene(scene, options);
}

MeasuredExperiment scene_experiment(const std::vector<std::string>& scenes, Frame f) {
  MeasuredExperiment e{"scenes", "scene", {}};
  e.points.reserve(scenes.size());
  for (const std::string& scene : scenes) {
    const std::string name =
        scene.starts_with("builtin:") ? scene.substr(8) : std::filesystem::path(scene).stem().string();
    e.points.push_back({name, static_cast<double>(e.points.size() + 1), {}, [=] { return load(scene, f); }});
  }
  return e;
}

}  // namespace

std::vector<MeasuredExperiment> measured_experiments(std::uint32_t width, std::uint32_t height) {
  const Frame f{width, height};
  return {
      vertex_reuse(f),         small_triangles(f),     thin_triangles(f),        setup_rate(f),
      near_plane(f),           quad_overhead(f),       hidden_surfaces(f, true), hidden_surfaces(f, false),
      colour_layers(f, false), colour_layers(f, true), colour_formats(f, false), colour_formats(f, true),
      depth_formats(f),        samples(f, false),      samples(f, true)};
}

std::vector<MeasuredExperiment> chosen_experiments(const std::vector<std::string>& names, std::uint32_t width,
                                                   std::uint32_t height) {
  std::vector<MeasuredExperiment> all = measured_experiments(width, height);
  std::vector<std::string> known;
  known.reserve(all.size());
  for (const MeasuredExperiment& e : all) known.push_back(e.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end())
      throw user_error("there is no experiment '{}'; there are: {}{}", name, fmt::join(known, ", "),
                       did_you_mean(name, known));
  }
  if (!names.empty())
    std::erase_if(
        all, [&](const MeasuredExperiment& e) { return std::ranges::find(names, e.name) == names.end(); });
  return all;
}

std::vector<MeasuredExperiment> chosen_points(const std::vector<std::string>& names,
                                              const std::vector<std::string>& scenes, std::uint32_t width,
                                              std::uint32_t height) {
  if (scenes.empty()) return chosen_experiments(names, width, height);
  if (!names.empty()) throw user_error("--scene: not together with an experiment ({})", names.front());
  return {scene_experiment(scenes, {width, height})};
}

std::string file_name(const MeasuredExperiment& experiment, const Point& point) {
  std::string name = experiment.name + "_" + point.name;
  std::ranges::replace(name, ' ', '_');
  return name;
}

std::string listed(const std::vector<MeasuredExperiment>& experiments) {
  std::string text;
  for (const MeasuredExperiment& e : experiments) {
    text += fmt::format("{} ({}):", e.name, e.axis);
    for (const Point& p : e.points) text += " " + p.name;
    text += "\n";
  }
  return text;
}

}  // namespace quadrille::lavapipe
