#include "cli/scene_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include "models/base/error.h"
#include "models/raster/samples.h"
#include "scenes/builtin/builtin.h"
#include "scenes/environment/environment.h"
#include "scenes/image/compress.h"
#include "scenes/image/image_io.h"
#include "scenes/scene.h"

namespace quadrille::cli {
namespace {

constexpr double kMaxSeconds = 1e6;

/// The extension in lower case, with its dot.
std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

template <class T>
bool read_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

template <std::size_t n>
CLI::IsMember one_of(const std::array<std::string_view, n>& names) {
  return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}

/// Formats of that use, by Vulkan's names.
std::vector<std::string> format_names(models::FormatUse use) {
  std::vector<std::string> names;
  for (int f = 0; f <= static_cast<int>(models::kLastFormat); ++f) {
    const models::FormatInfo& info = models::format_info(static_cast<models::Format>(f));
    if (info.may(use)) names.emplace_back(info.name);
  }
  return names;
}

models::Format format_named(std::string_view name, models::FormatUse use) {
  int f = 0;
  while (f < static_cast<int>(models::kLastFormat)) {
    const models::FormatInfo& info = models::format_info(static_cast<models::Format>(f));
    if (info.name == name && info.may(use)) break;
    ++f;
  }
  return static_cast<models::Format>(f);
}

/// None: chosen by the scene.
std::optional<double> parse_exposure(std::string_view text) {
  double factor = 0;
  if (text == "auto") return std::nullopt;
  if (!read_number(text, factor) || !(factor >= scenes::kLeastExposure && factor <= scenes::kMostExposure))
    throw user_error("--exposure: '{}' is neither a number within {}..{} nor auto", text,
                     scenes::kLeastExposure, scenes::kMostExposure);
  return factor;
}

}  // namespace

std::int64_t parse_whole(std::string_view text, std::string_view flag, std::int64_t least,
                         std::int64_t most) {
  std::int64_t value = 0;
  if (!read_number(text, value) || value < least || value > most) {
    if (most == std::numeric_limits<std::int64_t>::max())
      throw user_error("{}: '{}' is not a whole number of at least {}", flag, text, least);
    throw user_error("{}: '{}' is not a whole number within {}..{}", flag, text, least, most);
  }
  return value;
}

double parse_number(std::string_view text, std::string_view flag, double least, double most) {
  double value = 0;
  if (!read_number(text, value) || !(value >= least && value <= most))
    throw user_error("{}: '{}' is not a number within {}..{}", flag, text, least, most);
  return value;
}

std::pair<std::uint32_t, std::uint32_t> parse_size(std::string_view text, std::string_view flag) {
  const std::size_t x = text.find('x');
  std::uint32_t width = 0, height = 0;
  const bool numbers = x != std::string_view::npos && read_number(text.substr(0, x), width) &&
                       read_number(text.substr(x + 1), height);
  if (!numbers || width < 1 || height < 1 || width > scenes::kMaxImageSide ||
      height > scenes::kMaxImageSide) {
    throw user_error("{}: '{}' is not WIDTHxHEIGHT with sides of 1..{} pixels, as in 1920x1080", flag, text,
                     scenes::kMaxImageSide);
  }
  return {width, height};
}

glm::vec3 parse_point(std::string_view text, std::string_view flag) {
  glm::vec3 point(0);
  std::string_view rest = text;
  bool good = true;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? rest.find(',') : rest.size();
    good = good && comma != std::string_view::npos && read_number(rest.substr(0, comma), point[i]) &&
           std::isfinite(point[i]);
    if (!good) break;
    rest.remove_prefix(std::min(rest.size(), comma + 1));
  }
  if (!good) throw user_error("{}: '{}' is not X,Y,Z, three numbers, as in 1.5,0,-2", flag, text);
  return point;
}

