#include "scenes/view/world_range.h"

#include <catch2/catch.hpp>
#include <cstring>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/gltf/loader.h"
#include "scenes/record/recorder.h"
#include "scenes/view/camera.h"
#include "tests/scenes/gltf_text.h"

namespace quadrille::scenes {
namespace {

SceneData cubes_times(float scale) {
  SceneData scene = build_cubes();
  for (Instance& instance : scene.instances) {
    for (int c = 0; c < 4; ++c)
      instance.world[c] = glm::vec4(glm::vec3(instance.world[c]) * scale, instance.world[c].w);
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
    if (const auto* push = std::get_if<traces::PushConstants>(&command))
      bytes.insert(bytes.end(), push->data.begin(), push->data.end());
  }
  return bytes;
}

TEST_CASE("world range: every built-in scene is within range and left alone") {
  for (const BuiltinScene& scene : builtin_scenes())
    CHECK_FALSE(needed_range(build_builtin(std::string(scene.name)), SceneOptions{}));
  CHECK_FALSE(needed_range(SceneData{}, SceneOptions{}));
}

TEST_CASE(
    "world range: worlds that differ by a power of two record the same matrices once they are out of range") {
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
  const Placements near = moved(static_cast<const Placements&>(scene), *range);
  CHECK(glm::length(make_view({scene, near}, options).eye) < 100);
  options.at = glm::vec3(1e7F, -1e7F, 1e7F);
  CHECK(glm::dvec3(*moved(options, *range).at) == glm::dvec3(near.instances[0].world[3]));
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
  const auto range = needed_range(scene, SceneOptions{});
  REQUIRE(range);
  CHECK(range->origin == glm::vec3(0));
  const Placements m = moved(static_cast<const Placements&>(scene), *range);
  const auto s = static_cast<float>(range->scale);
  CHECK(m.lights[0].position.x == 0x1p60F * s);
  CHECK(m.lights[0].color.r == Approx(0x1p60F * s * (0x1p60F * s)));
  CHECK(m.lights[0].range == 0x1p61F * s);
  CHECK((*m.cameras[0].pose)[3].z == 0x1p63F * s);
  CHECK((*m.cameras[0].pose)[0].x == 1);
  CHECK(m.cameras[0].near == 0x1p58 * range->scale);
  CHECK(*m.cameras[0].far == 0x1p66 * range->scale);
}

/// Where a frame's draws are before its eye.
struct Seen {
  glm::vec3 eye{0}, light{0};
  std::vector<glm::vec3> places;
};

Seen seen(const traces::CommandStream& stream) {
  Seen result;
  for (const traces::Buffer& buffer : stream.buffers) {
    const auto vector_at = [&](std::size_t offset, glm::vec3& v) {
      std::memcpy(&v, &buffer.data[offset], sizeof(v));
    };
    if (buffer.name == "frame") vector_at(64, result.eye), vector_at(128, result.light);
    if (!buffer.name.ends_with(" instances")) continue;
    for (std::size_t copy = 0; copy < buffer.data.size(); copy += 96) {
      result.places.emplace_back();
      for (int row = 0; row < 3; ++row)
        std::memcpy(&result.places.back()[row], &buffer.data[copy + static_cast<std::size_t>(row) * 16 + 12],
                    sizeof(float));
    }
  }
  const bool instanced = !result.places.empty();
  for (const traces::Command& command : stream.commands) {
    DrawConstants constants;
    const auto* push = std::get_if<traces::PushConstants>(&command);
    if (push == nullptr || instanced) continue;
    std::memcpy(static_cast<void*>(&constants), push->data.data(), push->data.size());
    result.places.emplace_back(constants.model[3]);
  }
  return result;
}

/// Two triangles 0.4 m apart, a camera that looks at them and a lamp between them, all 10^7 m away; `camera`:
/// how far it has moved.
std::string far_pair(double camera) {
  std::string text = triangle_gltf(
      "",
      R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"extensionsUsed":["KHR_lights_punctual"],)"
      R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})",
      R"(,"translation":[10000000.3,0,0]},{"mesh":0,"translation":[10000000.7,0,0]},)"
      R"({"translation":[10000000.5,0,0],"extensions":{"KHR_lights_punctual":{"light":0}}},)" +
          fmt::format(R"({{"camera":0,"translation":[{:.3f},0,5])", 1e7 + camera));
  const std::string nodes = R"("nodes":[0]})";
  return text.replace(text.find(nodes), nodes.size(), R"("nodes":[0,1,2,3]})");
}

TEST_CASE(
    "world range: what is close together far away stays apart, and a camera moves by as little as it is "
    "told") {
  std::vector<Seen> frames;
  for (const double camera : {0.0, 0.1}) {
    const TempGltf file(far_pair(camera));
    frames.push_back(seen(Recorder(load_gltf(file.path()), {}).record()));
    REQUIRE(frames.back().places.size() == 2);
    CHECK(frames.back().places[1].x - frames.back().places[0].x == Approx(0.4).margin(1e-6));
    CHECK(frames.back().places[0].x - frames.back().eye.x == Approx(0.3 - camera).margin(1e-6));
    CHECK(frames.back().light.x == Approx(0.5 - camera).margin(1e-6));
  }
}

TEST_CASE("world range: copies of an instanced draw stay apart far away") {
  SceneData scene = build_cubes();
  scene.instances.resize(1);
  scene.instances[0].copies = 0;
  scene.copies.emplace_back();
  for (const double x : {0.3, 0.7})
    scene.copies[0].push_back(glm::translate(glm::dmat4(1), glm::dvec3(1e7 + x, 0, 0)));
  scene.cameras.resize(1);
  scene.cameras[0].pose = glm::translate(glm::dmat4(1), glm::dvec3(1e7 + 0.1, 0, 5));
  const Seen frame = seen(Recorder(scene, {}).record());
  REQUIRE(frame.places.size() == 2);
  CHECK(frame.places[0].x - frame.eye.x == Approx(0.2).margin(1e-6));
  CHECK(frame.places[1].x - frame.eye.x == Approx(0.6).margin(1e-6));
}

TEST_CASE("world range: the nearest copy decides, not the box around all copies") {
  SceneData scene = build_cubes();
  scene.instances.resize(1);
  scene.instances[0].copies = 0;
  scene.copies = {{glm::dmat4(1), glm::translate(glm::dmat4(1), glm::dvec3(1e7, 0, 0))}};
  scene.cameras.resize(1);
  scene.cameras[0].pose = glm::translate(glm::dmat4(1), glm::dvec3(1e7, 0, 5));
  const auto range = needed_range(scene, SceneOptions{});
  REQUIRE(range);
  CHECK(range->origin.x == 1e7F);
}

TEST_CASE(
    "world range: a scene that is moved is not copied, and its images are unpacked once for all frames") {
  SceneData scene = build_cubes();
  int unpacked = 0;
  scene.images[0] = SceneImage("counted", std::nullopt, [&] {
    ++unpacked;
    return Rgba8Image{2, 2, std::vector<std::uint8_t>(16, 200)};
  });
  for (Instance& instance : scene.instances) instance.world[3] += glm::dvec4(1e7, 0, 0, 0);
  scene.cameras.clear();
  REQUIRE(needed_range(scene, SceneOptions{}));
  for (int frame = 0; frame < 2; ++frame) (void)Recorder(scene, {}).record();
  CHECK(unpacked == 1);
  CHECK_FALSE(scene.images[0].packed());
}

}  // namespace
}  // namespace quadrille::scenes
