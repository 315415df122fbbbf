#include "scenes/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

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
    m.texture(TextureSlot::kMetallicRoughness) = texture(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    m.texture(TextureSlot::kNormal) = texture(source_.normalTexture, "normalTexture");
    m.texture(TextureSlot::kOcclusion) = texture(source_.occlusionTexture, "occlusionTexture");
    m.texture(TextureSlot::kEmissive) = texture(source_.emissiveTexture, "emissiveTexture");
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
    if (found == source_.extensions.end() || !found->second.Has("emissiveStrength")) return 1;
    return number(found->second.Get("emissiveStrength").GetNumberAsDouble(), "emissiveStrength");
  }

  /// Any of tinygltf's three texture-info types.
  template <class Info>
  TextureUse texture(const Info& info, const std::string& member) const {
    if (info.index < 0) return {};
    const auto& textures = file_.model.textures;
    if (static_cast<std::size_t>(info.index) >= textures.size())
      fail(member, fmt::format("texture {} does not exist (the file has {})", info.index, textures.size()));
    const tinygltf::Texture& source = textures[static_cast<std::size_t>(info.index)];
    TextureUse use;
    use.image = image(source.source, info.index);
    if (use.image < 0) return {};
    use.sampler = sampler(source.sampler, info.index);
    use.uv_set = info.texCoord;
    if (const auto found = info.extensions.find("KHR_texture_transform"); found != info.extensions.end())
      transform(use, found->second, member);
    if (use.uv_set < 0 || use.uv_set > 1) fail(member, fmt::format("texCoord {} is not supported; sets 0 and 1 are", use.uv_set));
    return use;
  }

  /// A texture may lack a source when an extension we do not know provides it; it then has no image.
  int image(int source, int texture_index) const {
    if (source < 0) return -1;
    if (static_cast<std::size_t>(source) >= file_.model.images.size()) {
      throw user_error("{}: textures[{}].source: image {} does not exist (the file has {})", file_.path, texture_index, source,
                       file_.model.images.size());
    }
    return source;
  }

  double member_number(const tinygltf::Value& value, const std::string& member) const {
    if (!value.IsNumber()) fail(member, "KHR_texture_transform: a number is due");
    return number(value.GetNumberAsDouble(), member);
  }

  glm::dvec2 pair(const tinygltf::Value& extension, const char* name, glm::dvec2 absent, const std::string& member) const {
    if (!extension.Has(name)) return absent;
    const tinygltf::Value& value = extension.Get(name);
    if (!value.IsArray() || value.ArrayLen() != 2) fail(member, fmt::format("KHR_texture_transform.{}: two numbers are due", name));
    return {member_number(value.Get(0), member), member_number(value.Get(1), member)};
  }

  /// Offset after rotation after scale; a positive angle turns the image clockwise. [KHR_texture_transform, its example and its test scene]
  void transform(TextureUse& use, const tinygltf::Value& extension, const std::string& member) const {
    const glm::dvec2 offset = pair(extension, "offset", {0, 0}, member), scale = pair(extension, "scale", {1, 1}, member);
    const double angle = extension.Has("rotation") ? member_number(extension.Get("rotation"), member) : 0.0;
    const double c = std::cos(angle), s = std::sin(angle);
    use.u_row = glm::vec3(glm::dvec3(c * scale.x, s * scale.y, offset.x));
    use.v_row = glm::vec3(glm::dvec3(-s * scale.x, c * scale.y, offset.y));
    use.transformed = use.u_row != glm::vec3(1, 0, 0) || use.v_row != glm::vec3(0, 1, 0);
    if (extension.Has("texCoord")) use.uv_set = static_cast<int>(std::clamp(member_number(extension.Get("texCoord"), member), -1.0, 1e6));
  }

  traces::Wrap wrap(int value, int sampler_index) const {
    switch (value) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT: return traces::Wrap::kRepeat;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return traces::Wrap::kMirroredRepeat;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return traces::Wrap::kClampToEdge;
      default: throw user_error("{}: samplers[{}]: wrap mode {} is not one of glTF's", file_.path, sampler_index, value);
    }
  }

  void minification(traces::Sampler& s, int filter, int sampler_index) const {
    constexpr float kBaseLevelOnly =
        0.25F;  // keeps min and mag filter apart without mip-mapping [VK1.3 #samplers, on GL_LINEAR and GL_NEAREST]
    using traces::Filter;
    const auto set = [&](Filter min, Filter mip, float max_lod) { s.min = min, s.mip = mip, s.max_lod = max_lod; };
    constexpr float kAllLevels = 1000;
    switch (filter) {
      case -1:
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR: return set(Filter::kLinear, Filter::kLinear, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST: return set(Filter::kLinear, Filter::kNearest, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR: return set(Filter::kNearest, Filter::kLinear, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST: return set(Filter::kNearest, Filter::kNearest, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_LINEAR: return set(Filter::kLinear, Filter::kNearest, kBaseLevelOnly);
      case TINYGLTF_TEXTURE_FILTER_NEAREST: return set(Filter::kNearest, Filter::kNearest, kBaseLevelOnly);
      default: throw user_error("{}: samplers[{}]: minFilter {} is not one of glTF's", file_.path, sampler_index, filter);
    }
  }

  traces::Sampler sampler(int index, int texture_index) const {
    traces::Sampler s;
    if (index < 0) return s;
    if (static_cast<std::size_t>(index) >= file_.model.samplers.size()) {
      throw user_error("{}: textures[{}].sampler: sampler {} does not exist (the file has {})", file_.path, texture_index, index,
                       file_.model.samplers.size());
    }
    const tinygltf::Sampler& source = file_.model.samplers[static_cast<std::size_t>(index)];
    s.wrap_u = wrap(source.wrapS, index);
    s.wrap_v = wrap(source.wrapT, index);
    if (source.magFilter != -1 && source.magFilter != TINYGLTF_TEXTURE_FILTER_LINEAR &&
        source.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST) {
      throw user_error("{}: samplers[{}]: magFilter {} is not one of glTF's", file_.path, index, source.magFilter);
    }
    s.mag = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? traces::Filter::kNearest : traces::Filter::kLinear;
    minification(s, source.minFilter, index);
    return s;
  }

  const GltfFile& file_;
  const tinygltf::Material& source_;
  std::string place_;
};

}  // namespace

Material read_material(const GltfFile& file, std::size_t index) { return MaterialReader(file, index).read(); }

}  // namespace quadrille::scenes
