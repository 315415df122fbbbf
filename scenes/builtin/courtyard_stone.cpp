/// Ground, walls, arcades and fountain: what is built of stone, and the water in it.
#include <array>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "scenes/builtin/courtyard_materials.h"
#include "scenes/builtin/courtyard_parts.h"
#include "scenes/builtin/procedural_texture.h"
#include "scenes/data/rounded_math.h"

namespace quadrille::scenes::courtyard {
namespace {

glm::vec2 on_profile(const Profile& profile, float v) {
  const float x = glm::clamp(v, 0.0F, 1.0F) * static_cast<float>(profile.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), profile.size() - 2);
  return glm::mix(profile[i], profile[i + 1], x - static_cast<float>(i));
}

/// A wall as seen from the yard; `center` is the middle of its foot, `right` the way its u runs.
void add_wall(SceneData& scene, const Shade& shade, const char* name, const glm::vec3& center,
              const glm::vec3& right) {
  MeshBuilder mesh;
  mesh.patch(160, 48, [&](float u, float v) {
    const float x = 2 * kWall * (u - 0.5F), y = glm::mix(kWallHeight, -0.1F, v);
    const glm::vec3 p = center + right * x + glm::vec3(0, y, 0),
                    inward = glm::cross(right, glm::vec3(0, 1, 0));
    const float contact = 0.7F + 0.3F * smooth_ramp(0, 1.2F, y);
    return PatchPoint{p, glm::vec2(x, -y) * 0.4F,
                      glm::vec4(glm::vec3(contact * shade.at(p + 0.02F * inward)), 1)};
  });
  place(scene,
        mesh.finish(scene, name, kPlaster, {.normal = true, .tangent = true, .uv = true, .color = true}));
}

std::uint32_t make_column(SceneData& scene) {
  MeshBuilder mesh;
  lathe(mesh,
        {{0, 2.32F},
         {0.27F, 2.32F},
         {0.27F, 2.26F},
         {0.20F, 2.20F},
         {0.17F, 2.10F},
         {0.175F, 1.9F},
         {0.185F, 1.2F},
         {0.19F, 0.5F},
         {0.19F, 0.32F},
         {0.24F, 0.27F},
         {0.24F, 0.20F}},
        28, 40, {1, 1.5F});
  mesh.box({-0.29F, 2.32F, -0.29F}, {0.29F, kSpring, 0.29F}, 0.8F);
  mesh.box({-0.28F, 0, -0.28F}, {0.28F, 0.2F, 0.28F}, 0.8F);
  return mesh.finish(scene, "column", kStone, {.normal = true, .tangent = true, .uv = true, .color = false});
}

/// One bay of the arcade, between columns at x = +-1: front, back and the curved underside.
std::uint32_t make_arch(SceneData& scene) {
  constexpr float kThick = 0.2F, kOpening = 0.72F;
  const auto curve = [&](float x) {
    return kSpring + std::sqrt(std::max(0.0F, kOpening * kOpening - x * x));
  };
  MeshBuilder mesh;
  for (const float side : {1.0F, -1.0F}) {
    mesh.patch(64, 6, [&](float u, float v) {
      const float x = side * kBay * (u - 0.5F), y = glm::mix(kTop, curve(x), v);
      return PatchPoint{{x, y, side * kThick}, glm::vec2(x, -y) * 0.5F};
    });
  }
  mesh.patch(64, 3, [&](float u, float v) {
    const float angle = 0.5F * kTurn * u;
    return PatchPoint{{-kOpening * cosine(angle), kSpring + kOpening * sine(angle), kThick * (1 - 2 * v)},
                      {u * 1.2F, v * 0.2F}};
  });
  return mesh.finish(scene, "arch", kPlaster, {.normal = true, .tangent = true, .uv = true, .color = false});
}

/// The lean-to roof of one side, from the wall down over the arches; x along the side.
std::uint32_t make_roof(SceneData& scene) {
  MeshBuilder mesh;
  mesh.patch(288, 24, [&](float u, float v) {
    const float x = 2 * kWall * (u - 0.5F), wave = 0.05F * std::abs(sine(0.5F * kTurn * u * 72));
    return PatchPoint{{x, glm::mix(5.0F, kTop - 0.05F, v) + wave, glm::mix(-kWall, -kArcade + 0.45F, v)},
                      {u * 9, v * 1.4F}};
  });
  return mesh.finish(scene, "roof", kRoof, {.normal = true, .tangent = true, .uv = true, .color = false});
}

void add_water(SceneData& scene, float radius, float height, const char* name) {
  MeshBuilder mesh;
  mesh.patch(48, 12, [&](float u, float v) {
    const float angle = kTurn * u, r = radius * glm::clamp(v, 0.0F, 1.0F);
    const glm::vec3 p(r * sine(angle), height, r * cosine(angle));
    return PatchPoint{p, glm::vec2(p.x, p.z) * 0.5F};
  });
  place(scene,
        mesh.finish(scene, name, kWater, {.normal = true, .tangent = false, .uv = true, .color = false}));
}

}  // namespace