void SceneArguments::add_to(CLI::App& command) {
  command
      .add_option(
          "SCENE", scene,
          "a .gltf or .glb file, a .qtrace or .gfxr file, or builtin:NAME (quadrille scenes lists them)")
      ->required();
  add_view_to(command, "1920x1080");
}

void SceneArguments::add_view_to(CLI::App& command, const std::string& default_size) {
  command
      .add_option("--size", size,
                  "size of the picture in pixels, 1..16384 a side (default " + default_size + ")")
      ->type_name("WxH");
  command
      .add_option("--scene", scene_choice,
                  "which scene of the file, by number from 0 or by name (default: the file's own)")
      ->type_name("N|NAME");
  command
      .add_option("--camera", camera,
                  "which camera of the scene, by number from 0 or by name (default: the first that is "
                  "placed, else one that frames the scene)")
      ->type_name("N|NAME");
  command.add_option("--eye", eye, "a camera of your own stands here, in world units")->type_name("X,Y,Z");
  command.add_option("--at", at, "and looks there")->type_name("X,Y,Z");
  command
      .add_option("--time", time,
                  "poses the scene by its animation, S seconds after its start (default: at rest)")
      ->type_name("S");
  command
      .add_option("--animation", animation,
                  "which animation, by number from 0 or by name, or all of them at once (default: the first)")
      ->type_name("N|NAME|all");
  command
      .add_option("--exposure", exposure,
                  "factor of the light that the file states in lux and candela, and of what its materials "
                  "emit (default: 1); auto: chosen "
                  "so that a "
                  "white wall is almost white, and printed")
      ->type_name("X|auto");
  command
      .add_option("--environment", environment,
                  "light from all around, and the background: a picture of all directions, twice as wide as "
                  "high, in a .hdr or .exr file; or a clear sky, its sun ELEVATION degrees high and AZIMUTH "
                  "degrees from +z towards +x (default: 35,-40; docs/environment.md)")
      ->type_name("F|sky[:ELEVATION[,AZIMUTH]]");
  command
      .add_option("--vert", vert,
                  "vertex shader for all materials: GLSL 4.50, or SPIR-V in a .spv file (docs/shaders.md)")
      ->type_name("F");
  command.add_option("--frag", frag, "fragment shader for all materials, as for --vert")->type_name("F");
  command
      .add_option("--shading", shading,
                  "minimal: one colour; flat, gouraud, phong: lit by face, vertex or fragment; pbr: the "
                  "materials' own (default; docs/lectures.md)")
      ->check(one_of(scenes::kShadingNames));
  command
      .add_option("--order", order,
                  "file: as the scene has it, with a depth test (default); painter: every triangle from back "
                  "to front, without one")
      ->check(one_of(scenes::kDrawOrderNames));
  command
      .add_option(
          "--view", view,
          "shows instead of colours: window depths, how many fragments were written to each pixel, "
          "texture coordinates, world normals, each triangle by a colour of its own, or how many samples "
          "of a pixel a primitive covers: blue all, else from red (one) to yellow")
      ->check(one_of(scenes::kShowingNames));
}

void SceneArguments::add_formats_to(CLI::App& command) {
  command
      .add_option("--color-format", color_format,
                  "what a pixel of the scene's colour attachments is stored as (default: R8G8B8A8_SRGB)")
      ->check(CLI::IsMember(format_names(models::kBlendUse)));
  command.add_option("--depth-format", depth_format, "what its depths are stored as (default: D32_SFLOAT)")
      ->check(CLI::IsMember(format_names(models::kDepthUse)));
}

