#include "scenes/material/material_variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include <glm/common.hpp>

#include "scenes/material/shader_sources.h"

namespace quadrille::scenes {
namespace {

constexpr std::string_view kPremultiplied = "PREMULTIPLIED";

constexpr std::array<const char*, kTextureSlots> kSlotNames{
    "BASE_COLOR",       "METALLIC_ROUGHNESS", "NORMAL",
    "OCCLUSION",        "EMISSIVE",           "SPECULAR",
    "SPECULAR_COLOR",   "CLEARCOAT",          "CLEARCOAT_ROUGHNESS",
    "CLEARCOAT_NORMAL", "SHEEN_COLOR",        "SHEEN_ROUGHNESS",
    "TRANSMISSION",     "THICKNESS"};
constexpr std::array<const char*, kSemantics> kAttributeDefines{"",        "HAS_NORMAL", "HAS_TANGENT",
                                                                "HAS_UV0", "HAS_UV1",    "HAS_COLOR"};

constexpr std::size_t at(Semantic semantic) { return static_cast<std::size_t>(semantic); }
constexpr std::size_t at(TextureSlot slot) { return static_cast<std::size_t>(slot); }

bool emits(const Material& m) { return m.emissive != glm::vec3(0); }

/// Is the occlusion in the red channel of the very texture that holds metallic and roughness, read at the
/// same place?
bool shares_occlusion(const Material& m) {
  const TextureUse& a = m.texture(TextureSlot::kMetallicRoughness);
  const TextureUse& b = m.texture(TextureSlot::kOcclusion);
  return a.image >= 0 && a.image == b.image && a.sampler == b.sampler && a.uv_set == b.uv_set &&
         a.transformed == b.transformed && a.u_row == b.u_row && a.v_row == b.v_row;
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

/// Does the set show nothing of the material but where its alpha test lets something stand?
bool shows_shape(ShaderSet set) { return set == ShaderSet::kVisibility || shows_values(set); }

bool wants_texture(const Material& m, std::size_t slot, ShaderSet set) {
  const bool base_color = slot == at(TextureSlot::kBaseColor);
  if (!has_layer(m.layers, static_cast<TextureSlot>(slot))) return false;
  if (set == ShaderSet::kUser) return true;
  if (set == ShaderSet::kMinimal) return false;
  if (set == ShaderSet::kLevel) return base_color;
  if (shows_shape(set)) return base_color && m.alpha == AlphaMode::kMask;
  if (lights_by_phong(set)) return base_color;
  if (m.unlit) return base_color;
  if (slot == at(TextureSlot::kEmissive)) return emits(m);
  return slot != at(TextureSlot::kOcclusion) || !shares_occlusion(m);
}

/// Decides which textures are sampled, and by that which texture coordinates are needed. A texture whose
/// coordinates the primitive lacks is left out.
void choose_textures(Variant& v, const Material& m, const Primitive& p, ShaderSet set) {
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    const TextureUse& use = m.textures[slot];
    const std::size_t uv = at(use.uv_set == 0 ? Semantic::kUv0 : Semantic::kUv1);
    if (use.image < 0 || p.attributes[uv] < 0 || !wants_texture(m, slot, set)) continue;
    v.textures[slot] = v.attributes[uv] = true;
    const std::string name = fmt::format("v_uv{}", use.uv_set);
    v.defines.push_back(fmt::format(
        "{}_UV {}", kSlotNames[slot],
        use.transformed
            ? fmt::format("transform{}_uv({}, {})", slot < kBaseTextureSlots ? "" : "_layer", slot, name)
            : name));
  }
}

void choose_attributes(Variant& v, const Material& m, const Primitive& p, ShaderSet set) {
  const auto use = [&](Semantic s) { v.attributes[at(s)] = p.attributes[at(s)] >= 0; };
  use(Semantic::kPosition);
  if (set == ShaderSet::kMinimal) return;
  const bool reads_color = !shows_shape(set) || m.alpha == AlphaMode::kMask;
  if (reads_color) use(Semantic::kColor);
  if (set == ShaderSet::kUv) use(Semantic::kUv0);
  if (set == ShaderSet::kNormal) use(Semantic::kNormal);
  const bool lit = (set == ShaderSet::kMaterial || lights_by_phong(set)) && !m.unlit;
  if (lit || set == ShaderSet::kUser) {
    v.defines.emplace_back("NEEDS_POSITION");
    use(Semantic::kNormal);
  }
  // Tangents without normals mean nothing. [glTF2.0 #meshes-overview]
  const bool normal_map =
      v.textures[at(TextureSlot::kNormal)] || v.textures[at(TextureSlot::kClearcoatNormal)];
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

/// What a set of shaders is told apart by: from the materials' and from each other's.
std::string_view set_define(ShaderSet set) {
  switch (set) {
    case ShaderSet::kMaterial:
    case ShaderSet::kVisibility:
    case ShaderSet::kUser: break;
    case ShaderSet::kMinimal: return "MINIMAL";
    case ShaderSet::kFlat: return "SHADED_FLAT";
    case ShaderSet::kGouraud: return "SHADED_BY_GOURAUD";
    case ShaderSet::kPhong: return "SHADED_BY_PHONG";
    case ShaderSet::kDepth: return "SHOW_DEPTH";
    case ShaderSet::kOverdraw: return "SHOW_OVERDRAW";
    case ShaderSet::kUv: return "SHOW_UV";
    case ShaderSet::kNormal: return "SHOW_NORMAL";
    case ShaderSet::kTriangle: return "SHOW_TRIANGLE";
    case ShaderSet::kSamples: return "SHOW_SAMPLES";
    case ShaderSet::kLevel: return "SHOW_LEVEL";
  }
  return {};
}

/// Modes of the sets that know of no reflectance but a colour.
void choose_plain_modes(Variant& v, const Material& m) {
  const ShaderSet set = v.set;
  v.defines.emplace_back(set_define(set));
  if (m.alpha == AlphaMode::kMask && set != ShaderSet::kMinimal) v.defines.emplace_back("ALPHA_MASK");
  const bool lit = lights_by_phong(set) && !m.unlit;
  if (lit) v.defines.emplace_back(set == ShaderSet::kPhong ? "LIT_AT_FRAGMENTS" : "LIT_AT_VERTICES");
  if ((lit || set == ShaderSet::kNormal) && m.double_sided) v.defines.emplace_back("DOUBLE_SIDED");
}

void choose_modes(Variant& v, const Material& m, ShaderSet set) {
  if (!set_define(set).empty()) return choose_plain_modes(v, m);
  if (m.alpha == AlphaMode::kMask) v.defines.emplace_back("ALPHA_MASK");
  if (set == ShaderSet::kVisibility) return;
  if (m.alpha == AlphaMode::kBlend) v.defines.emplace_back("ALPHA_BLEND");
  if (m.unlit) v.defines.emplace_back("UNLIT");
  if (m.unlit) return;
  choose_layers(v, m.layers);
  if (m.double_sided) v.defines.emplace_back("DOUBLE_SIDED");
  if (emits(m)) v.defines.emplace_back("EMISSIVE");
  if (v.textures[at(TextureSlot::kMetallicRoughness)] && !v.textures[at(TextureSlot::kOcclusion)] &&
      shares_occlusion(m)) {
    v.defines.emplace_back("OCCLUSION_IN_METALLIC_ROUGHNESS");
  }
}

/// A point or line has no face whose normal could stand for one that is missing. For the lectures' light the
/// recorder gives faces their normals (scenes/record/facets.h), so it is the same there.
bool lacks_normals(const Primitive& primitive, ShaderSet set) {
  if (lights_by_phong(set) && primitive.attributes[at(Semantic::kNormal)] < 0) return true;
  return !draws_triangles(primitive.topology) &&
         (primitive.attributes[at(Semantic::kNormal)] < 0 || primitive.partial_normals);
}

/// Does a stage of this variant read the frame's lights and view?
bool reads_lights(traces::ShaderStage stage, const Variant& v) {
  const std::string_view lit = stage == traces::ShaderStage::kVertex ? "LIT_AT_VERTICES" : "LIT_AT_FRAGMENTS";
  return (stage == traces::ShaderStage::kFragment && set_define(v.set).empty()) ||
         std::ranges::count(v.defines, lit) > 0;
}

/// Does the vertex shader look at this define?
bool is_of_vertices(const std::string& define) {
  return define.starts_with("HAS_") || define == "NEEDS_POSITION";
}
bool is_of_lit_vertices(const std::string& define) {
  return define == "LIT_AT_VERTICES" || define == "SHADED_FLAT" || define == "DOUBLE_SIDED";
}

}  // namespace

bool draws_triangles(traces::Topology topology) {
  switch (topology) {
    case traces::Topology::kPointList:
    case traces::Topology::kLineList:
    case traces::Topology::kLineStrip: return false;
    case traces::Topology::kTriangleList:
    case traces::Topology::kTriangleStrip:
    case traces::Topology::kTriangleFan: break;
  }
  return true;
}

ShaderSet shader_set(const SceneOptions& options) {
  if (!options.vertex_shader.empty() || (!options.fragment_shader.empty() && !options.visibility))
    return ShaderSet::kUser;
  if (options.visibility) return ShaderSet::kVisibility;
  switch (options.shown) {
    case Showing::kColors: break;
    case Showing::kDepth: return ShaderSet::kDepth;
    case Showing::kOverdraw: return ShaderSet::kOverdraw;
    case Showing::kUv: return ShaderSet::kUv;
    case Showing::kNormal: return ShaderSet::kNormal;
    case Showing::kTriangle: return ShaderSet::kTriangle;
    case Showing::kSamples: return ShaderSet::kSamples;
    case Showing::kLevel: return ShaderSet::kLevel;
  }
  switch (options.shading) {
    case Shading::kMinimal: return ShaderSet::kMinimal;
    case Shading::kFlat: return ShaderSet::kFlat;
    case Shading::kGouraud: return ShaderSet::kGouraud;
    case Shading::kPhong: return ShaderSet::kPhong;
    case Shading::kPbr: break;
  }
  return ShaderSet::kMaterial;
}

bool covers_by_alpha(const Material& material, ShaderSet set) {
  return material.alpha == AlphaMode::kMask && !material.see_through() &&
         (set == ShaderSet::kMaterial || lights_by_phong(set));
}

Variant choose_variant(const Material& material, const Primitive& primitive, ShaderSet set,
                       bool alpha_to_coverage, std::uint32_t samples, bool file_colors) {
  if (!material.unlit && lacks_normals(primitive, set)) {
    Material plain = material;
    plain.unlit = true;
    return choose_variant(plain, primitive, set, alpha_to_coverage, samples, file_colors);
  }
  Variant v;
  v.set = set;
  if (primitive.topology == traces::Topology::kPointList ||
      primitive.style.polygon_mode == traces::PolygonMode::kPoint)
    v.point_size = primitive.style.point_size;
  choose_textures(v, material, primitive, set);
  choose_attributes(v, material, primitive, set);
  choose_modes(v, material, set);
  // A shader of the user's looks at textures as they are.
  if (material.alpha == AlphaMode::kBlend && v.textures[at(TextureSlot::kBaseColor)] && !file_colors &&
      set != ShaderSet::kUser)
    v.defines.emplace_back(kPremultiplied);
  if (alpha_to_coverage && covers_by_alpha(material, set))
    std::ranges::replace(v.defines, "ALPHA_MASK", "ALPHA_TO_COVERAGE");
  if (set == ShaderSet::kSamples) v.defines.push_back(fmt::format("SAMPLES {}", samples));
  for (std::size_t i = 1; i < kSemantics; ++i) {
    if (v.attributes[i]) v.defines.emplace_back(kAttributeDefines[i]);
  }
  if (set == ShaderSet::kMaterial && primitive.partial_normals && v.attributes[at(Semantic::kNormal)])
    v.defines.emplace_back("PARTIAL_NORMALS");
  return v;
}

bool takes_premultiplied(const Variant& variant) {
  return std::ranges::find(variant.defines, kPremultiplied) != variant.defines.end();
}

std::string_view material_shader_name(traces::ShaderStage stage, ShaderSet set) {
  if (stage == traces::ShaderStage::kVertex) return "material.vert";
  if (shows_values(set)) return "values.frag";
  return set_define(set).empty() ? "material.frag" : "lecture.frag";
}

std::string material_shader_glsl(traces::ShaderStage stage, ShaderSet set) {
  const auto joined = [](auto... texts) { return (std::string(kInterfaceGlsl) + ... + std::string(texts)); };
  if (stage == traces::ShaderStage::kVertex) {
    const bool lights = set == ShaderSet::kFlat || set == ShaderSet::kGouraud;
    return lights ? joined(kPoseGlsl, kLightGlsl, kMaterialVert) : joined(kPoseGlsl, kMaterialVert);
  }
  if (shows_values(set)) return joined(kMaterialGlsl, kValuesFrag);
  if (set_define(set).empty()) return joined(kMaterialGlsl, kLayersGlsl, kEnvironmentGlsl, kMaterialFrag);
  return joined(kMaterialGlsl, kLightGlsl, kLectureFrag);
}

std::vector<std::string> material_shader_defines(traces::ShaderStage stage, const Variant& variant,
                                                 const std::vector<std::string>& frame_defines) {
  const bool lit = reads_lights(stage, variant);
  std::vector<std::string> defines = lit ? frame_defines : std::vector<std::string>{frame_defines.front()};
  if (stage == traces::ShaderStage::kFragment) {
    defines.insert(defines.end(), variant.defines.begin(), variant.defines.end());
    return defines;
  }
  std::ranges::copy_if(variant.defines, std::back_inserter(defines), [&](const std::string& define) {
    return is_of_vertices(define) || (lit && is_of_lit_vertices(define));
  });
  if (variant.instanced) defines.emplace_back("INSTANCED");
  if (variant.point_size > 0) defines.push_back(fmt::format("POINT_SIZE {:.3f}", variant.point_size));
  defines.insert(defines.end(), variant.pose_defines.begin(), variant.pose_defines.end());
  return defines;
}

}  // namespace quadrille::scenes
