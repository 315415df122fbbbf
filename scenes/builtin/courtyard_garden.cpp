/// Trees, hedges, benches and lamps.
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

/// A square card with a twig on it; normals lean outward from the crown's middle, so that the crown is lit as
/// a body.
void leaf_card(MeshBuilder& mesh, const glm::vec3& at, const glm::vec3& outward, float size, int seed) {
  const glm::vec3 random(lattice_random(seed, 1, 9) - 0.5F, lattice_random(seed, 2, 9) - 0.5F,
                         lattice_random(seed, 3, 9) - 0.5F);
  const glm::vec3 right =
      glm::normalize(glm::cross(outward + random * 1.6F, glm::vec3(0.1F, 1, 0.2F))) * size;
  const glm::vec3 up = glm::normalize(glm::cross(right, outward + random)) * size;
  const float depth = 0.55F + 0.45F * smooth_ramp(-0.9F, 0.9F, outward.y);  // darker below
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
    const float y = 2 * lattice_random(i, 4, 9) - 1, angle = kTurn * lattice_random(i, 5, 9),
                r = std::sqrt(1 - y * y);
    const glm::vec3 outward(r * cosine(angle), y, r * sine(angle));
    const float lump =
        0.62F + 0.75F * tiling_noise(glm::vec2(outward.x + 2, outward.y + outward.z + 4) * 2.0F, 64, 2, 15);
    const float depth = 0.55F + 0.45F * std::sqrt(lattice_random(i, 6, 9));
    leaf_card(mesh, glm::vec3(0, kCrownHeight, 0) + outward * (kCrownRadius * lump * depth), outward, 0.42F,
              i);
  }
  return mesh.finish(scene, "crown", kLeaves, {.normal = true, .tangent = false, .uv = true, .color = true});
}

}  // namespace

void add_trees(SceneData& scene) {
  MeshBuilder trunk;
  trunk.patch(32, 32, [](float u, float v) {
    const float height = 3.4F * (1 - v), angle = kTurn * u;
    const float radius =
        0.11F + 0.10F * v * v + 0.10F * smooth_ramp(0.85F, 1, v) + 0.02F * sine(3 * angle + 4 * height);
    return PatchPoint{{radius * sine(angle) + 0.06F * sine(1.3F * height), height, radius * cosine(angle)},
                      {u * 2, v * 3}};
  });
  const std::uint32_t wood = trunk.finish(scene, "trunk", kBark, {}), crown = make_crown(scene);
  for (std::size_t i = 0; i < kTrees.size(); ++i) {
    const float size = 0.92F + 0.06F * static_cast<float>(i);
    const glm::mat4 world =
        moved(kTrees[i]) * turned(1.7F * static_cast<float>(i)) * glm::scale(glm::mat4(1), glm::vec3(size));
    place(scene, wood, world);
    place(scene, crown, world);
  }
}

void add_planters(SceneData& scene) {
  MeshBuilder trough, hedge;
  trough.box({-1.3F, 0, -0.28F}, {1.3F, 0.42F, 0.28F}, 0.7F);
  for (int i = 0; i < 900; ++i) {
    const glm::vec3 at(2.5F * (lattice_random(i, 11, 9) - 0.5F), 0.42F + 0.34F * lattice_random(i, 12, 9),
                       0.5F * (lattice_random(i, 13, 9) - 0.5F));
    leaf_card(hedge, at, glm::normalize(glm::vec3(0.3F * at.x, at.y, 2.5F * at.z)), 0.26F, i + 5000);
  }
  const std::uint32_t stone =
      trough.finish(scene, "trough", kStone, {.normal = true, .tangent = true, .uv = true, .color = false});
  const std::uint32_t green =
      hedge.finish(scene, "hedge", kHedge, {.normal = true, .tangent = false, .uv = true, .color = true});
  for (const glm::mat4& world : {moved({0, 0, -4.6F}), moved({-4.9F, 0, 0.5F}) * turned(0.25F * kTurn),
                                 moved({5.1F, 0, -0.9F}) * turned(0.25F * kTurn)}) {
    place(scene, stone, world);
    place(scene, green, world);
  }
}

void add_benches(SceneData& scene) {
  MeshBuilder wood;
  for (int i = 0; i < 4; ++i)
    wood.box({-0.8F, 0.44F, -0.2F + 0.11F * static_cast<float>(i)},
             {0.8F, 0.48F, -0.11F + 0.11F * static_cast<float>(i)}, 0.8F);
  for (int i = 0; i < 3; ++i)
    wood.box({-0.8F, 0.58F + 0.13F * static_cast<float>(i), -0.27F},
             {0.8F, 0.67F + 0.13F * static_cast<float>(i), -0.24F}, 0.8F);
  for (const float x : {-0.65F, 0.65F}) {
    wood.box({x - 0.04F, 0, -0.26F}, {x + 0.04F, 0.94F, -0.2F}, 0.8F);
    wood.box({x - 0.04F, 0, 0.14F}, {x + 0.04F, 0.44F, 0.2F}, 0.8F);
  }
  const std::uint32_t bench = wood.finish(scene, "bench", kWood, {});
  for (const glm::mat4& world :
       {moved({2.2F, 0, -5.6F}), moved({-2.2F, 0, -5.6F}), moved({-6.6F, 0, 0.4F}) * turned(0.25F * kTurn)})
    place(scene, bench, world);
}

void add_lamps(SceneData& scene) {
  MeshBuilder iron, glass, core;
  lathe(iron,
        {{0, 2.62F},
         {0.05F, 2.6F},
         {0.12F, 2.5F},
         {0.03F, 2.48F},
         {0.03F, 1.2F},
         {0.06F, 1.15F},
         {0.04F, 1.1F},
         {0.045F, 0.3F},
         {0.11F, 0.2F},
         {0.14F, 0}},
        24, 36, {1, 1});
  sphere(glass, {0, 2.72F, 0}, 0.2F, 40);
  sphere(core, {0, 2.72F, 0}, 0.075F, 24);
  const std::uint32_t post = iron.finish(scene, "lamp post", kIron, {}),
                      bulb = core.finish(scene, "lamp light", kLamp, {});
  const std::uint32_t globe = glass.finish(scene, "lamp globe", kGlass,
                                           {.normal = true, .tangent = false, .uv = false, .color = false});
  for (const glm::vec3& lamp : kLamps) {
    place(scene, post, moved(lamp));
    place(scene, bulb, moved(lamp));
    place(scene, globe, moved(lamp));
  }
}

}  // namespace quadrille::scenes::courtyard
