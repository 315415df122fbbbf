/// Arguments that change a frame once it is loaded: which part of it is drawn, with how many samples.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "cli/scene_arguments.h"
#include "models/base/error.h"
#include "models/raster/samples.h"
#include "scenes/image/compress.h"
#include "scenes/scene.h"
#include "traces/cut.h"

namespace quadrille::cli {
namespace {

constexpr std::int64_t kMostPasses = 1 << 20, kMostDraws = 1 << 30;

/// "A..B".
std::pair<std::uint32_t, std::uint32_t> parse_range(const std::string& text, std::string_view flag) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) throw user_error("{}: '{}' is not A..B", flag, text);
  return {static_cast<std::uint32_t>(parse_whole(text.substr(0, dots), flag, 0, kMostDraws)),
          static_cast<std::uint32_t>(parse_whole(text.substr(dots + 2), flag, 0, kMostDraws))};
}

}  // namespace

std::uint32_t parse_samples(std::string_view text) {
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || end != text.data() + text.size() || !models::is_sample_count(count))
    throw user_error("--samples: '{}' is not 1, 2, 4 or 8", text);
  return count;
}

void SceneArguments::add_capture_to(CLI::App& command) {
  command.add_flag("--skip-unsupported", skip_unsupported,
                   "of a .gfxr file: draws without the commands that are not supported, and says which");
  command
      .add_option("--pass", last_pass,
                  "of a trace or capture: ends the frame behind this pass, from 1; what it draws to is the "
                  "picture")
      ->type_name("N");
  command
      .add_option("--draws", draws,
                  "of a trace or capture: keeps these draws, by their numbers from 0 as in the figures")
      ->type_name("A..B");
}

void SceneArguments::check_cut() const {
  if (!last_pass && !draws) return;
  if (!is_trace())
    throw user_error("{}: {} is a scene; it is for .qtrace and .gfxr files", last_pass ? "--pass" : "--draws",
                     scene);
  if (last_pass) (void)parse_whole(*last_pass, "--pass", 1, kMostPasses);
  if (draws) (void)parse_range(*draws, "--draws");
}

void SceneArguments::cut(traces::CommandStream& stream) const {
  if (!last_pass && !draws) return;
  try {
    if (draws) {
      const auto [first, last] = parse_range(*draws, "--draws");
      traces::keep_draws(stream, first, last);
    }
    if (last_pass)
      traces::end_with_pass(stream,
                            static_cast<std::uint32_t>(parse_whole(*last_pass, "--pass", 1, kMostPasses)));
    traces::validate(stream);
  } catch (const UserError& error) { throw user_error("{}: {}", scene, error.what()); }
}

void SceneArguments::use_anisotropy(traces::CommandStream& stream) const {
  if (anisotropy)
    traces::use_anisotropy(stream, static_cast<float>(parse_whole(*anisotropy, "--anisotropy", 1, 16)));
}

void SceneArguments::use_compression(traces::CommandStream& stream) const {
  if (compress)
    (void)scenes::compress_textures(
        stream, scenes::named(scenes::kCompressionNames, *compress, scenes::TextureCompression::kBc1));
}

void SceneArguments::use_samples(traces::CommandStream& stream) const {
  if (supersample) traces::use_sample_shading(stream);
  if (!samples) return;
  try {
    traces::use_samples(stream, parse_samples(*samples));
  } catch (const UserError& error) { throw user_error("--samples: {}: {}", scene, error.what()); }
  const auto keeps_one = [&](const traces::Command& command) {
    const auto* const pass = std::get_if<traces::BeginPass>(&command);
    return pass != nullptr && stream.images[pass->first_image()].samples == 1;
  };
  const auto kept = std::ranges::count_if(stream.commands, keeps_one);
  if (kept > 0 && parse_samples(*samples) > 1)
    fmt::print(stderr,
               "{}: {} of its passes keep one sample a pixel: they load an attachment, or others read "
               "their depth\n",
               scene, kept);
}

}  // namespace quadrille::cli
