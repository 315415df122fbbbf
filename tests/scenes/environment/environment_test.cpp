/// Where environments come from: files, skies and scenes of glTF; and what of them a frame records.
#include "scenes/environment/environment.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "models/base/error.h"
#include "scenes/environment/panorama.h"
#include "scenes/environment/prefilter.h"
#include "scenes/environment/sky.h"
#include "scenes/gltf/loader.h"
#include "scenes/scene.h"
#include "scenes/view/exposure.h"
#include "tests/scenes/gltf_text.h"
#include "traces/whole_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const UserError& error) { return error.what(); }
  return "taken";
}

/// Each pixel has its own direction as its colour, from 0 to 1.
FloatImage panorama_of_directions(std::uint32_t width, std::uint32_t channels = 3) {
  FloatImage image{width, width / 2, channels, {}};
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double longitude = ((x + 0.5) / width - 0.5) * 2 * std::numbers::pi,
                   latitude = (0.5 - (y + 0.5) / image.height) * std::numbers::pi;
      const glm::dvec3 d(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                         std::cos(latitude) * std::sin(longitude));
      for (std::uint32_t c = 0; c < channels; ++c)
        image.pixels.push_back(c < 3 ? static_cast<float>(0.5 + 0.5 * d[static_cast<int>(c)]) : 7.0F);
    }
  }
  return image;
}

SceneOptions small(const std::string& environment) {
  SceneOptions options;
  options.width = options.height = 16;
  options.environment = environment;
  return options;
}

std::size_t cubes(const traces::CommandStream& stream) {
  std::size_t count = 0;
  for (const traces::DescriptorSet& set : stream.descriptor_sets) {
    for (const traces::TextureDescriptor& texture : set.textures)
      count += texture.view == traces::ViewKind::kCube ? 1 : 0;
  }
  return count;
}

std::vector<std::string> labels(const traces::CommandStream& stream) {
  std::vector<std::string> result;
  for (const traces::Command& command : stream.commands) {
    if (const auto* draw = std::get_if<traces::Draw>(&command)) result.push_back(draw->label);
  }
  return result;
}

double red_over_blue(const glm::vec3& color) { return static_cast<double>(color.r / color.b); }

/// A PNG of one colour as a data URI.
std::string picture(std::uint32_t side, std::array<std::uint8_t, 4> color) {
  const TempGltf file("", "a.png");
  Rgba8Image image{side, side, {}};
  for (std::uint32_t i = 0; i < side * side; ++i)
    image.pixels.insert(image.pixels.end(), color.begin(), color.end());
  save_png(file.path(), image);
  std::string uri = data_uri(traces::read_whole_file(file.path(), 1 << 20));
  return uri.replace(5, std::string("application/octet-stream").size(), "image/png");
}

/// A triangle lit by a map of two levels, 4x4 and 2x2: +x half, all else black.
std::string image_lit(const std::string& more = "", const std::string& use = R"("light":0)",
                      const std::string& faces = "[[0,1,1,1,1,1],[2,3,3,3,3,3]]") {
  std::string coefficients;
  for (int i = 0; i < 9; ++i) coefficients += i == 0 ? "[3.5449077018,0,0]" : ",[0,0,0]";
  std::string images;
  for (const auto& [side, value] : {std::pair(4, 255), {4, 0}, {2, 255}, {2, 0}}) {
    const auto v = static_cast<std::uint8_t>(value);
    images += fmt::format(R"({}{{"uri":"{}"}})", images.empty() ? "" : ",",
                          picture(static_cast<std::uint32_t>(side), {v, v, v, 51}));
  }
  std::string text = triangle_gltf(
      "",
      fmt::format(
          R"(,"images":[{}],"extensionsUsed":["EXT_lights_image_based"],)"
          R"("extensions":{{"EXT_lights_image_based":{{"lights":[{{"irradianceCoefficients":[{}],"specularImageSize":4,"specularImages":{}{}}}]}}}})",
          images, coefficients, faces, more));
  const std::string scene = R"("scenes":[{)";
  text.insert(text.find(scene) + scene.size(),
              fmt::format(R"("extensions":{{"EXT_lights_image_based":{{{}}}}},)", use));
  return text;
}

}  // namespace

