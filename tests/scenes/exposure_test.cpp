/// Exposure: a factor of the file's light, given or chosen.
#include "scenes/view/exposure.h"
#include "scenes/scene.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "models/base/error.h"
#include "scenes/material/frame_block.h"
#include "scenes/record/recorder.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

/// The triangle, glowing, under a light of this type and intensity three metres before it.
std::string lit(const std::string& type, double intensity, double emission = 0.25) {
  return triangle_gltf(
      R"(,"material":0)",
      fmt::format(
          R"(,"materials":[{{"emissiveFactor":[{0},{0},{0}]}}],"extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"{1}","intensity":{2}}}]}}}})",
          emission, type, intensity),
      R"(,"translation":[0,0,-3],"extensions":{"KHR_lights_punctual":{"light":0}})");
}

traces::CommandStream recorded(const std::string& text, std::optional<double> exposure) {
  const TempGltf file(text);
  SceneOptions options;
  options.width = options.height = 32;
  options.exposure = exposure;
  traces::CommandStream stream = load_scene(file.path(), options);
  stream.name.clear();
  return stream;
}

float chosen(const SceneData& scene) {
  SceneOptions options;
  options.exposure.reset();
  return exposure(scene, options);
}

SceneData square_under(const Light& light, float size = 1) {
  SceneData scene;
  scene.materials.resize(1);
  Primitive p;
  p.bounds.add(glm::vec3(-size, -size, 0));
  p.bounds.add(glm::vec3(size, size, 0));
  scene.primitives.push_back(p);
  scene.instances.push_back({0, glm::dmat4(1), ""});
  scene.lights.push_back(light);
  return scene;
}

}  // namespace

TEST_CASE(
    "exposure: twice is as if the file's lights were twice as strong and its materials glowed twice as "
    "much") {
  for (const char* type : {"directional", "point"}) {
    const auto a = recorded(lit(type, 8, 0.25), 2), b = recorded(lit(type, 16, 0.5), 1);
    REQUIRE(a.buffers == b.buffers);
    REQUIRE(a.commands == b.commands);
    CHECK_FALSE(a.buffers == recorded(lit(type, 8, 0.25), 1).buffers);
  }
}

TEST_CASE("exposure: without lights of the file it is that of the default light and sky") {
  SceneData scene = square_under({});
  scene.lights.clear();
  const View view = make_view(scene, {});
  const auto once = frame_lights(scene, view, 1), twice = frame_lights(scene, view, 2);
  CHECK(twice[0].color == 2.0F * once[0].color);
  scene.environment.sky *= 2.0F;
  scene.environment.ground *= 2.0F;
  const auto bright = frame_block(scene, view, once, 1);
  scene.environment = {};
  CHECK(frame_block(scene, view, once, 2) == bright);
}

TEST_CASE("exposure: chosen, a light of any strength brings what the default light does") {
  for (const float lux : {1e-3F, 2.4F, 2000.0F, 1e5F}) {
    Light sun;
    sun.color = glm::vec3(lux);
    CHECK(chosen(square_under(sun)) * lux == Approx(2.4F).epsilon(1e-4));
    Light lamp;
    lamp.kind = Light::Kind::kPoint;
    lamp.color = glm::vec3(lux);  // candela
    lamp.position = {0, 0, 5};
    CHECK(chosen(square_under(lamp)) * lux / 25 == Approx(2.4F).epsilon(1e-4));
  }
}

TEST_CASE(
    "exposure: chosen where no light reaches anything, it is one, and it is finite where a lamp touches what "
    "it lights") {
  Light spot;
  spot.kind = Light::Kind::kSpot;
  spot.color = glm::vec3(100);
  spot.position = {0, 0, 5};
  spot.direction = {0, 0, 1};  // away
  CHECK(chosen(square_under(spot)) == 1);
  spot.direction = {0, 0, -1};
  CHECK(chosen(square_under(spot)) == Approx(2.4F * 25 / 100));
  spot.range = 4;
  CHECK(chosen(square_under(spot)) == 1);
  spot.kind = Light::Kind::kPoint;
  spot.range = 0;
  spot.position = {0, 0, 0};
  CHECK(chosen(square_under(spot, 4)) == Approx(2.4F * 8 / 100));  // as from a quarter of the diagonal
  CHECK(chosen(SceneData{}) == 1);
}

TEST_CASE("exposure: a factor that is none is refused") {
  SceneOptions options;
  for (const double bad : {0.0, -1.0, 1e13, static_cast<double>(NAN)}) {
    options.exposure = bad;
    CHECK_THROWS_AS(load_scene("builtin:triangle", options), UserError);
  }
}
