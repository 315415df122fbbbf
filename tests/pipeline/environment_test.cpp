/// Maps of the environment on the machine: white surroundings in which nothing may be seen, directions, and
/// the reference's pictures.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/ext/matrix_transform.hpp>

#include "models/reference/compare.h"
#include "models/reference/reference.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/data/environment_map.h"
#include "scenes/environment/prefilter.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"
#include "studies/given_reference.h"
#include "tests/scenes/scene_folder.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

/// A colour for each face of the cube.
std::shared_ptr<const EnvironmentMap> room(const std::array<glm::vec3, 6>& walls) {
  RadianceCube cube(32);
  for (int face = 0; face < 6; ++face) {
    for (std::uint32_t i = 0; i < 32 * 32; ++i)
      cube.at(face, i % 32, i / 32) = walls[static_cast<std::size_t>(face)];
  }
  EnvironmentMap map = prefiltered("room", std::move(cube));
  map.shown = true;
  return std::make_shared<const EnvironmentMap>(std::move(map));
}

/// A square, seen from +z and turned about the y axis.
SceneData square(const Material& material, std::shared_ptr<const EnvironmentMap> map, double angle = 0) {
  SceneData scene;
  scene.name = "square";
  scene.materials.push_back(material);
  MeshBuilder mesh;
  mesh.patch(1, 1, [](float u, float v) { return PatchPoint{{4 * (u - 0.5F), 4 * (0.5F - v), 0}}; });
  place(scene,
        mesh.finish(scene, "square", 0, {.normal = true, .tangent = false, .uv = false, .color = false}),
        glm::rotate(glm::mat4(1), static_cast<float>(angle), glm::vec3(0, 1, 0)));
  scene.environment.map = std::move(map);
  return scene;
}

/// The linear colours of a picture of 8x8 from a place on the z axis.
std::vector<double> seen(const SceneData& scene, float distance = 3) {
  SceneOptions options;
  options.width = options.height = 8;
  options.eye = glm::vec3(0, 0, distance);
  options.at = glm::vec3(0);
  const auto result = models::reference::render(Recorder(scene, options).record(), {});
  return {result.color_linear.begin(), result.color_linear.end()};
}
std::array<double, 3> at(const std::vector<double>& colors, std::size_t column, std::size_t row) {
  const std::size_t i = 4 * (8 * row + column);
  return {colors[i], colors[i + 1], colors[i + 2]};
}

Material metal(float roughness) {
  Material m;
  m.roughness = roughness;
  return m;
}

void check_against_reference(const std::string& scene, SceneOptions options) {
  INFO(scene << " in " << options.environment);
  options.width = 320;
  options.height = 180;
  const auto color = studies::render_with_reference(load_scene(scene, options), {});
  const auto difference =
      models::reference::compare_images({320, 180, color.machine.color}, {320, 180, color.reference.color});
  CHECK(difference.fraction_within(2) >= 0.999);
  CHECK(difference.bad_blocks == 0);
}

}  // namespace

TEST_CASE("environment: in white surroundings a white thing of any roughness and layer is white") {
  std::array<glm::vec3, 6> walls;
  walls.fill(glm::vec3(0.5F));
  const auto white = room(walls);
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.0F, 0.2F, 0.5F, 0.77F, 1.0F}) {
      for (const double angle : {0.0, 0.6, 1.2}) {
        Material m = metal(roughness);
        m.metallic = metallic;
        INFO("metallic " << metallic << ", roughness " << roughness << ", turned by " << angle);
        for (const double value : at(seen(square(m, white, angle)), 4, 4))
          CHECK(value == Approx(0.5).epsilon(0.004));
        m.layers.clearcoat = 1;
        m.layers.clearcoat_roughness = 0.3F;
        for (const double value : at(seen(square(m, white, angle)), 4, 4))
          CHECK(value == Approx(0.5).epsilon(0.004));
      }
    }
  }
}

TEST_CASE("environment: mirrors and the background show the wall in their direction") {
  // red +x, dark red -x, green +y, dark green -y, blue +z, dark blue -z
  const auto walls =
      room({glm::vec3(1, 0, 0), {0.5F, 0, 0}, {0, 1, 0}, {0, 0.5F, 0}, {0, 0, 1}, {0, 0, 0.5F}});
  const auto near = [](double value) { return Approx(value).margin(0.002); };
  CHECK(at(seen(square(metal(0), walls)), 4, 4)[2] == near(1));               // behind the eye
  CHECK(at(seen(square(metal(0), walls, 0.785398)), 4, 4)[0] == near(1));     // to the right
  CHECK(at(seen(square(metal(0), walls, -0.785398)), 4, 4)[0] == near(0.5));  // to the left
  const std::vector<double> away = seen(square(metal(0), walls), 300);
  CHECK(at(away, 0, 4)[2] == near(0.5));
  SceneData scene = square(metal(0), walls, 0.785398);
  EnvironmentMap turned = *walls;
  turned.turn = glm::mat3(0, 0, 1, 0, 1, 0, -1, 0, 0);  // the world's +x is the map's +z
  scene.environment.map = std::make_shared<const EnvironmentMap>(turned);
  CHECK(at(seen(scene), 4, 4)[2] == near(1));
}

TEST_CASE("environment: pictures in a clear sky equal the reference in given mode") {
  SceneOptions options;
  options.environment = "sky:20,150";
  for (const char* scene : {"builtin:materials", "builtin:cubes", "builtin:courtyard", "builtin:outlines"})
    check_against_reference(scene, options);
}

TEST_CASE("environment: a real scene in a clear sky equals the reference in given mode", "[slow]") {
  const auto folder = scene_folder();
  if (!folder) return;
  SceneOptions options;
  options.environment = "sky";
  check_against_reference((*folder / "FlightHelmet_512/FlightHelmet.gltf").string(), options);
}