glm::mat4 moved(const glm::vec3& by) { return glm::translate(glm::mat4(1), by); }
glm::mat4 turned(float angle) { return rotation(angle, {0, 1, 0}); }

void lathe(MeshBuilder& mesh, const Profile& profile, std::uint32_t sides, std::uint32_t rings,
           glm::vec2 repeats) {
  mesh.patch(sides, rings, [&](float u, float v) {
    const glm::vec2 p = on_profile(profile, v);
    const float angle = kTurn * u;
    return PatchPoint{{p.x * sine(angle), p.y, p.x * cosine(angle)}, {u * repeats.x, v * repeats.y}};
  });
}

void sphere(MeshBuilder& mesh, const glm::vec3& center, float radius, std::uint32_t sides) {
  mesh.patch(sides, sides / 2, [&](float u, float v) {
    const float angle = kTurn * u, tilt = 0.5F * kTurn * glm::clamp(v, 0.0F, 1.0F);
    return PatchPoint{
        center + radius * glm::vec3(sine(tilt) * sine(angle), cosine(tilt), sine(tilt) * cosine(angle)),
        {u, v}};
  });
}

void add_ground(SceneData& scene, const Shade& shade) {
  MeshBuilder mesh;
  mesh.patch(220, 220, [&](float u, float v) {
    const glm::vec3 p(2 * kWall * (u - 0.5F), 0, 2 * kWall * (v - 0.5F));
    const glm::vec3 bumpy =
        p + glm::vec3(0, 0.03F * (tiling_noise(glm::vec2(u, v) * 32.0F, 32, 2, 3) - 0.5F), 0);
    return PatchPoint{bumpy, glm::vec2(p.x, p.z) * 0.45F,
                      glm::vec4(glm::vec3(shade.at(p + glm::vec3(0, 0.02F, 0))), 1)};
  });
  place(scene,
        mesh.finish(scene, "ground", kPaving, {.normal = true, .tangent = true, .uv = true, .color = true}));
}

void add_walls(SceneData& scene, const Shade& shade) {
  add_wall(scene, shade, "back wall", {0, 0, -kWall}, {1, 0, 0});
  add_wall(scene, shade, "left wall", {-kWall, 0, 0}, {0, 0, -1});
  add_wall(scene, shade, "right wall", {kWall, 0, 0}, {0, 0, 1});
}

void add_arcades(SceneData& scene) {
  const std::uint32_t column = make_column(scene), arch = make_arch(scene), roof = make_roof(scene);
  for (const float angle : {0.0F, 0.25F * kTurn, -0.25F * kTurn}) {
    place(scene, roof, turned(angle));
    for (int i = 0; i <= 8; ++i)
      place(scene, column, turned(angle) * moved({-kArcade + kBay * static_cast<float>(i), 0, -kArcade}));
    for (int i = 0; i < 8; ++i)
      place(scene, arch,
            turned(angle) * moved({-kArcade + kBay * (static_cast<float>(i) + 0.5F), 0, -kArcade}));
  }
}

void add_fountain(SceneData& scene) {
  MeshBuilder stone;
  lathe(stone,
        {{1.80F, 0.12F},
         {1.80F, 0.60F},
         {1.86F, 0.64F},
         {2.02F, 0.64F},
         {2.08F, 0.60F},
         {2.04F, 0.52F},
         {1.96F, 0.46F},
         {1.96F, 0.16F},
         {2.08F, 0.12F},
         {2.10F, 0}},
        96, 36, {8, 1});
  lathe(stone,
        {{0, 1.58F},
         {0.72F, 1.62F},
         {0.80F, 1.68F},
         {0.86F, 1.66F},
         {0.84F, 1.58F},
         {0.62F, 1.44F},
         {0.30F, 1.32F},
         {0.16F, 1.24F},
         {0.14F, 1.0F},
         {0.20F, 0.8F},
         {0.14F, 0.6F},
         {0.26F, 0.3F},
         {0.30F, 0.1F}},
        72, 60, {4, 1.5F});
  lathe(stone, {{0, 2.06F}, {0.07F, 2.05F}, {0.10F, 1.9F}, {0.06F, 1.8F}, {0.12F, 1.6F}}, 32, 16, {1, 0.5F});
  stone.patch(48, 4, [](float u, float v) {  // the floor under the water
    const float angle = kTurn * u, r = 1.82F * glm::clamp(v, 0.0F, 1.0F);
    return PatchPoint{{r * sine(angle), 0.13F, r * cosine(angle)}, {sine(angle) * v, cosine(angle) * v}};
  });
  place(scene, stone.finish(scene, "fountain", kBasin,
                            {.normal = true, .tangent = true, .uv = true, .color = false}));
  MeshBuilder gold;
  sphere(gold, {0, 2.2F, 0}, 0.17F, 48);
  place(scene,
        gold.finish(scene, "finial", kGold, {.normal = true, .tangent = false, .uv = false, .color = false}));
  add_water(scene, 1.81F, 0.47F, "basin water");
  add_water(scene, 0.77F, 1.645F, "bowl water");
}

}  // namespace quadrille::scenes::courtyard