void SceneArguments::add_samples_to(CLI::App& command) {
  command
      .add_option("--samples", samples,
                  "samples a pixel, 1, 2, 4 or 8: passes draw to attachments of so many and resolve them "
                  "(default: 1, "
                  "or as the trace has them)")
      ->type_name("N");
  command
      .add_option("--anisotropy", anisotropy,
                  "samples along the longer axis of a pixel's footprint, 1 to 16, that textures filtered "
                  "between texels and levels take at most (default: 1, or as the trace has them)")
      ->type_name("N");
  command
      .add_option("--compress", compress,
                  "compresses the textures on load, to see what that saves of bandwidth and costs in the "
                  "picture: bc1: 8 bytes for 4x4 texels, alpha 0 or 1; bc3: 16 bytes; astc: 16 bytes for 4x4 "
                  "texels, and astc5x4 to "
                  "astc12x12 for as many")
      ->check(one_of(scenes::kCompressionNames));
  command.add_flag("--supersample", supersample,
                   "shades each sample for itself, where it lies, instead of each pixel once");
  command.add_flag("--alpha-to-coverage", alpha_to_coverage,
                   "the alpha of materials with an alpha test says which samples stay, so that their edges "
                   "are smoothed too");
}

void SceneArguments::add_queries_to(CLI::App& command) {
  command.add_flag("--queries", queries,
                   "puts an occlusion query around every draw and one of pipeline statistics around every "
                   "pass; a trace may have queries of its own without it");
}

void SceneArguments::use_queries(traces::CommandStream& stream) const {
  if (!queries) return;
  try {
    traces::query_everything(stream);
  } catch (const UserError& error) { throw user_error("--queries: {}: {}", scene, error.what()); }
}

void SceneArguments::add_transparency_to(CLI::App& command) {
  command
      .add_option("--transparency", transparency,
                  "how see-through surfaces are put in order: sorted: draws by the centres of their boxes "
                  "(default); abuffer: all fragments of a pixel by depth; kbuffer: the nearest ones of each "
                  "sample by depth, those behind them as they come")
      ->check(one_of(scenes::kTransparencyNames));
  command
      .add_option("--transparency-layers", transparency_layers,
                  "fragments that a pixel of an A-buffer may have, 1..64 (default 16), or a sample of a "
                  "k-buffer, 1..8 (default 4)")
      ->type_name("K");
}

models::TransparencyState SceneArguments::parse_transparency() const {
  using enum models::Transparency;
  const auto mode = scenes::named(scenes::kTransparencyNames, transparency.value_or("sorted"), kNone);
  if (mode == kNone) {
    if (transparency_layers)
      throw user_error("--transparency-layers: nothing keeps them; add --transparency abuffer or kbuffer");
    return {};
  }
  if (view || order == "painter")
    throw user_error(
        "--transparency: not together with --view or --order painter, which have an order of "
        "their own or blend nothing");
  const std::string layers = transparency_layers.value_or(mode == kAbuffer ? "16" : "4");
  return {mode, static_cast<std::uint8_t>(
                    parse_whole(layers, "--transparency-layers", 1, models::most_layers(mode)))};
}

void SceneArguments::add_trace_to(CLI::App& command) {
  command.add_option("TRACE", scene, "a .qtrace or .gfxr file")->required();
}

bool SceneArguments::is_capture() const { return extension_of(scene) == ".gfxr"; }
bool SceneArguments::is_trace() const { return extension_of(scene) == ".qtrace" || is_capture(); }

