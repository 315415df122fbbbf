/// Surfaces by formula: each is a height and a colour over the unit square, painted into a base colour, a
/// normal map and (where it varies) roughness.
#include "scenes/builtin/courtyard_materials.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/builtin/mesh_builder.h"
#include "scenes/builtin/procedural_texture.h"
#include "scenes/data/parallel.h"
#include "scenes/data/rounded_math.h"

namespace quadrille::scenes::courtyard {
namespace {

constexpr std::uint32_t kSize = 512;

// ---- surfaces: uv in 0..1, results linear ----

float paving_height(glm::vec2 uv) {
  return smooth_ramp(0.02F, 0.16F, tiling_cells(uv * 8.0F, 8, 11).border) * 0.8F +
         0.2F * tiling_noise(uv * 32.0F, 32, 3, 12);
}

glm::vec4 paving_color(glm::vec2 uv) {
  const CellPoint cell = tiling_cells(uv * 8.0F, 8, 11);
  const float stone = smooth_ramp(0.02F, 0.10F, cell.border), grain = tiling_noise(uv * 64.0F, 64, 3, 13);
  const glm::vec3 tint =
      glm::mix(glm::vec3(0.36F, 0.32F, 0.27F), glm::vec3(0.55F, 0.50F, 0.43F), cell.random) *
      (0.75F + 0.5F * grain);
  return glm::vec4(glm::mix(glm::vec3(0.12F, 0.11F, 0.09F), tint, stone), 1);
}

/// Red is occlusion, green roughness, blue metal. [glTF2.0 #materials: channels of the two textures]
glm::vec4 paving_surface(glm::vec2 uv) {
  const float height = paving_height(uv);
  return {0.5F + 0.5F * height, 0.95F - 0.4F * height * tiling_noise(uv * 16.0F, 16, 2, 14), 0, 1};
}

float plaster_height(glm::vec2 uv) { return tiling_noise(uv * 16.0F, 16, 5, 21); }

glm::vec4 plaster_color(glm::vec2 uv) {
  const float stain = tiling_noise(uv * 4.0F, 4, 4, 22), grain = tiling_noise(uv * 64.0F, 64, 2, 23);
  return glm::vec4(glm::mix(glm::vec3(0.70F, 0.52F, 0.34F), glm::vec3(0.84F, 0.68F, 0.48F), stain) *
                       (0.88F + 0.2F * grain),
                   1);
}

float stone_height(glm::vec2 uv) {
  const float pit = smooth_ramp(0.62F, 0.75F, tiling_noise(uv * 24.0F, 24, 2, 31));
  return 0.7F * tiling_noise(uv * 8.0F, 8, 4, 32) - 0.5F * pit;
}

glm::vec4 stone_color(glm::vec2 uv) {
  const float vein = tiling_noise(uv * 6.0F, 6, 5, 33);
  return glm::vec4(glm::mix(glm::vec3(0.58F, 0.54F, 0.47F), glm::vec3(0.80F, 0.77F, 0.70F), vein), 1);
}

/// Rows of barrel tiles: a half circle across, a step along.
float roof_height(glm::vec2 uv) {
  const float across = std::abs(2 * (uv.x * 8 - std::floor(uv.x * 8)) - 1),
              along = uv.y * 6 - std::floor(uv.y * 6);
  return 0.8F * std::sqrt(std::max(0.0F, 1 - across * across)) + 0.25F * along;
}

glm::vec4 roof_color(glm::vec2 uv) {
  const float tile = lattice_random(static_cast<int>(uv.x * 8), static_cast<int>(uv.y * 6), 41),
              moss = tiling_noise(uv * 8.0F, 8, 4, 42);
  const glm::vec3 clay = glm::mix(glm::vec3(0.42F, 0.13F, 0.06F), glm::vec3(0.68F, 0.28F, 0.13F), tile);
  return glm::vec4(glm::mix(clay, glm::vec3(0.30F, 0.24F, 0.14F), 0.6F * smooth_ramp(0.55F, 0.8F, moss)), 1);
}

float water_height(glm::vec2 uv) { return tiling_noise(uv * 8.0F, 8, 3, 51); }

glm::vec4 bark_color(glm::vec2 uv) {
  const float ridge = tiling_noise({uv.x * 16, uv.y * 4}, 16, 4, 61);
  return glm::vec4(glm::mix(glm::vec3(0.08F, 0.055F, 0.035F), glm::vec3(0.30F, 0.23F, 0.16F), ridge), 1);
}

glm::vec4 wood_color(glm::vec2 uv) {
  const float grain = tiling_noise({uv.x * 4, uv.y * 64}, 64, 4, 71);
  return glm::vec4(glm::mix(glm::vec3(0.20F, 0.10F, 0.045F), glm::vec3(0.42F, 0.24F, 0.11F), grain), 1);
}

/// A twig of pointed leaves: alpha is one inside a leaf.
glm::vec4 leaf_color(glm::vec2 uv) {
  glm::vec4 color(0.10F, 0.20F, 0.04F, 0);
  for (int i = 0; i < 26; ++i) {
    const glm::vec2 center(0.12F + 0.76F * lattice_random(i, 0, 81),
                           0.12F + 0.76F * lattice_random(i, 1, 81));
    const float angle = 6.2831853F * lattice_random(i, 2, 81), c = cosine(angle), s = sine(angle);
    const glm::vec2 d = uv - center, local(c * d.x + s * d.y, -s * d.x + c * d.y);
    const float along = local.x / 0.115F, width = 0.05F * (1 - along * along);
    if (std::abs(along) >= 1 || std::abs(local.y) >= width) continue;
    const float rib = smooth_ramp(0, 0.006F, std::abs(local.y)), tone = lattice_random(i, 3, 81);
    color = glm::vec4(
        glm::mix(glm::vec3(0.10F, 0.24F, 0.035F), glm::vec3(0.30F, 0.46F, 0.08F), tone) * (0.8F + 0.2F * rib),
        1);
  }
  return color;
}

// ---- painting, on all cores ----

struct Job {
  std::string name;
  std::function<Rgba8Image()> paint;
};

Job colors(const char* name, glm::vec4 (*color)(glm::vec2)) {
  return {name, [color] { return paint(kSize, true, color); }};
}
Job values(const char* name, glm::vec4 (*value)(glm::vec2)) {
  return {name, [value] { return paint(kSize, false, value); }};
}
Job normals(const char* name, float depth, float (*height)(glm::vec2)) {
  return {name, [depth, height] { return paint_normals(kSize, depth, height); }};
}

Material& surface(SceneData& scene, MaterialId id, const char* name, float roughness, float metallic = 0) {
  Material& m = scene.materials[static_cast<std::size_t>(id)];
  m.name = name;
  m.roughness = roughness;
  m.metallic = metallic;
  return m;
}

void use(Material& m, TextureSlot slot, int image) { m.texture(slot).image = image; }

void add_masonry(SceneData& scene, int first) {
  Material& paving = surface(scene, kPaving, "paving", 1);
  use(paving, TextureSlot::kBaseColor, first);
  use(paving, TextureSlot::kNormal, first + 1);
  use(paving, TextureSlot::kMetallicRoughness, first + 2);
  use(paving, TextureSlot::kOcclusion, first + 2);
  Material& plaster = surface(scene, kPlaster, "plaster", 0.9F);
  use(plaster, TextureSlot::kBaseColor, first + 3);
  use(plaster, TextureSlot::kNormal, first + 4);
  Material& stone = surface(scene, kStone, "stone", 0.75F);
  use(stone, TextureSlot::kBaseColor, first + 5);
  use(stone, TextureSlot::kNormal, first + 6);
  Material& roof = surface(scene, kRoof, "roof", 0.8F);
  use(roof, TextureSlot::kBaseColor, first + 7);
  use(roof, TextureSlot::kNormal, first + 8);
  scene.materials[kBasin] = stone;
  Material& basin = surface(scene, kBasin, "basin", 0.45F);
  basin.base_color = {0.82F, 0.86F, 0.88F, 1};
}

void add_plants(SceneData& scene, int bark, int leaves) {
  use(surface(scene, kBark, "bark", 0.95F), TextureSlot::kBaseColor, bark);
  Material& crown = surface(scene, kLeaves, "leaves", 0.6F);
  use(crown, TextureSlot::kBaseColor, leaves);
  crown.alpha = AlphaMode::kMask;
  crown.alpha_cutoff = 0.4F;
  crown.double_sided = true;
  scene.materials[kHedge] = crown;
  surface(scene, kHedge, "hedge", 0.7F).base_color = {0.55F, 0.80F, 0.60F, 1};
}

void add_clear_and_bright(SceneData& scene, int ripples) {
  Material& water = surface(scene, kWater, "water", 0.06F);
  water.base_color = {0.03F, 0.16F, 0.17F, 0.62F};
  water.alpha = AlphaMode::kBlend;
  water.normal_scale = 0.35F;
  use(water, TextureSlot::kNormal, ripples);
  Material& glass = surface(scene, kGlass, "glass", 0.04F);
  glass.base_color = {0.80F, 0.92F, 0.88F, 0.28F};
  glass.alpha = AlphaMode::kBlend;
  surface(scene, kGold, "gold", 0.22F, 1).base_color = {1.0F, 0.72F, 0.29F, 1};
  surface(scene, kIron, "iron", 0.45F, 1).base_color = {0.16F, 0.17F, 0.18F, 1};
  Material& lamp = surface(scene, kLamp, "lamp", 1);
  lamp.emissive = {1.0F, 0.78F, 0.42F};
  surface(scene, kSky, "sky", 1).unlit = true;
}

}  // namespace

void add_materials(SceneData& scene) {
  const std::vector<Job> jobs{colors("paving", paving_color),
                              normals("paving normals", 0.02F, paving_height),
                              values("paving surface", paving_surface),
                              colors("plaster", plaster_color),
                              normals("plaster normals", 0.008F, plaster_height),
                              colors("stone", stone_color),
                              normals("stone normals", 0.02F, stone_height),
                              colors("roof", roof_color),
                              normals("roof normals", 0.05F, roof_height),
                              normals("ripples", 0.05F, water_height),
                              colors("bark", bark_color),
                              colors("leaves", leaf_color),
                              colors("wood", wood_color)};
  std::vector<Rgba8Image> images(jobs.size());
  parallel_for(jobs.size(), [&](std::size_t i) { images[i] = jobs[i].paint(); });
  for (std::size_t i = 0; i < jobs.size(); ++i) add_image(scene, jobs[i].name, std::move(images[i]));
  scene.materials.resize(kMaterialCount);
  add_masonry(scene, 0);
  add_clear_and_bright(scene, 9);
  add_plants(scene, 10, 11);
  use(surface(scene, kWood, "wood", 0.6F), TextureSlot::kBaseColor, 12);
}

}  // namespace quadrille::scenes::courtyard
