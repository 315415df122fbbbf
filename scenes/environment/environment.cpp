#include "scenes/environment/environment.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <utility>

#include "models/base/error.h"
#include "scenes/environment/panorama.h"
#include "scenes/environment/prefilter.h"
#include "scenes/environment/sky.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {
namespace {

constexpr std::string_view kSky = "sky";
constexpr std::uint32_t kSkySide = 128;
// [G: the largest that are common, 8192x4096]
constexpr std::uint64_t kMaxPanoramaPixels = std::uint64_t{1} << 25;

bool names_sky(const std::string& text) { return text == kSky || text.starts_with("sky:"); }

/// Reads a number within +-`most` at the front of `text`, and removes it.
bool take_number(std::string_view& text, double least, double most, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return error == std::errc{} && value >= least && value <= most;
}

SunPlace sun_place(const std::string& text) {
  SunPlace place;
  if (text == kSky) return place;
  std::string_view rest = std::string_view(text).substr(kSky.size() + 1);
  bool good = take_number(rest, 1, 90, place.elevation);
  if (good && rest.starts_with(',')) {
    rest.remove_prefix(1);
    good = take_number(rest, -360, 360, place.azimuth);
  }
  if (!good || !rest.empty())
    throw user_error(
        "--environment: '{}' is not sky:ELEVATION or sky:ELEVATION,AZIMUTH, degrees of the sun within 1..90 "
        "and -360..360, as in sky:35,-40",
        text.substr(0, 60));
  return place;
}

}  // namespace

void check_environment(const std::string& text) {
  if (names_sky(text)) return (void)sun_place(text);
  std::string extension = std::filesystem::path(text).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".hdr" && extension != ".exr")
    throw user_error(
        "--environment: '{}' is neither a .hdr or .exr file nor sky, sky:ELEVATION or "
        "sky:ELEVATION,AZIMUTH",
        text.substr(0, 200));
}

std::shared_ptr<const EnvironmentMap> load_environment(const std::string& text) {
  check_environment(text);
  EnvironmentMap map;
  if (names_sky(text)) {
    Sky sky = clear_sky(sun_place(text), kSkySide);
    map = prefiltered(text, std::move(sky.radiance));
    map.sun = sky.sun;
  } else {
    map = prefiltered(text, cube_of_panorama(load_float_image(text, kMaxPanoramaPixels), text));
  }
  map.shown = true;
  return std::make_shared<const EnvironmentMap>(std::move(map));
}

}  // namespace quadrille::scenes
