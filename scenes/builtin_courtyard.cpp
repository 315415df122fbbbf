/// `builtin:courtyard`, the front page: a walled yard with arcades, a fountain, trees and lamps. Metres, y up, the fountain at the origin.
#include <array>
#include <cmath>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scenes/builtin.h"
#include "scenes/courtyard_materials.h"
#include "scenes/courtyard_shade.h"
#include "scenes/mesh_builder.h"
#include "scenes/procedural_texture.h"

namespace quadrille::scenes {
namespace {

using namespace courtyard;

constexpr float kTurn = 2 * std::numbers::pi_v<float>;
constexpr float kWall = 11;          // inner face of the walls
constexpr float kWallHeight = 6.2F;
constexpr float kArcade = 8;         // axis of the columns
constexpr float kBay = 2;            // from column to column
constexpr float kSpring = 2.5F;      // where the arches start
constexpr float kTop = 3.9F;         // top of the arcade
constexpr float kColumn = 0.19F;
constexpr std::array<glm::vec3, 4> kTrees{{{-5.2F, 0, -3.6F}, {4.9F, 0, -4.4F}, {-6.1F, 0, 4.4F}, {5.6F, 0, 2.6F}}};
constexpr std::array<glm::vec3, 4> kLamps{{{-3.1F, 0, -2.6F}, {3.1F, 0, -2.6F}, {-3.1F, 0, 3.0F}, {3.1F, 0, 3.0F}}};
constexpr float kCrownHeight = 3.7F, kCrownRadius = 1.75F;

glm::mat4 moved(const glm::vec3& by) { return glm::translate(glm::mat4(1), by); }
glm::mat4 turned(float angle) { return glm::rotate(glm::mat4(1), angle, glm::vec3(0, 1, 0)); }

/// Radius and height along a turned shape, from its top (v = 0) to its foot (v = 1).
using Profile = std::vector<glm::vec2>;

glm::vec2 on_profile(const Profile& profile, float v) {
  const float x = glm::clamp(v, 0.0F, 1.0F) * static_cast<float>(profile.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), profile.size() - 2);
  return glm::mix(profile[i], profile[i + 1], x - static_cast<float>(i));
}

/// Turns a profile around the y axis; seen from outside u goes right. `repeats` of the texture around, and a metre up.
void lathe(MeshBuilder& mesh, const Profile& profile, std::uint32_t sides, std::uint32_t rings, glm::vec2 repeats) {
  mesh.patch(sides, rings, [&](float u, float v) {
    const glm::vec2 p = on_profile(profile, v);
    const float angle = kTurn * u;
    return PatchPoint{{p.x * std::sin(angle), p.y, p.x * std::cos(angle)}, {u * repeats.x, v * repeats.y}};
  });
}

void sphere(MeshBuilder& mesh, const glm::vec3& center, float radius, std::uint32_t sides) {
  mesh.patch(sides, sides / 2, [&](float u, float v) {
    const float angle = kTurn * u, tilt = 0.5F * kTurn * glm::clamp(v, 0.0F, 1.0F);
    return PatchPoint{center + radius * glm::vec3(std::sin(tilt) * std::sin(angle), std::cos(tilt), std::sin(tilt) * std::cos(angle)), {u, v}};
  });
}

Shade make_shade() {
  Shade shade;
  shade.add_box({kWall, 0, -kWall}, {kWall + 0.5F, kWallHeight, kWall});
  shade.add_box({kArcade - 0.2F, 3.5F, -kArcade}, {kWall, kTop + 0.4F, kArcade});        // roof of the right arcade
  shade.add_box({-kArcade, 3.5F, -kWall}, {kArcade, kTop + 0.4F, -kArcade + 0.2F});      // and of the back one
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

void add_ground(SceneData& scene, const Shade& shade) {
  MeshBuilder mesh;
  mesh.patch(220, 220, [&](float u, float v) {
    const glm::vec3 p(2 * kWall * (u - 0.5F), 0, 2 * kWall * (v - 0.5F));
    const glm::vec3 bumpy = p + glm::vec3(0, 0.03F * (tiling_noise(glm::vec2(u, v) * 32.0F, 32, 2, 3) - 0.5F), 0);
    return PatchPoint{bumpy, glm::vec2(p.x, p.z) * 0.45F, glm::vec4(glm::vec3(shade.at(p + glm::vec3(0, 0.02F, 0))), 1)};
  });
  place(scene, mesh.finish(scene, "ground", kPaving, {.normal = true, .tangent = true, .uv = true, .color = true}));
}

/// A wall as seen from the yard; `center` is the middle of its foot, `right` the way its u runs.
void add_wall(SceneData& scene, const Shade& shade, const char* name, const glm::vec3& center, const glm::vec3& right) {
  MeshBuilder mesh;
  mesh.patch(160, 48, [&](float u, float v) {
    const float x = 2 * kWall * (u - 0.5F), y = glm::mix(kWallHeight, -0.1F, v);
    const glm::vec3 p = center + right * x + glm::vec3(0, y, 0), inward = glm::cross(right, glm::vec3(0, 1, 0));
    const float contact = 0.7F + 0.3F * smooth_ramp(0, 1.2F, y);
    return PatchPoint{p, glm::vec2(x, -y) * 0.4F, glm::vec4(glm::vec3(contact * shade.at(p + 0.02F * inward)), 1)};
  });
  place(scene, mesh.finish(scene, name, kPlaster, {.normal = true, .tangent = true, .uv = true, .color = true}));
}

std::uint32_t make_column(SceneData& scene) {
  MeshBuilder mesh;
  lathe(mesh, {{0, 2.32F}, {0.27F, 2.32F}, {0.27F, 2.26F}, {0.20F, 2.20F}, {0.17F, 2.10F}, {0.175F, 1.9F}, {0.185F, 1.2F}, {0.19F, 0.5F}, {0.19F, 0.32F}, {0.24F, 0.27F}, {0.24F, 0.20F}}, 28, 40, {1, 1.5F});
  mesh.box({-0.29F, 2.32F, -0.29F}, {0.29F, kSpring, 0.29F}, 0.8F);
  mesh.box({-0.28F, 0, -0.28F}, {0.28F, 0.2F, 0.28F}, 0.8F);
  return mesh.finish(scene, "column", kStone, {.normal = true, .tangent = true, .uv = true, .color = false});
}

/// One bay of the arcade, between columns at x = +-1: front, back and the curved underside.
std::uint32_t make_arch(SceneData& scene) {
  constexpr float kThick = 0.2F, kOpening = 0.72F;
  const auto curve = [&](float x) { return kSpring + std::sqrt(std::max(0.0F, kOpening * kOpening - x * x)); };
  MeshBuilder mesh;
  for (const float side : {1.0F, -1.0F}) {
    mesh.patch(64, 6, [&](float u, float v) {
      const float x = side * kBay * (u - 0.5F), y = glm::mix(kTop, curve(x), v);
      return PatchPoint{{x, y, side * kThick}, glm::vec2(x, -y) * 0.5F};
    });
  }
  mesh.patch(64, 3, [&](float u, float v) {
    const float angle = 0.5F * kTurn * u;
    return PatchPoint{{-kOpening * std::cos(angle), kSpring + kOpening * std::sin(angle), kThick * (1 - 2 * v)}, {u * 1.2F, v * 0.2F}};
  });
  return mesh.finish(scene, "arch", kPlaster, {.normal = true, .tangent = true, .uv = true, .color = false});
}

/// The lean-to roof of one side, from the wall down over the arches; x along the side.
std::uint32_t make_roof(SceneData& scene) {
  MeshBuilder mesh;
  mesh.patch(288, 24, [&](float u, float v) {
    const float x = 2 * kWall * (u - 0.5F), wave = 0.05F * std::abs(std::sin(0.5F * kTurn * u * 72));
    return PatchPoint{{x, glm::mix(5.0F, kTop - 0.05F, v) + wave, glm::mix(-kWall, -kArcade + 0.45F, v)}, {u * 9, v * 1.4F}};
  });
  return mesh.finish(scene, "roof", kRoof, {.normal = true, .tangent = true, .uv = true, .color = false});
}

void add_arcades(SceneData& scene) {
  const std::uint32_t column = make_column(scene), arch = make_arch(scene), roof = make_roof(scene);
  for (const float angle : {0.0F, 0.25F * kTurn, -0.25F * kTurn}) {
    place(scene, roof, turned(angle));
    for (int i = 0; i <= 8; ++i) place(scene, column, turned(angle) * moved({-kArcade + kBay * static_cast<float>(i), 0, -kArcade}));
    for (int i = 0; i < 8; ++i) place(scene, arch, turned(angle) * moved({-kArcade + kBay * (static_cast<float>(i) + 0.5F), 0, -kArcade}));
  }
}

void add_water(SceneData& scene, float radius, float height, const char* name) {
  MeshBuilder mesh;
  mesh.patch(48, 12, [&](float u, float v) {
    const float angle = kTurn * u, r = radius * glm::clamp(v, 0.0F, 1.0F);
    const glm::vec3 p(r * std::sin(angle), height, r * std::cos(angle));
    return PatchPoint{p, glm::vec2(p.x, p.z) * 0.5F};
  });
  place(scene, mesh.finish(scene, name, kWater, {.normal = true, .tangent = false, .uv = true, .color = false}));
}

void add_fountain(SceneData& scene) {
  MeshBuilder stone;
  lathe(stone, {{1.80F, 0.12F}, {1.80F, 0.60F}, {1.86F, 0.64F}, {2.02F, 0.64F}, {2.08F, 0.60F}, {2.04F, 0.52F}, {1.96F, 0.46F}, {1.96F, 0.16F}, {2.08F, 0.12F}, {2.10F, 0}}, 96, 36, {8, 1});
  lathe(stone, {{0, 1.58F}, {0.72F, 1.62F}, {0.80F, 1.68F}, {0.86F, 1.66F}, {0.84F, 1.58F}, {0.62F, 1.44F}, {0.30F, 1.32F}, {0.16F, 1.24F}, {0.14F, 1.0F}, {0.20F, 0.8F}, {0.14F, 0.6F}, {0.26F, 0.3F}, {0.30F, 0.1F}}, 72, 60, {4, 1.5F});
  lathe(stone, {{0, 2.06F}, {0.07F, 2.05F}, {0.10F, 1.9F}, {0.06F, 1.8F}, {0.12F, 1.6F}}, 32, 16, {1, 0.5F});
  stone.patch(48, 4, [](float u, float v) {   // the floor under the water
    const float angle = kTurn * u, r = 1.82F * glm::clamp(v, 0.0F, 1.0F);
    return PatchPoint{{r * std::sin(angle), 0.13F, r * std::cos(angle)}, {std::sin(angle) * v, std::cos(angle) * v}};
  });
  place(scene, stone.finish(scene, "fountain", kBasin, {.normal = true, .tangent = true, .uv = true, .color = false}));
  MeshBuilder gold;
  sphere(gold, {0, 2.2F, 0}, 0.17F, 48);
  place(scene, gold.finish(scene, "finial", kGold, {.normal = true, .tangent = false, .uv = false, .color = false}));
  add_water(scene, 1.81F, 0.47F, "basin water");
  add_water(scene, 0.77F, 1.645F, "bowl water");
}

/// A square card with a twig on it; normals lean outward from the crown's middle, so that the crown is lit as a body.
void leaf_card(MeshBuilder& mesh, const glm::vec3& at, const glm::vec3& outward, float size, int seed) {
  const glm::vec3 random(lattice_random(seed, 1, 9) - 0.5F, lattice_random(seed, 2, 9) - 0.5F, lattice_random(seed, 3, 9) - 0.5F);
  const glm::vec3 right = glm::normalize(glm::cross(outward + random * 1.6F, glm::vec3(0.1F, 1, 0.2F))) * size;
  const glm::vec3 up = glm::normalize(glm::cross(right, outward + random)) * size;
  const float depth = 0.55F + 0.45F * smooth_ramp(-0.9F, 0.9F, outward.y);   // darker below
  std::array<std::uint32_t, 4> corner{};
  for (std::size_t i = 0; i < 4; ++i) {
    const float x = i == 1 || i == 2 ? 1.0F : 0.0F, y = i >= 2 ? 1.0F : 0.0F;
    MeshBuilder::Vertex v;
    v.position = at + right * (x - 0.5F) + up * (y - 0.5F);
    v.normal = glm::normalize(outward + 0.35F * random);
    v.uv = {x, 1 - y};
    v.color = glm::vec4(glm::vec3(depth), 1);
    corner[i] = mesh.vertex(v);
  }
  mesh.triangle(corner[0], corner[1], corner[2]);
  mesh.triangle(corner[0], corner[2], corner[3]);
}

std::uint32_t make_crown(SceneData& scene) {
  constexpr int kCards = 4200;
  MeshBuilder mesh;
  for (int i = 0; i < kCards; ++i) {
    const float y = 2 * lattice_random(i, 4, 9) - 1, angle = kTurn * lattice_random(i, 5, 9), r = std::sqrt(1 - y * y);
    const glm::vec3 outward(r * std::cos(angle), y, r * std::sin(angle));
    const float lump = 0.62F + 0.75F * tiling_noise(glm::vec2(outward.x + 2, outward.y + outward.z + 4) * 2.0F, 64, 2, 15);
    const float depth = 0.55F + 0.45F * std::sqrt(lattice_random(i, 6, 9));
    leaf_card(mesh, glm::vec3(0, kCrownHeight, 0) + outward * (kCrownRadius * lump * depth), outward, 0.42F, i);
  }
  return mesh.finish(scene, "crown", kLeaves, {.normal = true, .tangent = false, .uv = true, .color = true});
}

void add_trees(SceneData& scene) {
  MeshBuilder trunk;
  trunk.patch(32, 32, [](float u, float v) {
    const float height = 3.4F * (1 - v), angle = kTurn * u;
    const float radius = 0.11F + 0.10F * v * v + 0.10F * smooth_ramp(0.85F, 1, v) + 0.02F * std::sin(3 * angle + 4 * height);
    return PatchPoint{{radius * std::sin(angle) + 0.06F * std::sin(1.3F * height), height, radius * std::cos(angle)}, {u * 2, v * 3}};
  });
  const std::uint32_t wood = trunk.finish(scene, "trunk", kBark, {}), crown = make_crown(scene);
  for (std::size_t i = 0; i < kTrees.size(); ++i) {
    const float size = 0.92F + 0.06F * static_cast<float>(i);
    const glm::mat4 world = moved(kTrees[i]) * turned(1.7F * static_cast<float>(i)) * glm::scale(glm::mat4(1), glm::vec3(size));
    place(scene, wood, world);
    place(scene, crown, world);
  }
}

/// Stone troughs with clipped hedges between the lamps.
void add_planters(SceneData& scene) {
  MeshBuilder trough, hedge;
  trough.box({-1.3F, 0, -0.28F}, {1.3F, 0.42F, 0.28F}, 0.7F);
  for (int i = 0; i < 900; ++i) {
    const glm::vec3 at(2.5F * (lattice_random(i, 11, 9) - 0.5F), 0.42F + 0.34F * lattice_random(i, 12, 9), 0.5F * (lattice_random(i, 13, 9) - 0.5F));
    leaf_card(hedge, at, glm::normalize(glm::vec3(0.3F * at.x, at.y, 2.5F * at.z)), 0.26F, i + 5000);
  }
  const std::uint32_t stone = trough.finish(scene, "trough", kStone, {.normal = true, .tangent = true, .uv = true, .color = false});
  const std::uint32_t green = hedge.finish(scene, "hedge", kHedge, {.normal = true, .tangent = false, .uv = true, .color = true});
  for (const glm::mat4& world : {moved({0, 0, -4.6F}), moved({-4.9F, 0, 0.5F}) * turned(0.25F * kTurn), moved({5.1F, 0, -0.9F}) * turned(0.25F * kTurn)}) {
    place(scene, stone, world);
    place(scene, green, world);
  }
}

void add_benches(SceneData& scene) {
  MeshBuilder wood;
  for (int i = 0; i < 4; ++i) wood.box({-0.8F, 0.44F, -0.2F + 0.11F * static_cast<float>(i)}, {0.8F, 0.48F, -0.11F + 0.11F * static_cast<float>(i)}, 0.8F);
  for (int i = 0; i < 3; ++i) wood.box({-0.8F, 0.58F + 0.13F * static_cast<float>(i), -0.27F}, {0.8F, 0.67F + 0.13F * static_cast<float>(i), -0.24F}, 0.8F);
  for (const float x : {-0.65F, 0.65F}) {
    wood.box({x - 0.04F, 0, -0.26F}, {x + 0.04F, 0.94F, -0.2F}, 0.8F);
    wood.box({x - 0.04F, 0, 0.14F}, {x + 0.04F, 0.44F, 0.2F}, 0.8F);
  }
  const std::uint32_t bench = wood.finish(scene, "bench", kWood, {});
  for (const glm::mat4& world : {moved({2.2F, 0, -5.6F}), moved({-2.2F, 0, -5.6F}), moved({-6.6F, 0, 0.4F}) * turned(0.25F * kTurn)}) place(scene, bench, world);
}

void add_lamps(SceneData& scene) {
  MeshBuilder iron, glass, core;
  lathe(iron, {{0, 2.62F}, {0.05F, 2.6F}, {0.12F, 2.5F}, {0.03F, 2.48F}, {0.03F, 1.2F}, {0.06F, 1.15F}, {0.04F, 1.1F}, {0.045F, 0.3F}, {0.11F, 0.2F}, {0.14F, 0}}, 24, 36, {1, 1});
  sphere(glass, {0, 2.72F, 0}, 0.2F, 40);
  sphere(core, {0, 2.72F, 0}, 0.075F, 24);
  const std::uint32_t post = iron.finish(scene, "lamp post", kIron, {}), bulb = core.finish(scene, "lamp light", kLamp, {});
  const std::uint32_t globe = glass.finish(scene, "lamp globe", kGlass, {.normal = true, .tangent = false, .uv = false, .color = false});
  for (const glm::vec3& lamp : kLamps) {
    place(scene, post, moved(lamp));
    place(scene, bulb, moved(lamp));
    place(scene, globe, moved(lamp));
  }
}

/// A dome seen from inside, brighter toward the horizon and the sun.
void add_sky(SceneData& scene) {
  MeshBuilder mesh;
  mesh.patch(64, 24, [](float u, float v) {
    const float angle = -kTurn * u, tilt = 0.27F * kTurn * glm::clamp(v, 0.0F, 1.0F);
    const glm::vec3 d(std::sin(tilt) * std::sin(angle), std::cos(tilt), std::sin(tilt) * std::cos(angle));
    const float haze = std::pow(1 - std::max(0.0F, d.y), 4.0F), glow = std::pow(std::max(0.0F, glm::dot(d, to_sun())), 12.0F);
    const glm::vec3 color = glm::mix(glm::vec3(0.12F, 0.29F, 0.66F), glm::vec3(0.62F, 0.74F, 0.86F), haze) + glow * glm::vec3(0.35F, 0.28F, 0.18F);
    return PatchPoint{60.0F * d, {}, glm::vec4(color, 1)};
  });
  place(scene, mesh.finish(scene, "sky", kSky, {.normal = false, .tangent = false, .uv = false, .color = true}));
}

void add_view_and_light(SceneData& scene) {
  Light sun;
  sun.color = glm::vec3(1.0F, 0.93F, 0.80F) * 3.4F;
  sun.direction = -to_sun();
  scene.lights.push_back(sun);
  scene.environment = {{1.05F, 1.22F, 1.50F}, {0.75F, 0.64F, 0.50F}};   // scaled down beside the file's own lights, like any scene's
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
  add_wall(scene, shade, "back wall", {0, 0, -kWall}, {1, 0, 0});
  add_wall(scene, shade, "left wall", {-kWall, 0, 0}, {0, 0, -1});
  add_wall(scene, shade, "right wall", {kWall, 0, 0}, {0, 0, 1});
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
