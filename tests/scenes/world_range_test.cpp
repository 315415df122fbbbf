#include "scenes/world_range.h"

#include <catch2/catch.hpp>

#include "scenes/builtin.h"
#include "scenes/camera.h"
#include "scenes/recorder.h"

namespace quadrille::scenes {
namespace {

SceneData cubes_times(float scale) {
  SceneData scene = build_cubes();
  for (Instance& instance : scene.instances) {
    for (int c = 0; c < 4; ++c) instance.world[c] = glm::vec4(glm::vec3(instance.world[c]) * scale, instance.world[c].w);
  }
  return scene;
}

/// The bytes that depend on where the world is: uniforms and push constants.
std::vector<std::byte> placed(const traces::CommandStream& stream) {
  std::vector<std::byte> bytes;
  for (const traces::Buffer& buffer : stream.buffers) {
    if (buffer.name == "frame") bytes.insert(bytes.end(), buffer.data.begin(), buffer.data.end());
  }
  for (const traces::Command& command : stream.commands) {
    if (const auto* push = std::get_if<traces::PushConstants>(&command)) bytes.insert(bytes.end(), push->data.begin(), push->data.end());
  }
  return bytes;
}

TEST_CASE("world range: every built-in scene is within range and left alone") {
  for (const BuiltinScene& scene : builtin_scenes()) CHECK_FALSE(needed_range(build_builtin(std::string(scene.name)), {}));
  CHECK_FALSE(needed_range(SceneData{}, {}));
}

TEST_CASE("world range: worlds that differ by a power of two record the same matrices once they are out of range") {
  const auto large = placed(Recorder(cubes_times(0x1p60F), {}).record());
  CHECK(large == placed(Recorder(cubes_times(0x1p100F), {}).record()));
  CHECK(large == placed(Recorder(cubes_times(0x1p-60F), {}).record()));
}

TEST_CASE("world range: an object far away is recorded around the eye") {
  SceneData scene = build_cubes();
  scene.instances.resize(1);
  SceneOptions options;
  scene.instances[0].world[3] = glm::vec4(1e7F, -1e7F, 1e7F, 1);
  const auto range = needed_range(scene, options);
  REQUIRE(range);
  CHECK(range->scale == 1);
  const SceneData near = moved(scene, *range);
  CHECK(glm::length(make_view(near, options).eye) < 100);
  options.at = glm::vec3(1e7F, -1e7F, 1e7F);
  CHECK(moved(options, *range).at == glm::vec3(near.instances[0].world[3]));
}

TEST_CASE("world range: cameras and lights move with the world, and light stays as bright") {
  SceneData scene = cubes_times(0x1p60F);
  Light light;
  light.kind = Light::Kind::kPoint;
  light.position = glm::vec3(0x1p60F, 0, 0);
  light.range = 0x1p61F;
  light.color = glm::vec3(0x1p120F);  // as bright at 2^60 as 1 is at 1
  scene.lights = {light};
  Camera camera;
  camera.pose = glm::mat4(1);
  (*camera.pose)[3] = glm::vec4(0, 0, 0x1p63F, 1);
  camera.near = 0x1p58;
  camera.far = 0x1p66;
  scene.cameras = {camera};
  const auto range = needed_range(scene, {});
  REQUIRE(range);
  CHECK(range->origin == glm::vec3(0));
  const SceneData m = moved(scene, *range);
  const auto s = static_cast<float>(range->scale);
  CHECK(m.lights[0].position.x == 0x1p60F * s);
  CHECK(m.lights[0].color.r == Approx(0x1p60F * s * (0x1p60F * s)));
  CHECK(m.lights[0].range == 0x1p61F * s);
  CHECK((*m.cameras[0].pose)[3].z == 0x1p63F * s);
  CHECK((*m.cameras[0].pose)[0].x == 1);
  CHECK(m.cameras[0].near == 0x1p58 * range->scale);
  CHECK(*m.cameras[0].far == 0x1p66 * range->scale);
}

}  // namespace
}  // namespace quadrille::scenes
