/// `builtin:materials`: a wall of spheres, a row for each extension of glTF's materials, its parameter
/// growing from left to right; the last of a row has textures.
#include <array>

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/builtin/procedural_texture.h"
#include "scenes/data/rounded_math.h"

namespace quadrille::scenes {
namespace {

constexpr int kRows = 7, kColumns = 7;
constexpr float kPi = 3.14159265F, kPitch = 1.15F, kRadius = 0.5F;

/// Stripes of two values along u, the same in all channels.
Rgba8Image stripes(bool srgb, const glm::vec4& a, const glm::vec4& b) {
  return paint(64, srgb, [&](glm::vec2 uv) { return static_cast<int>(uv.x * 12) % 2 == 0 ? a : b; });
}

struct Textures {
  int mask = -1, color = -1, normal = -1;
};

Material plain(const std::string& name, const glm::vec3& color, float metallic, float roughness) {
  Material m;
  m.name = name;
  m.base_color = glm::vec4(color, 1);
  m.metallic = metallic;
  m.roughness = roughness;
  return m;
}

glm::vec3 reflectance_of(float ior) {
  const float r = (ior - 1) / (ior + 1);
  return glm::vec3(r * r);
}

Material ior(int i, const Textures&) {
  constexpr std::array<float, kColumns> kIor{1.0F, 1.2F, 1.33F, 1.5F, 1.8F, 2.4F, 4.0F};
  const float value = kIor[static_cast<std::size_t>(i)];
  Material m = plain(fmt::format("ior {}", value), {0.04F, 0.08F, 0.16F}, 0, 0.12F);
  m.layers.specular = true;
  m.layers.specular_color = reflectance_of(value);
  return m;
}

Material specular(int i, const Textures& t) {
  const float x = static_cast<float>(i) / 5;
  Material m = plain("specular", {0.10F, 0.11F, 0.13F}, 0, 0.15F);
  m.layers.specular = true;
  m.layers.specular_color = glm::vec3(0.04F) * glm::mix(glm::vec3(1), glm::vec3(8, 4, 1), x);
  m.layers.specular_weight = x;
  if (i < kColumns - 1) return m;
  m.layers.specular_weight = 1;
  m.layers.specular_color = glm::vec3(0.6F);
  m.texture(TextureSlot::kSpecular).image = t.mask;
  m.texture(TextureSlot::kSpecularColor).image = t.color;
  return m;
}

Material clearcoat(int i, const Textures& t) {
  Material m = plain("clearcoat", {0.55F, 0.04F, 0.03F}, 0.6F, 0.55F);
  m.texture(TextureSlot::kNormal).image = t.normal;
  m.layers.clearcoat = i == 0 ? 0.0F : 1.0F;
  m.layers.clearcoat_roughness = 0.12F * static_cast<float>(std::max(i - 1, 0));
  if (i < kColumns - 1) return m;
  m.layers.clearcoat_roughness = 0.8F;
  m.texture(TextureSlot::kClearcoat).image = t.mask;
  m.texture(TextureSlot::kClearcoatRoughness).image = t.color;
  m.texture(TextureSlot::kClearcoatNormal).image = t.normal;
  return m;
}

Material sheen(int i, const Textures& t) {
  Material m = plain("sheen", {0.05F, 0.02F, 0.08F}, 0, 0.9F);
  m.layers.sheen_color = {0.75F, 0.55F, 0.85F};
  m.layers.sheen_roughness = i == 0 ? 0.1F : 0.18F * static_cast<float>(i);
  if (i < kColumns - 1) return m;
  m.layers.sheen_color = glm::vec3(1);
  m.layers.sheen_roughness = 0.8F;
  m.texture(TextureSlot::kSheenColor).image = t.color;
  m.texture(TextureSlot::kSheenRoughness).image = t.mask;
  return m;
}

Material transmission(int i, const Textures& t) {
  const float x = static_cast<float>(i) / 5;
  Material m =
      plain("transmission", glm::mix(glm::vec3(1), glm::vec3(0.35F, 0.9F, 0.55F), x), 0, 0.5F * x * x);
  m.layers.transmission = i == 0 ? 0.5F : 1.0F;
  if (i < kColumns - 1) return m;
  m.base_color = {1, 0.8F, 0.5F, 1};
  m.roughness = 0.05F;
  m.texture(TextureSlot::kTransmission).image = t.mask;
  return m;
}

Material volume(int i, const Textures& t) {
  Material m = plain("volume", glm::vec3(1), 0, 0.03F);
  m.layers.transmission = 1;
  m.layers.absorption = -0.35F * static_cast<float>(i) * glm::vec3(0.25F, 1.0F, 1.6F);
  if (i == kColumns - 1) m.texture(TextureSlot::kThickness).image = t.mask;
  m.layers.clearcoat = i == 3 ? 1.0F : 0.0F;
  return m;
}

Material specular_glossiness(int i, const Textures& t) {
  const float x = static_cast<float>(i) / 5;
  Material m = plain("specular-glossiness", {0.20F, 0.28F, 0.10F}, 0, 1 - 0.9F * x);
  m.layers.specular = m.layers.specular_glossiness = true;
  m.layers.specular_color = glm::vec3(0.7F, 0.45F, 0.15F) * (0.06F + 0.94F * x);
  if (i < kColumns - 1) return m;
  m.roughness = 0.1F;
  m.layers.specular_color = glm::vec3(0.8F);
  m.texture(TextureSlot::kSpecularColor).image = t.color;
  return m;
}

/// A sphere around the origin; texture coordinates wrap once around and from pole to pole.
void sphere(MeshBuilder& mesh) {
  mesh.patch(40, 24, [](float u, float v) {
    const float around = 2 * kPi * u, down = kPi * v;
    return PatchPoint{
        kRadius * glm::vec3(sine(down) * sine(around), cosine(down), sine(down) * cosine(around)),
        {2 * u, v}};
  });
}

void add_wall(SceneData& scene) {
  Material m = plain("wall", glm::vec3(1), 0, 0.9F);
  m.texture(TextureSlot::kBaseColor).image =
      add_image(scene, "wall", paint(64, true, [](glm::vec2 uv) {
                  const glm::ivec2 square(uv * 4.0F);
                  return glm::vec4(glm::vec3((square.x + square.y) % 2 == 0 ? 0.55F : 0.16F), 1);
                }));
  scene.materials.push_back(m);
  MeshBuilder mesh;
  mesh.patch(1, 1, [](float u, float v) {
    return PatchPoint{{14 * (u - 0.5F), 14 * (0.5F - v), -1.2F}, {12 * u, 12 * v}};
  });
  place(scene, mesh.finish(scene, "wall", static_cast<int>(scene.materials.size() - 1), {}));
}

}  // namespace

SceneData build_materials() {
  using Row = Material (*)(int, const Textures&);
  constexpr std::array<Row, kRows> kMaterials{ior,          specular, clearcoat,          sheen,
                                              transmission, volume,   specular_glossiness};
  SceneData scene;
  const Textures textures{
      add_image(scene, "mask", stripes(false, glm::vec4(1), glm::vec4(0.1F))),
      add_image(scene, "color", stripes(true, {0.9F, 0.25F, 0.1F, 1}, {0.1F, 0.5F, 0.8F, 0.4F})),
      add_image(scene, "bumps",
                paint_normals(128, 0.02F, [](glm::vec2 uv) { return tiling_noise(uv * 16.0F, 16, 2, 9); }))};
  add_wall(scene);
  MeshBuilder mesh;
  sphere(mesh);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      scene.materials.push_back(kMaterials[static_cast<std::size_t>(row)](column, textures));
      const Material& m = scene.materials.back();
      const std::uint32_t primitive = mesh.finish(
          scene, fmt::format("{} {}", m.name, column), static_cast<int>(scene.materials.size() - 1),
          {.normal = true, .tangent = true, .uv = true, .color = false});
      place(scene, primitive,
            glm::translate(glm::mat4(1), kPitch * glm::vec3(column - kColumns / 2, kRows / 2 - row, 0)));
    }
  }
  Camera camera;
  camera.name = "front";
  camera.yfov = 0.6;
  camera.pose = glm::translate(glm::mat4(1), glm::vec3(0, 0, 13.8F));
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace quadrille::scenes
