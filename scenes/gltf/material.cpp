#include "scenes/gltf/material.h"

#include <cmath>

#include "models/base/error.h"
#include "scenes/gltf/layers.h"
#include "scenes/gltf/texture.h"
#include "scenes/gltf/value.h"

namespace quadrille::scenes {
namespace {

class MaterialReader {
 public:
  MaterialReader(const GltfFile& file, std::size_t index)
      : file_(file), source_(file.model.materials[index]), place_(fmt::format("materials[{}]", index)) {}

  Material read() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    Material m;
    m.name = source_.name.empty() ? place_ : source_.name;
    m.base_color = glm::vec4(vector(pbr.baseColorFactor, 4, "baseColorFactor"));
    m.metallic = unit(pbr.metallicFactor, "metallicFactor");
    m.roughness = unit(pbr.roughnessFactor, "roughnessFactor");
    m.normal_scale = number(source_.normalTexture.scale, "normalTexture.scale");
    m.occlusion_strength = unit(source_.occlusionTexture.strength, "occlusionTexture.strength");
    m.emissive = glm::vec3(vector(source_.emissiveFactor, 3, "emissiveFactor")) * emissive_strength();
    m.alpha = alpha_mode();
    m.alpha_cutoff = number(source_.alphaCutoff, "alphaCutoff");
    m.double_sided = source_.doubleSided;
    m.unlit = source_.extensions.contains("KHR_materials_unlit");
    m.texture(TextureSlot::kBaseColor) = texture(pbr.baseColorTexture, "baseColorTexture");
    m.texture(TextureSlot::kMetallicRoughness) =
        texture(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    m.texture(TextureSlot::kNormal) = texture(source_.normalTexture, "normalTexture");
    m.texture(TextureSlot::kOcclusion) = texture(source_.occlusionTexture, "occlusionTexture");
    m.texture(TextureSlot::kEmissive) = texture(source_.emissiveTexture, "emissiveTexture");
    read_layers(file_, source_, place_, m);
    if (m.unlit) m.layers = {};
    return m;
  }

 private:
  [[noreturn]] void fail(const std::string& member, const std::string& reason) const {
    throw user_error("{}: {}.{}: {}", file_.path, place_, member, reason);
  }

  float number(double value, const std::string& member) const {
    const auto result = static_cast<float>(value);
    if (!std::isfinite(result)) fail(member, "not a finite number");
    return result;
  }

  float unit(double value, const std::string& member) const {
    if (!(value >= 0 && value <= 1)) fail(member, fmt::format("{} is outside 0..1", value));
    return static_cast<float>(value);
  }

  glm::vec4 vector(const std::vector<double>& values, std::size_t size, const std::string& member) const {
    if (values.size() != size) fail(member, fmt::format("{} numbers instead of {}", values.size(), size));
    glm::vec4 result(1);
    for (std::size_t i = 0; i < size; ++i) result[static_cast<int>(i)] = number(values[i], member);
    return result;
  }

  AlphaMode alpha_mode() const {
    if (source_.alphaMode == "OPAQUE") return AlphaMode::kOpaque;
    if (source_.alphaMode == "MASK") return AlphaMode::kMask;
    if (source_.alphaMode == "BLEND") return AlphaMode::kBlend;
    fail("alphaMode", fmt::format("'{}' is not OPAQUE, MASK or BLEND", source_.alphaMode.substr(0, 40)));
  }

  float emissive_strength() const {
    const auto found = source_.extensions.find("KHR_materials_emissive_strength");
    if (found == source_.extensions.end()) return 1;
    return GltfObject(file_.path, place_ + ".KHR_materials_emissive_strength", found->second)
        .number("emissiveStrength", 1);
  }

  template <class Info>
  TextureUse texture(const Info& info, const char* member) const {
    return read_texture(file_, mention_of(info), fmt::format("{}.{}", place_, member));
  }

  const GltfFile& file_;
  const tinygltf::Material& source_;
  std::string place_;
};

}  // namespace

Material read_material(const GltfFile& file, std::size_t index) { return MaterialReader(file, index).read(); }

}  // namespace quadrille::scenes
