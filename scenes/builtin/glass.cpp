/// `builtin:glass`: panes of coloured glass around one axis, and two that lie across them, each through all
/// the others; behind and between them what no one sees through.
#include <array>

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/builtin/procedural_texture.h"
#include "scenes/data/rounded_math.h"

namespace quadrille::scenes {
namespace {

constexpr int kUpright = 10;
constexpr float kHalfTurn = 3.14159265F;

Material matt(const std::string& name, const glm::vec4& color) {
  Material m;
  m.name = name;
  m.base_color = color;
  m.unlit = true;
  m.double_sided = true;
  return m;
}

Material pane(int number) {
  constexpr std::array<glm::vec3, 6> kColors{{{0.85F, 0.12F, 0.10F},
                                              {0.95F, 0.62F, 0.08F},
                                              {0.20F, 0.60F, 0.18F},
                                              {0.08F, 0.45F, 0.70F},
                                              {0.30F, 0.16F, 0.60F},
                                              {0.80F, 0.80F, 0.75F}}};
  const auto c = static_cast<std::size_t>(number) % kColors.size();
  Material m = matt(fmt::format("pane {}", number),
                    glm::vec4(kColors[c], 0.3F + 0.05F * static_cast<float>(number % 5)));
  m.alpha = AlphaMode::kBlend;
  return m;
}

/// A square of the plane z = 0, as large as `half` to each side.
void add_square(SceneData& scene, Material material, float half, const glm::mat4& world) {
  const auto number = static_cast<int>(scene.materials.size());
  const std::string name = material.name;
  scene.materials.push_back(std::move(material));
  MeshBuilder mesh;
  mesh.patch(1, 1, [&](float u, float v) {
    return PatchPoint{{half * (2 * u - 1), half * (1 - 2 * v), 0}, {u, v}};
  });
  place(scene,
        mesh.finish(scene, name, number, {.normal = false, .tangent = false, .uv = true, .color = false}),
        world);
}

}  // namespace

SceneData build_glass() {
  SceneData scene;
  Material wall = matt("wall", glm::vec4(1));
  wall.texture(TextureSlot::kBaseColor).image =
      add_image(scene, "squares", paint(128, true, [](glm::vec2 uv) {
                  const glm::ivec2 square(uv * 12.0F);
                  return (square.x + square.y) % 2 == 0 ? glm::vec4(0.75F, 0.74F, 0.7F, 1)
                                                        : glm::vec4(0.2F, 0.21F, 0.24F, 1);
                }));
  add_square(scene, std::move(wall), 6, glm::translate(glm::mat4(1), {0, 0, -3}));
  const glm::mat4 one(1);
  for (int i = 0; i < kUpright; ++i) {
    const float turn = kHalfTurn * (static_cast<float>(i) + 0.35F) / kUpright;
    add_square(scene, pane(i), 1.25F,
               rotation(turn, {0, 1, 0}) * glm::translate(one, {0.15F * static_cast<float>(i % 3), 0, 0}));
  }
  add_square(scene, pane(kUpright), 1.5F, rotation(1.2F, {1, 0, 0}) * rotation(0.3F, {0, 1, 0}));
  add_square(scene, pane(kUpright + 1), 1.5F, rotation(-1.0F, {1, 0, 0.2F}));
  scene.materials.push_back(matt("core", {0.9F, 0.86F, 0.75F, 1}));
  MeshBuilder core;
  core.box({-0.12F, -1.4F, -0.12F}, {0.12F, 1.4F, 0.12F}, 1);
  place(scene, core.finish(scene, "core", static_cast<int>(scene.materials.size()) - 1,
                           {.normal = false, .tangent = false, .uv = false, .color = false}));
  Camera camera;
  camera.name = "front";
  camera.pose = glm::dmat4(glm::translate(one, {0, 0.35F, 4}) * rotation(-0.09F, {1, 0, 0}));
  camera.yfov = 0.75;
  scene.cameras.push_back(camera);
  scene.background = {0.02F, 0.02F, 0.03F};
  return scene;
}

}  // namespace quadrille::scenes
