#include "scenes/material_variant.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <glm/common.hpp>

#include "models/base/error.h"
#include "scenes/glsl.h"
#include "scenes/shader_sources.h"
#include "traces/whole_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::array<const char*, kTextureSlots> kSlotNames{
    "BASE_COLOR", "METALLIC_ROUGHNESS",  "NORMAL",           "OCCLUSION",   "EMISSIVE",        "SPECULAR",     "SPECULAR_COLOR",
    "CLEARCOAT",  "CLEARCOAT_ROUGHNESS", "CLEARCOAT_NORMAL", "SHEEN_COLOR", "SHEEN_ROUGHNESS", "TRANSMISSION", "THICKNESS"};
constexpr std::array<const char*, kSemantics> kAttributeDefines{"", "HAS_NORMAL", "HAS_TANGENT", "HAS_UV0", "HAS_UV1", "HAS_COLOR"};
constexpr std::uint64_t kMaxShaderBytes = 1 << 24;

constexpr std::size_t at(Semantic semantic) { return static_cast<std::size_t>(semantic); }
constexpr std::size_t at(TextureSlot slot) { return static_cast<std::size_t>(slot); }

bool emits(const Material& m) { return m.emissive != glm::vec3(0); }

/// Is the occlusion in the red channel of the very texture that holds metallic and roughness, read at the same place?
bool shares_occlusion(const Material& m) {
  const TextureUse& a = m.texture(TextureSlot::kMetallicRoughness);
  const TextureUse& b = m.texture(TextureSlot::kOcclusion);
  return a.image >= 0 && a.image == b.image && a.sampler == b.sampler && a.uv_set == b.uv_set && a.transformed == b.transformed &&
         a.u_row == b.u_row && a.v_row == b.v_row;
}

/// Does the layer that the texture belongs to exist?
bool has_layer(const MaterialLayers& layers, TextureSlot slot) {
  switch (slot) {
    case TextureSlot::kBaseColor:
    case TextureSlot::kMetallicRoughness:
    case TextureSlot::kNormal:
    case TextureSlot::kOcclusion:
    case TextureSlot::kEmissive: return true;
    case TextureSlot::kSpecular: return layers.specular && !layers.specular_glossiness;
    case TextureSlot::kSpecularColor: return layers.specular;
    case TextureSlot::kClearcoat:
    case TextureSlot::kClearcoatRoughness:
    case TextureSlot::kClearcoatNormal: return layers.coats();
    case TextureSlot::kSheenColor:
    case TextureSlot::kSheenRoughness: return layers.sheens();
    case TextureSlot::kTransmission:
    case TextureSlot::kThickness: return layers.transmits();
  }
  return false;
}

bool wants_texture(const Material& m, std::size_t slot, ShaderSet set) {
  const bool base_color = slot == at(TextureSlot::kBaseColor);
  if (!has_layer(m.layers, static_cast<TextureSlot>(slot))) return false;
  switch (set) {
    case ShaderSet::kUser: return true;
    case ShaderSet::kVisibility: return base_color && m.alpha == AlphaMode::kMask;
    case ShaderSet::kMaterial: break;
  }
  if (m.unlit) return base_color;
  if (slot == at(TextureSlot::kEmissive)) return emits(m);
  return slot != at(TextureSlot::kOcclusion) || !shares_occlusion(m);
}

/// Decides which textures are sampled, and by that which texture coordinates are needed. A texture whose coordinates the primitive lacks is left out.
void choose_textures(Variant& v, const Material& m, const Primitive& p, ShaderSet set) {
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    const TextureUse& use = m.textures[slot];
    const std::size_t uv = at(use.uv_set == 0 ? Semantic::kUv0 : Semantic::kUv1);
    if (use.image < 0 || p.attributes[uv] < 0 || !wants_texture(m, slot, set)) continue;
    v.textures[slot] = v.attributes[uv] = true;
    const std::string name = fmt::format("v_uv{}", use.uv_set);
    v.defines.push_back(
        fmt::format("{}_UV {}", kSlotNames[slot],
                    use.transformed ? fmt::format("transform{}_uv({}, {})", slot < kBaseTextureSlots ? "" : "_layer", slot, name) : name));
  }
}

void choose_attributes(Variant& v, const Material& m, const Primitive& p, ShaderSet set) {
  const auto use = [&](Semantic s) { v.attributes[at(s)] = p.attributes[at(s)] >= 0; };
  use(Semantic::kPosition);
  const bool reads_color = set != ShaderSet::kVisibility || m.alpha == AlphaMode::kMask;
  if (reads_color) use(Semantic::kColor);
  const bool lit = set == ShaderSet::kMaterial && !m.unlit;
  if (lit || set == ShaderSet::kUser) {
    v.defines.emplace_back("NEEDS_POSITION");
    use(Semantic::kNormal);
  }
  // Tangents without normals mean nothing. [glTF2.0 #meshes-overview]
  const bool normal_map = v.textures[at(TextureSlot::kNormal)] || v.textures[at(TextureSlot::kClearcoatNormal)];
  const bool tangents = v.attributes[at(Semantic::kNormal)] && (set == ShaderSet::kUser || normal_map);
  if (tangents) use(Semantic::kTangent);
  if (set == ShaderSet::kUser) {
    use(Semantic::kUv0);
    use(Semantic::kUv1);
  }
}