TEST_CASE("environment: a panorama's middle is +x, its upper edge +y, and longitude grows towards +z") {
  for (const std::uint32_t width : {64U, 200U, 1030U, 2048U}) {
    const RadianceCube cube = cube_of_panorama(panorama_of_directions(width, width == 200 ? 4 : 3), "p");
    CHECK(cube.size == (width == 64 ? 16U : width == 200 ? 64U : 256U));
    for (int face = 0; face < 6; ++face) {
      for (std::uint32_t i = 1; i < cube.size; i += cube.size / 5) {
        const glm::dvec3 d = glm::normalize(cube.direction(face, i, cube.size - 1 - i / 2));
        const glm::dvec3 seen = 2.0 * glm::dvec3(cube.at(face, i, cube.size - 1 - i / 2)) - 1.0;
        CHECK(glm::length(seen - d) < 0.03);
      }
    }
  }
}

TEST_CASE("environment: panoramas of other shapes, channels and values are refused with the place") {
  const auto refused = [](FloatImage image) {
    return refusal([&] { (void)cube_of_panorama(std::move(image), "p.hdr"); });
  };
  FloatImage square{4, 4, 3, std::vector<float>(48, 1)};
  CHECK(refused(square) == "p.hdr: 4x4 pixels; a picture of all directions is twice as wide as high");
  CHECK(refused({4, 2, 1, std::vector<float>(8, 1)}) ==
        "p.hdr: 1 channels a pixel; three are due, or four with one that is not looked at");
  FloatImage holed = panorama_of_directions(8);
  holed.pixels[3 * (8 * 2 + 5) + 1] = std::numeric_limits<float>::quiet_NaN();
  CHECK(refused(holed) == "p.hdr: the pixel in column 5, row 2 is not finite");
  FloatImage negative = panorama_of_directions(8);
  std::ranges::fill(negative.pixels, -1.0F);
  const RadianceCube cube = cube_of_panorama(std::move(negative), "p");
  CHECK(cube.texels.front().r == 0);
}

TEST_CASE("environment: words that name neither file nor sky are refused") {
  for (const char* good : {"sky", "sky:1", "sky:90", "sky:12.5,-360", "a.hdr", "b/c.EXR"})
    CHECK(refusal([&] { check_environment(good); }) == "taken");
  for (const char* bad :
       {"sky:", "sky:0", "sky:91", "sky:nan", "sky:35,", "sky:35,361", "sky:35,1,2", "sky:x"})
    CHECK_THAT(refusal([&] { check_environment(bad); }), Catch::StartsWith("--environment: 'sky:"));
  for (const char* bad : {"", "skies", "a.png", "hdr", "a.hdr.gz"})
    CHECK_THAT(refusal([&] { check_environment(bad); }),
               Catch::Contains("is neither a .hdr or .exr file nor sky"));
  CHECK_THAT(refusal([] { (void)load_environment("nowhere.hdr"); }), Catch::StartsWith("nowhere.hdr: "));
}

TEST_CASE(
    "environment: level ground gets three lux of a sky at any height of its sun, redder when it is low") {
  double before = 1000;
  for (const double elevation : {2.0, 10.0, 35.0, 80.0}) {
    const Sky sky = clear_sky({elevation, 90}, 64);
    const auto coefficients = diffuse_coefficients(sky.radiance);
    glm::dvec3 sum = std::numbers::pi * glm::dvec3(diffuse_radiance(coefficients, {0, 1, 0}));
    sum += glm::dvec3(sky.sun.color) * std::max(0.0, -static_cast<double>(sky.sun.direction.y));
    CHECK(glm::dot(sum, glm::dvec3(0.2126, 0.7152, 0.0722)) == Approx(kSkyLux).epsilon(0.06));
    CHECK(sky.sun.direction.x < 0);  // the light of a sun at +x
    CHECK(red_over_blue(sky.sun.color) < before);
    before = red_over_blue(sky.sun.color);
    // away from the sun and high up it is blue
    CHECK(red_over_blue(glm::vec3(sky.radiance.sample({-0.5, 1, 0}))) < 0.9);
  }
  CHECK(before > 1);
}

TEST_CASE("environment: a frame without one has no map, no background and the light that it had") {
  const traces::CommandStream plain = load_scene("builtin:materials", small("")),
                              lit = load_scene("builtin:materials", small("sky"));
  CHECK(cubes(plain) == 0);
  CHECK(std::ranges::count(labels(plain), "background") == 0);
  CHECK(cubes(lit) == 1);
  CHECK(std::ranges::count(labels(lit), "background") == 1);
  CHECK(lit.images.size() == plain.images.size() + 2);
  CHECK(plain.descriptor_sets.size() == lit.descriptor_sets.size());
}

