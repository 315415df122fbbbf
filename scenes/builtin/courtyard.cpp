/// `builtin:courtyard`, the front page: a walled yard with arcades, a fountain, trees and lamps
/// (scenes/builtin/courtyard_*).
#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/builtin/courtyard_materials.h"
#include "scenes/builtin/courtyard_parts.h"
#include "scenes/data/rounded_math.h"

namespace quadrille::scenes {
namespace {

using namespace courtyard;

Shade make_shade() {
  Shade shade;
  shade.add_box({kWall, 0, -kWall}, {kWall + 0.5F, kWallHeight, kWall});
  // roof of the right arcade
  shade.add_box({kArcade - 0.2F, 3.5F, -kArcade}, {kWall, kTop + 0.4F, kArcade});
  shade.add_box({-kArcade, 3.5F, -kWall}, {kArcade, kTop + 0.4F, -kArcade + 0.2F});  // and of the back one
  shade.add_box({-kWall, 3.5F, -kArcade}, {-kArcade + 0.2F, kTop + 0.4F, kArcade});
  for (int i = 0; i <= 8; ++i) {
    const float along = -kArcade + kBay * static_cast<float>(i);
    shade.add_cylinder({along, 0, -kArcade}, kColumn, kSpring);
    shade.add_cylinder({kArcade, 0, along}, kColumn, kSpring);
    shade.add_cylinder({-kArcade, 0, along}, kColumn, kSpring);
  }
  shade.add_cylinder({0, 0, 0}, 2.1F, 0.62F);
  shade.add_cylinder({0, 0, 0}, 0.25F, 1.6F);
  shade.add_cylinder({0, 1.3F, 0}, 0.85F, 0.35F);
  for (const glm::vec3& tree : kTrees) {
    shade.add_crown(tree + glm::vec3(0, kCrownHeight, 0), kCrownRadius * 1.1F);
    shade.add_cylinder(tree, 0.17F, 3);
  }
  for (const glm::vec3& lamp : kLamps) shade.add_cylinder(lamp, 0.06F, 2.6F);
  return shade;
}

/// A dome seen from inside, brighter toward the horizon and the sun.
void add_sky(SceneData& scene) {
  MeshBuilder mesh;
  mesh.patch(64, 24, [](float u, float v) {
    const float angle = -kTurn * u, tilt = 0.27F * kTurn * glm::clamp(v, 0.0F, 1.0F);
    const glm::vec3 d(sine(tilt) * sine(angle), cosine(tilt), sine(tilt) * cosine(angle));
    const float haze = power(1 - std::max(0.0F, d.y), 4.0F),
                glow = power(std::max(0.0F, glm::dot(d, to_sun())), 12.0F);
    const glm::vec3 color = glm::mix(glm::vec3(0.12F, 0.29F, 0.66F), glm::vec3(0.62F, 0.74F, 0.86F), haze) +
                            glow * glm::vec3(0.35F, 0.28F, 0.18F);
    return PatchPoint{60.0F * d, {}, glm::vec4(color, 1)};
  });
  place(scene,
        mesh.finish(scene, "sky", kSky, {.normal = false, .tangent = false, .uv = false, .color = true}));
}

void add_view_and_light(SceneData& scene) {
  Light sun;
  sun.color = glm::vec3(1.0F, 0.93F, 0.80F) * 3.4F;
  sun.direction = -to_sun();
  scene.lights.push_back(sun);
  // scaled down beside the file's own lights, like any scene's
  scene.environment = {{1.05F, 1.22F, 1.50F}, {0.75F, 0.64F, 0.50F}};
  scene.background = {0.45F, 0.60F, 0.78F};
  Camera camera;
  camera.name = "gate";
  camera.yfov = 0.80;
  camera.near = 0.2;
  camera.far = 150;
  const glm::vec3 eye(-2.3F, 2.3F, 9.9F), at(0.3F, 1.85F, -1.2F);
  camera.pose = glm::inverse(glm::lookAt(eye, at, glm::vec3(0, 1, 0)));
  scene.cameras.push_back(camera);
}

}  // namespace

SceneData build_courtyard() {
  SceneData scene;
  add_materials(scene);
  const Shade shade = make_shade();
  add_ground(scene, shade);
  add_walls(scene, shade);
  add_arcades(scene);
  add_fountain(scene);
  add_trees(scene);
  add_planters(scene);
  add_benches(scene);
  add_lamps(scene);
  add_sky(scene);
  add_view_and_light(scene);
  return scene;
}

}  // namespace quadrille::scenes