scenes::SceneOptions SceneArguments::options() const {
  scenes::SceneOptions options;
  if (size) std::tie(options.width, options.height) = parse_size(*size, "--size");
  // A negative number is neither a number of a camera nor likely its name; the list of the file's own says
  // what there is.
  options.camera_name = camera.value_or("");
  for (const auto& [flag, text] :
       {std::pair{"--camera", &camera}, {"--scene", &scene_choice}, {"--animation", &animation}})
    if (*text && (*text)->empty()) throw user_error("{}: neither a number nor a name", flag);
  for (const auto& [flag, file] : {std::pair{"--vert", &vert}, {"--frag", &frag}})
    if (*file && (*file)->empty()) throw user_error("{}: the name of the file is empty", flag);
  options.scene = scene_choice.value_or("");
  options.animation = animation.value_or("");
  if (time) options.time = parse_number(*time, "--time", 0, kMaxSeconds);
  if (exposure) options.exposure = parse_exposure(*exposure);
  if (eye) options.eye = parse_point(*eye, "--eye");
  if (at) options.at = parse_point(*at, "--at");
  if (camera && (eye || at)) throw user_error("--camera: not together with --eye or --at");
  for (const auto& [flag, given] : {std::pair{"--view", &view}, {"--shading", &shading}}) {
    if (*given && (vert || frag))
      throw user_error("{}: not together with --vert or --frag, which are shaders of their own", flag);
  }
  if (environment) {
    if (vert || frag || view || (shading && *shading != "pbr"))
      throw user_error(
          "--environment: not together with --vert, --frag, --view or a --shading other than pbr, which look "
          "at no map");
    scenes::check_environment(*environment);
    options.environment = *environment;
  }
  if (view && shading) throw user_error("--view: not together with --shading; it shows no shading");
  if (view && color_format)
    throw user_error("--color-format: not together with --view, whose values have a format of their own");
  if (color_format) options.color_format = format_named(*color_format, models::kBlendUse);
  if (depth_format) options.depth_format = format_named(*depth_format, models::kDepthUse);
  options.leave_out = leave_out;
  options.keep_packed = keep_packed;
  if (shading) options.shading = scenes::named(scenes::kShadingNames, *shading, scenes::Shading::kMinimal);
  if (order) options.order = scenes::named(scenes::kDrawOrderNames, *order, scenes::DrawOrder::kFile);
  options.alpha_to_coverage = alpha_to_coverage;
  options.transparency = parse_transparency();
  if (samples) options.samples = parse_samples(*samples);
  if (view) options.shown = scenes::named(scenes::kShowingNames, *view, scenes::Showing::kDepth);
  options.vertex_shader = vert.value_or("");
  options.fragment_shader = frag.value_or("");
  return options;
}

void SceneArguments::check() const {
  if (samples) (void)parse_samples(*samples);
  if (anisotropy) (void)parse_whole(*anisotropy, "--anisotropy", 1, 16);
  if (skip_unsupported && !is_capture())
    throw user_error("--skip-unsupported: {} is no capture; it is for .gfxr files", scene);
  check_cut();
  if (supersample && (samples ? parse_samples(*samples) == 1 : !is_trace()))
    throw user_error("--supersample: one sample a pixel is shaded once anyway; add --samples 2, 4 or 8");
  if (is_trace()) {
    if (size || scene_choice || camera || eye || at || time || animation || exposure || environment || vert ||
        frag || shading || order || view || color_format || depth_format || alpha_to_coverage ||
        transparency || transparency_layers) {
      throw user_error(
          "{}: a trace has its size, camera, pose, light and shaders in it; --size, --scene, --camera, "
          "--eye, --at, --time, --animation, --exposure, --environment, --vert, --frag, --shading, --order, "
          "--view, "
          "--color-format, --depth-format, --alpha-to-coverage, --transparency and --transparency-layers "
          "are for scenes",
          scene);
    }
    return;
  }
  (void)options();
  const std::string extension = extension_of(scene);
  if (scene.starts_with("builtin:") || extension == ".gltf" || extension == ".glb") return;
  throw user_error(
      "{}: not a scene; legal are .gltf, .glb, .qtrace and .gfxr files and builtin:NAME (quadrille scenes "
      "lists "
      "the names){}",
      scene, scenes::meant_builtin(scene.substr(scene.rfind(':') + 1)));
}

void SceneArguments::check_there() const {
  std::error_code unknown;
  if (scene.starts_with("builtin:")) (void)scenes::Scene(scene, options());
  else if (!std::filesystem::exists(scene, unknown)) throw user_error("{}: no such file", scene);
}

}  // namespace quadrille::cli
