#include "scenes/camera.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include <glm/ext/matrix_transform.hpp>

#include "models/base/error.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

SceneData boxes(std::uint32_t seed) {
  std::mt19937 dice(seed);
  const auto random = [&](float low, float high) { return low + (high - low) * static_cast<float>(dice() % 1000) / 1000; };
  SceneData scene;
  scene.name = "boxes";
  scene.materials.resize(1);
  Primitive p;
  p.bounds.add(glm::vec3(-1, -2, -3));
  p.bounds.add(glm::vec3(1, 1, 2));
  scene.primitives.push_back(p);
  const float spread = std::pow(10.0F, random(-3, 4));
  for (int i = 0; i < 5; ++i) {
    const glm::mat4 turn = glm::rotate(glm::mat4(1), random(0, 6), glm::vec3(random(0, 1), 1, random(0, 1)));
    scene.instances.push_back(
        {0, glm::translate(glm::mat4(1), spread * glm::vec3(random(-9, 9), random(-9, 9), random(-9, 9))) * turn, ""});
  }
  return scene;
}

/// Does every corner of every box lie within the clip volume?
bool all_inside(const SceneData& scene, const View& view) {
  bool inside = true;
  for (const Instance& instance : scene.instances) {
    const Bounds box = scene.primitives[0].bounds.transformed(instance.world);
    for (int c = 0; c < 8; ++c) {
      const glm::vec4 corner((c & 1) != 0 ? box.high.x : box.low.x, (c & 2) != 0 ? box.high.y : box.low.y,
                             (c & 4) != 0 ? box.high.z : box.low.z, 1);
      const glm::vec4 clip = view.view_projection * corner;
      inside = inside && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z >= 0 && clip.z <= clip.w;
    }
  }
  return inside;
}

}  // namespace

TEST_CASE("camera: the framing camera holds every box of the scene, at every shape of picture") {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    for (const double aspect : {0.3, 1.0, 16.0 / 9, 5.0}) {
      const SceneData scene = boxes(seed);
      CAPTURE(seed, aspect);
      REQUIRE(all_inside(scene, framing_view(scene, aspect)));
    }
  }
}

TEST_CASE("camera: a perspective camera maps its near plane to 0, its far plane to 1, up to the top") {
  SceneData scene;
  Camera camera;
  camera.yfov = 1.5707963267948966;
  camera.near = 2;
  camera.far = 10;
  camera.pose = glm::mat4(1);
  scene.cameras.push_back(camera);
  SceneOptions options;
  options.width = 200;
  options.height = 100;
  const View view = make_view(scene, options);
  const auto project = [&](glm::vec3 p) {
    const glm::vec4 clip = view.view_projection * glm::vec4(p, 1);
    return glm::vec3(clip) / clip.w;
  };
  REQUIRE(project({0, 0, -2}).z == Approx(0).margin(1e-6));
  REQUIRE(project({0, 0, -10}).z == Approx(1));
  REQUIRE(project({0, 4, -4}).y == Approx(-1));  // window y points down
  REQUIRE(project({8, 0, -4}).x == Approx(1));   // twice as wide as high
  scene.cameras[0].far.reset();
  REQUIRE((make_view(scene, options).view_projection * glm::vec4(0, 0, -2e6F, 1)).z / 2e6F == Approx(1));
}

TEST_CASE("camera: an orthographic camera maps its half height to the edge, and depth linearly") {
  SceneData scene;
  Camera camera;
  camera.perspective = false;
  camera.half_height = 3;
  camera.near = 1;
  camera.far = 5;
  camera.pose = glm::translate(glm::mat4(1), glm::vec3(0, 0, 10));
  scene.cameras.push_back(camera);
  const View view = make_view(scene, {});
  const glm::vec4 clip = view.view_projection * glm::vec4(0, 3, 7, 1);
  REQUIRE(clip.y == Approx(-1));
  REQUIRE(clip.z == Approx(0.5));
  REQUIRE(clip.w == 1);
}

TEST_CASE("camera: a camera that is not there, or not placed, or looks at itself, is refused") {
  SceneData scene = boxes(1);
  scene.cameras.resize(1);
  SceneOptions options;
  options.camera = 1;
  REQUIRE_THROWS_WITH(make_view(scene, options), Catch::Contains("camera '1' does not exist; cameras: 0"));
  options.camera = 0;
  REQUIRE_THROWS_WITH(make_view(scene, options), Catch::Contains("not placed by any node"));
  options.eye = options.at = glm::vec3(1, 2, 3);
  REQUIRE_THROWS_AS(make_view(scene, options), UserError);
}

TEST_CASE("camera: the user's eye sees the scene's centre in the middle, also straight from above") {
  const SceneData scene = boxes(3);
  SceneOptions options;
  for (const glm::vec3 away : {glm::vec3(3, 4, 5), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0)}) {
    const glm::vec3 center = scene.bounds().center();
    options.eye = center + away * scene.bounds().radius();
    const glm::vec4 clip = make_view(scene, options).view_projection * glm::vec4(center, 1);
    REQUIRE(clip.x / clip.w == Approx(0).margin(1e-4));
    REQUIRE(clip.y / clip.w == Approx(0).margin(1e-4));
    REQUIRE(clip.w > 0);
  }
}