void choose_layers(Variant& v, const MaterialLayers& layers) {
  if (!layers.any()) return;
  v.defines.emplace_back("LAYERS");
  if (layers.specular) v.defines.emplace_back("SPECULAR");
  if (layers.specular_glossiness) v.defines.emplace_back("SPECULAR_GLOSSINESS");
  if (layers.coats()) v.defines.emplace_back("CLEARCOAT");
  if (layers.sheens()) v.defines.emplace_back("SHEEN");
  if (layers.transmits()) v.defines.emplace_back("TRANSMISSION");
}

void choose_modes(Variant& v, const Material& m, ShaderSet set) {
  if (m.alpha == AlphaMode::kMask) v.defines.emplace_back("ALPHA_MASK");
  if (set == ShaderSet::kVisibility) return;
  if (m.alpha == AlphaMode::kBlend) v.defines.emplace_back("ALPHA_BLEND");
  if (m.unlit) v.defines.emplace_back("UNLIT");
  if (m.unlit) return;
  choose_layers(v, m.layers);
  if (m.double_sided) v.defines.emplace_back("DOUBLE_SIDED");
  if (emits(m)) v.defines.emplace_back("EMISSIVE");
  if (v.textures[at(TextureSlot::kMetallicRoughness)] && !v.textures[at(TextureSlot::kOcclusion)] && shares_occlusion(m)) {
    v.defines.emplace_back("OCCLUSION_IN_METALLIC_ROUGHNESS");
  }
}

std::vector<std::uint32_t> spirv_words(const std::vector<std::byte>& bytes, const std::string& path) {
  if (bytes.size() < 20 || bytes.size() % 4 != 0) throw user_error("{}: not SPIR-V ({} bytes)", path, bytes.size());
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  if (words[0] != 0x07230203) throw user_error("{}: not SPIR-V (its first word is {:#010x})", path, words[0]);
  return words;
}

}  // namespace

Variant choose_variant(const Material& material, const Primitive& primitive, ShaderSet set) {
  Variant v;
  choose_textures(v, material, primitive, set);
  choose_attributes(v, material, primitive, set);
  choose_modes(v, material, set);
  for (std::size_t i = 1; i < kSemantics; ++i) {
    if (v.attributes[i]) v.defines.emplace_back(kAttributeDefines[i]);
  }
  return v;
}

ShaderLibrary::Source ShaderLibrary::read_source(const std::string& path) {
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxShaderBytes);
  if (std::filesystem::path(path).extension() == ".spv") return {path, {}, spirv_words(bytes, path), {}};
  return {path, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), {}, {}};
}

ShaderLibrary::ShaderLibrary(const SceneOptions& options, std::vector<std::string> frame_defines, std::vector<traces::Shader>& shaders)
    : shaders_(shaders) {
  const bool user = !options.vertex_shader.empty() || (!options.fragment_shader.empty() && !options.visibility);
  set_ = user ? ShaderSet::kUser : options.visibility ? ShaderSet::kVisibility : ShaderSet::kMaterial;
  const std::string interface(kInterfaceGlsl);
  vertex_ = options.vertex_shader.empty() ? Source{"material.vert", interface + std::string(kPoseGlsl) + std::string(kMaterialVert), {}, {}}
                                          : read_source(options.vertex_shader);
  const std::string inputs = interface + std::string(kMaterialGlsl);
  if (options.visibility) {
    fragment_ = {"visibility.frag", inputs + std::string(kVisibilityFrag), {}, {}};
  } else {
    fragment_ = options.fragment_shader.empty()
                    ? Source{"material.frag", inputs + std::string(kLayersGlsl) + std::string(kMaterialFrag), {}, {}}
                    : read_source(options.fragment_shader);
  }
  // The materials' vertex shader does not depend on the lights beyond the size of their array.
  vertex_.frame_defines = options.vertex_shader.empty() ? std::vector<std::string>{frame_defines.front()} : frame_defines;
  fragment_.frame_defines = std::move(frame_defines);
}

traces::Index ShaderLibrary::shader(traces::ShaderStage stage, const Variant& variant) {
  const Source& source = stage == traces::ShaderStage::kVertex ? vertex_ : fragment_;
  std::vector<std::string> defines = source.frame_defines;
  for (const std::string& define : variant.defines) {
    // The materials' vertex shader looks at streams only, so that it is shared among more materials.
    const bool stream = define.starts_with("HAS_") || define == "NEEDS_POSITION";
    if (stream || source.name != "material.vert") defines.push_back(define);
  }
  if (variant.instanced && stage == traces::ShaderStage::kVertex) defines.emplace_back("INSTANCED");
  if (source.name == "material.vert") defines.insert(defines.end(), variant.pose_defines.begin(), variant.pose_defines.end());
  const std::string key = source.spirv.empty() ? fmt::format("{}", fmt::join(defines, ";")) : std::string();
  const auto [entry, added] = compiled_.try_emplace({stage, key}, static_cast<traces::Index>(shaders_.size()));
  if (added)
    shaders_.push_back({source.name, stage, source.spirv.empty() ? compile_glsl(source.glsl, stage, source.name, defines) : source.spirv});
  return entry->second;
}

}  // namespace quadrille::scenes