TEST_CASE("environment: the background comes behind what is opaque and before what is seen through") {
  SceneOptions options = small("sky");
  const std::vector<std::string> drawn = labels(load_scene("builtin:materials", options));
  const auto at = [&](std::string_view what) {
    return std::ranges::find_if(drawn, [&](const std::string& label) { return label.starts_with(what); }) -
           drawn.begin();
  };
  CHECK(at("specular-glossiness 6") < at("background"));
  CHECK(at("background") < at("transmission"));
  options.order = DrawOrder::kPainter;
  CHECK(labels(load_scene("builtin:materials", options)).front() == "background");
  options = small("sky");
  options.shading = Shading::kPhong;
  CHECK(cubes(load_scene("builtin:cubes", options)) == 0);
}

TEST_CASE("environment: frames of several passes refuse one") {
  CHECK_THAT(refusal([] { (void)load_scene("builtin:shadow", small("sky")); }),
             Catch::Contains("--environment is not for it"));
}

TEST_CASE("environment: exposure is chosen by its light where the file has none") {
  SceneData scene;
  scene.primitives.emplace_back().bounds.add(glm::vec3(1));
  scene.instances.push_back({0, glm::dmat4(1), ""});
  SceneOptions options;
  options.exposure.reset();
  CHECK(exposure(scene, options) == 1);
  EnvironmentMap map;
  map.irradiance[0] = glm::vec3(10);
  scene.environment.map = std::make_shared<const EnvironmentMap>(map);
  CHECK(exposure(scene, options) == Approx(kKeyLux / 31.4159).epsilon(1e-4));
}

TEST_CASE("environment: a glTF scene's own is read with its levels, harmonics, intensity and rotation") {
  const TempGltf file(image_lit(R"(,"intensity":2,"rotation":[0,0.70710678,0,0.70710678])"));
  const SceneData scene = load_gltf(file.path());
  REQUIRE(scene.environment.map != nullptr);
  const EnvironmentMap& map = *scene.environment.map;
  CHECK(map.size == 4);
  CHECK(map.levels == 2);
  CHECK(!map.shown);
  CHECK(map.texels.size() == 8 * 6 * (16 + 4));
  CHECK(map.scale == 2);
  // 1 over an alpha of 51/255 is 5: 0x4500 as a 16-bit float
  CHECK(map.texels[0] == std::byte{0});
  CHECK(map.texels[1] == std::byte{0x45});
  CHECK(map.texels[8 * 16] == std::byte{0});
  CHECK(map.texels[8 * 16 + 1] == std::byte{0});
  // irradiance 1 everywhere, of which a white surface shows a share of pi, twice
  CHECK(map.irradiance[0].r == Approx(2 * std::numbers::inv_pi));
  // a quarter turn about y brings the map's +x to the world's -z
  const glm::vec3 in_map = map.turn * glm::vec3(0, 0, -1);
  CHECK(in_map.x == Approx(1));
  CHECK(std::abs(in_map.z) < 1e-6);
  CHECK(cubes(load_scene(file.path(), small(""))) == 1);
  CHECK(std::ranges::count(labels(load_scene(file.path(), small(""))), "background") == 0);
  CHECK(std::ranges::count(labels(load_scene(file.path(), small("sky"))), "background") == 1);
}

TEST_CASE("environment: what a glTF scene's own says wrong is refused with the place") {
  CHECK(load_result(image_lit()) == "loaded");
  CHECK_THAT(load_result(image_lit("", R"("light":1)")), Catch::Contains("EXT_lights_image_based"));
  CHECK_THAT(load_result(image_lit("", "")), Catch::Contains("light"));
  CHECK_THAT(load_result(image_lit(R"(,"rotation":[0,0,0,0])")), Catch::Contains("no quaternion"));
  CHECK_THAT(load_result(image_lit(R"(,"intensity":-1)")), Catch::Contains("intensity"));
  CHECK_THAT(load_result(image_lit("", R"("light":0)", "[]")), Catch::Contains("a list is due"));
  CHECK_THAT(load_result(image_lit("", R"("light":0)", "[[0,1,1,1,1]]")),
             Catch::Contains("six images are due"));
  CHECK_THAT(load_result(image_lit("", R"("light":0)", "[[0,1,1,1,1,9]]")),
             Catch::Contains("is not one of the file's 4 images"));
  CHECK_THAT(load_result(image_lit("", R"("light":0)", "[[0,1,1,1,1,2]]")),
             Catch::Contains("has 2x2 pixels; 4 a side are due"));
}
