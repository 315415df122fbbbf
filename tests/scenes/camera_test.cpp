#include "scenes/view/camera.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <span>

#include <glm/ext/matrix_transform.hpp>

#include "models/base/error.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

SceneData boxes(std::uint32_t seed) {
  std::mt19937 dice(seed);
  const auto random = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(dice() % 1000) / 1000;
  };
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
        {0,
         glm::translate(glm::mat4(1), spread * glm::vec3(random(-9, 9), random(-9, 9), random(-9, 9))) * turn,
         ""});
  }
  return scene;
}

/// Does every corner of every box, where its instance puts it, lie within the clip volume?
bool all_inside(const SceneData& scene, const View& view) {
  bool inside = true;
  const Bounds& box = scene.primitives[0].bounds;
  for (const Instance& instance : scene.instances) {
    for (int c = 0; c < 8; ++c) {
      const glm::dvec4 corner((c & 1) != 0 ? box.high.x : box.low.x, (c & 2) != 0 ? box.high.y : box.low.y,
                              (c & 4) != 0 ? box.high.z : box.low.z, 1);
      const glm::vec4 clip = view.view_projection * glm::vec4(instance.world * corner);
      inside = inside && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z >= 0 &&
               clip.z <= clip.w;
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

namespace {

/// A mesh of these points, seen as it stands.
SceneData points(const std::vector<glm::vec3>& positions, const glm::dmat4& world = glm::dmat4(1)) {
  SceneData scene;
  scene.materials.resize(1);
  Primitive p;
  p.attributes[0] = 0;
  p.count = static_cast<std::uint32_t>(positions.size());
  for (const glm::vec3& at : positions) p.bounds.add(at);
  const auto bytes = std::as_bytes(std::span(positions));
  scene.arrays.push_back(
      {"positions", traces::Format::kR32G32B32Float, p.count, {bytes.begin(), bytes.end()}});
  scene.primitives.push_back(p);
  scene.instances.push_back({0, world, ""});
  return scene;
}

/// A ball, a slanting needle, a flat square, a point and a thing far from the origin: none of them fills its
/// box.
std::vector<SceneData> shapes() {
  std::vector<glm::vec3> ball, square;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k <= 30; ++k) {
      const float a = 0.10471976F * static_cast<float>(i), b = 0.10471976F * static_cast<float>(k);
      ball.emplace_back(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
    }
  }
  for (const float x : {-1.0F, 1.0F}) {
    for (const float y : {-1.0F, 1.0F}) square.emplace_back(x, y, 0);
  }
  const glm::dmat4 turned =
      glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(500, 30, -70)), 0.7, glm::dvec3(0.6, 0, 0.8));
  return {points(ball), points({{0, 0, 0}, {1e-3F, 2e-3F, 1e-3F}}), points(square),
          points(ball, glm::scale(turned, glm::dvec3(3, 0.1, 1)))};
}

/// How much of the picture's width and height the scene takes, and where its middle is, in clip coordinates.
struct Shown {
  glm::vec2 low{INFINITY}, high{-INFINITY};
};

Shown shown(const SceneData& scene, const View& view) {
  Shown s;
  const Array& positions = scene.arrays[0];
  for (std::size_t i = 0; i < positions.count; ++i) {
    glm::vec3 at;
    std::memcpy(&at, &positions.data[i * sizeof(at)], sizeof(at));
    const glm::vec4 clip =
        view.view_projection * glm::vec4(glm::vec3(scene.instances[0].world * glm::dvec4(at, 1)), 1);
    s.low = glm::min(s.low, glm::vec2(clip) / clip.w);
    s.high = glm::max(s.high, glm::vec2(clip) / clip.w);
  }
  return s;
}

}  // namespace

TEST_CASE(
    "camera: what is framed takes 80 % of the picture's height or width, whatever its shape, in the middle") {
  for (const SceneData& scene : shapes()) {
    for (const double aspect : {0.3, 1.0, 16.0 / 9, 5.0}) {
      CAPTURE(aspect);
      const Shown s = shown(scene, framing_view(scene, aspect));
      const glm::vec2 part = (s.high - s.low) / 2.0F, middle = (s.high + s.low) / 2.0F;
      CHECK(std::max(part.x, part.y) == Approx(0.8).epsilon(0.01));
      CHECK((part.x >= part.y ? middle.x : middle.y) == Approx(0).margin(0.01));
      CHECK(std::max(std::abs(middle.x), std::abs(middle.y)) < 0.1F);
    }
  }
}

TEST_CASE("camera: one that goes around keeps the scene within 80 %, and fills them at its worst place") {
  for (const SceneData& scene : shapes()) {
    float most = 0;
    for (int i = 0; i < 32; ++i) {
      const Shown s = shown(scene, framing_view(scene, 1.5, i / 32.0));
      for (const glm::vec2& side : {s.low, s.high})
        most = std::max({most, std::abs(side.x), std::abs(side.y)});
    }
    CHECK(most == Approx(0.8).epsilon(0.01));
  }
}

TEST_CASE("camera: a scene that is a point, or empty, has a camera") {
  for (const SceneData& scene : {points({{3, 4, 5}}), SceneData{}}) {
    const View view = framing_view(scene, 1);
    for (int i = 0; i < 16; ++i) CHECK(std::isfinite(view.view_projection[i / 4][i % 4]));
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
