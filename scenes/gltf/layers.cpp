#include "scenes/gltf/layers.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "scenes/gltf/texture.h"

namespace quadrille::scenes {
namespace {

// of an index of refraction of 1.5 [glTF2.0 #appendix-b-brdf-implementation]
constexpr float kPlainReflectance = 0.04F;
constexpr double kPlainIor = 1.5;

class LayerReader {
 public:
  LayerReader(const GltfFile& file, const tinygltf::Material& source, const std::string& place,
              Material& material)
      : file_(file), source_(source), place_(place), m_(material) {}

  void read() {
    if (read_specular_glossiness()) return;  // the others exclude it
    read_specular();
    read_clearcoat();
    read_sheen();
    read_transmission();
  }

 private:
  std::optional<GltfObject> extension(const char* name) const {
    const auto found = source_.extensions.find(name);
    if (found == source_.extensions.end()) return std::nullopt;
    return GltfObject(file_.path, place_ + "." + name, found->second);
  }

  bool texture(const GltfObject& object, const char* name, TextureSlot slot) {
    m_.texture(slot) = read_texture(file_, mention_of(object, name), object.place() + "." + name);
    return m_.texture(slot).image >= 0;
  }

  /// Reflectance at normal incidence; an index of 0 stands for an infinite one. [KHR_materials_ior]
  float reflectance() const {
    const auto object = extension("KHR_materials_ior");
    if (!object || !object->has("ior")) return kPlainReflectance;
    const double ior = static_cast<double>(object->number("ior", kPlainIor));
    if (ior != 0 && ior < 1) object->fail("ior", fmt::format("{} is neither 0 nor at least 1", ior));
    if (ior == 0) return 1;
    if (ior == kPlainIor) return kPlainReflectance;
    const double r = (ior - 1) / (ior + 1);
    return static_cast<float>(r * r);
  }

  void read_specular() {
    MaterialLayers& layers = m_.layers;
    bool textured = false;
    layers.specular_color = glm::vec3(reflectance());
    if (const auto object = extension("KHR_materials_specular")) {
      layers.specular_weight = object->number("specularFactor", 1, 0, 1);
      layers.specular_color *= object->color("specularColorFactor", glm::vec3(1));
      textured = texture(*object, "specularTexture", TextureSlot::kSpecular);
      textured = texture(*object, "specularColorTexture", TextureSlot::kSpecularColor) || textured;
    }
    layers.specular =
        textured || layers.specular_color != glm::vec3(kPlainReflectance) || layers.specular_weight != 1;
  }

  void read_clearcoat() {
    const auto object = extension("KHR_materials_clearcoat");
    if (!object) return;
    m_.layers.clearcoat = object->number("clearcoatFactor", 0, 0, 1);
    m_.layers.clearcoat_roughness = object->number("clearcoatRoughnessFactor", 0, 0, 1);
    if (object->has("clearcoatNormalTexture"))
      m_.layers.clearcoat_normal_scale = object->object("clearcoatNormalTexture").number("scale", 1);
    texture(*object, "clearcoatTexture", TextureSlot::kClearcoat);
    texture(*object, "clearcoatRoughnessTexture", TextureSlot::kClearcoatRoughness);
    texture(*object, "clearcoatNormalTexture", TextureSlot::kClearcoatNormal);
  }

  void read_sheen() {
    const auto object = extension("KHR_materials_sheen");
    if (!object) return;
    m_.layers.sheen_color = glm::min(object->color("sheenColorFactor", glm::vec3(0)), glm::vec3(1));
    m_.layers.sheen_roughness = object->number("sheenRoughnessFactor", 0, 0, 1);
    texture(*object, "sheenColorTexture", TextureSlot::kSheenColor);
    texture(*object, "sheenRoughnessTexture", TextureSlot::kSheenRoughness);
  }

  void read_transmission() {
    const auto object = extension("KHR_materials_transmission");
    if (!object) return;
    m_.layers.transmission = object->number("transmissionFactor", 0, 0, 1);
    texture(*object, "transmissionTexture", TextureSlot::kTransmission);
    if (const auto volume = extension("KHR_materials_volume")) read_volume(*volume);
  }

  /// What passes the thickness t is color^(t / distance); the texture scales t. [KHR_materials_volume:
  /// attenuation]
  void read_volume(const GltfObject& object) {
    const float thickness = object.number("thicknessFactor", 0, 0, 1e30);
    const glm::vec3 color = object.color("attenuationColor", glm::vec3(1));
    texture(object, "thicknessTexture", TextureSlot::kThickness);
    if (!object.has("attenuationDistance")) return;  // absent: infinite
    const float distance = object.number("attenuationDistance", 1);
    if (!(distance > 0)) object.fail("attenuationDistance", fmt::format("{} is not positive", distance));
    constexpr double kLeast = 1.0 / 1024, kMost = 64;  // nothing passes beyond 2^-64
    for (int i = 0; i < 3; ++i) {
      const double passed = std::clamp(static_cast<double>(color[i]), kLeast, 1.0);
      m_.layers.absorption[i] = static_cast<float>(-std::min(
          kMost, -std::log2(passed) * static_cast<double>(thickness) / static_cast<double>(distance)));
    }
  }

  bool read_specular_glossiness() {
    const auto object = extension("KHR_materials_pbrSpecularGlossiness");
    if (!object) return false;
    m_.base_color = diffuse(*object);
    m_.texture(TextureSlot::kBaseColor) =
        read_texture(file_, mention_of(*object, "diffuseTexture"), object->place() + ".diffuseTexture");
    m_.texture(TextureSlot::kMetallicRoughness) = {};
    m_.metallic = 0;
    m_.roughness = 1 - object->number("glossinessFactor", 1, 0, 1);
    m_.layers.specular = m_.layers.specular_glossiness = true;
    m_.layers.specular_color = glm::min(object->color("specularFactor", glm::vec3(1)), glm::vec3(1));
    texture(*object, "specularGlossinessTexture", TextureSlot::kSpecularColor);
    return true;
  }

  glm::vec4 diffuse(const GltfObject& object) const {
    if (!object.has("diffuseFactor")) return glm::vec4(1);
    const tinygltf::Value& values = object.value().Get("diffuseFactor");
    if (!values.IsArray() || values.ArrayLen() != 4) object.fail("diffuseFactor", "four numbers are due");
    glm::vec4 result(0);
    for (int i = 0; i < 4; ++i) {
      const tinygltf::Value& part = values.Get(i);
      result[i] = part.IsNumber() ? static_cast<float>(part.GetNumberAsDouble()) : -1.0F;
      if (!(result[i] >= 0 && result[i] <= 1))
        object.fail("diffuseFactor", "four numbers within 0..1 are due");
    }
    return result;
  }

  const GltfFile& file_;
  const tinygltf::Material& source_;
  std::string place_;
  Material& m_;
};

}  // namespace

void read_layers(const GltfFile& file, const tinygltf::Material& source, const std::string& place,
                 Material& material) {
  LayerReader(file, source, place, material).read();
}

}  // namespace quadrille::scenes
