#include "scenes/material/typical_shaders.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "scenes/material/frame_block.h"
#include "scenes/material/material_variant.h"
#include "scenes/view/camera.h"

namespace quadrille::scenes {
namespace {

/// The textures of a material, as bits of its slots. Occlusion, where there is any, is also tried in the
/// texture of metallic and roughness.
constexpr unsigned kBase = 1, kMetal = 2, kNormal = 4, kOcclusion = 8, kEmissive = 16;
constexpr std::array kTextureSets{kBase,
                                  kMetal,
                                  kNormal,
                                  kBase | kMetal,
                                  kBase | kNormal,
                                  kBase | kOcclusion,
                                  kBase | kMetal | kNormal,
                                  kBase | kMetal | kOcclusion,
                                  kBase | kMetal | kNormal | kOcclusion,
                                  kBase | kEmissive,
                                  kBase | kMetal | kEmissive,
                                  kBase | kMetal | kNormal | kEmissive,
                                  kBase | kMetal | kNormal | kOcclusion | kEmissive};

class Collector {
 public:
  Collector(const View& view, Light::Kind light, std::vector<ShaderSet> sets)
      : frame_defines_(frame_defines(view, {one_light(light)})), sets_(std::move(sets)) {}

  /// All sides and alpha modes of a material with these textures, on a mesh with these attributes.
  void add(unsigned textures, bool shared_occlusion, bool emissive, bool unlit,
           const std::vector<Semantic>& attributes) {
    Material m;
    for (std::size_t slot = 0; slot < kBaseTextureSlots; ++slot) {
      if ((textures >> slot & 1) != 0) m.textures[slot].image = static_cast<int>(slot);
    }
    if (shared_occlusion)
      m.textures[at(TextureSlot::kOcclusion)].image = m.textures[at(TextureSlot::kMetallicRoughness)].image;
    m.emissive = glm::vec3(emissive ? 1.0F : 0.0F);
    m.unlit = unlit;
    Primitive primitive;
    for (const Semantic s : attributes) primitive.attributes[static_cast<std::size_t>(s)] = 0;
    for (const AlphaMode alpha : {AlphaMode::kOpaque, AlphaMode::kMask, AlphaMode::kBlend}) {
      for (const bool double_sided : {false, true}) {
        m.alpha = alpha;
        m.double_sided = double_sided;
        for (const ShaderSet set : sets_) add(m, primitive, set);
      }
    }
  }
  [[nodiscard]] std::vector<TypicalShader> take() { return std::exchange(shaders_, {}); }

 private:
  void add(const Material& material, const Primitive& primitive, ShaderSet set) {
    const Variant v = choose_variant(material, primitive, set);
    for (const traces::ShaderStage stage : {traces::ShaderStage::kVertex, traces::ShaderStage::kFragment})
      shaders_.push_back({set, stage, material_shader_defines(stage, v, frame_defines_)});
  }
  static std::size_t at(TextureSlot slot) { return static_cast<std::size_t>(slot); }
  static Light one_light(Light::Kind kind) {
    Light light;
    light.kind = kind;
    return light;
  }

  std::vector<std::string> frame_defines_;
  std::vector<ShaderSet> sets_;
  std::vector<TypicalShader> shaders_;
};

using Attributes = std::vector<Semantic>;

Attributes with(Attributes attributes, bool wanted, Semantic more) {
  if (wanted) attributes.push_back(more);
  return attributes;
}

/// Without textures, or with the colour's alone.
void add_plain(Collector& c) {
  for (unsigned features = 0; features < 8; ++features) {
    const bool mapped = (features & 1) != 0, colored = (features & 2) != 0, emissive = (features & 4) != 0;
    const unsigned textures = mapped ? kBase : 0;
    const Attributes attributes =
        with(with({Semantic::kPosition}, mapped, Semantic::kUv0), colored, Semantic::kColor);
    for (const bool normals : {false, true})
      c.add(textures, false, emissive, false, with(attributes, normals, Semantic::kNormal));
    if (!emissive) c.add(textures, false, false, true, attributes);
  }
}

/// With normals, texture coordinates and several textures.
void add_textured(Collector& c) {
  for (const unsigned textures : kTextureSets) {
    for (unsigned features = 0; features < 4; ++features) {
      const bool tangents = (features & 1) != 0, colored = (features & 2) != 0,
                 emissive = (textures & kEmissive) != 0;
      if (tangents && (textures & kNormal) == 0) continue;
      const Attributes attributes =
          with(with({Semantic::kPosition, Semantic::kNormal, Semantic::kUv0}, tangents, Semantic::kTangent),
               colored, Semantic::kColor);
      c.add(textures, false, emissive, false, attributes);
      if ((textures & kMetal) != 0 && (textures & kOcclusion) != 0)
        c.add(textures, true, emissive, false, attributes);
    }
  }
}

}  // namespace

std::vector<TypicalShader> typical_shaders() {
  View orthographic;
  orthographic.orthographic = true;
  const std::vector<ShaderSet> materials{ShaderSet::kMaterial},
      plain{ShaderSet::kMinimal,  ShaderSet::kFlat,     ShaderSet::kGouraud, ShaderSet::kPhong,
            ShaderSet::kDepth,    ShaderSet::kOverdraw, ShaderSet::kUv,      ShaderSet::kNormal,
            ShaderSet::kTriangle, ShaderSet::kLevel};
  Collector lit(View{}, Light::Kind::kDirectional, materials);
  add_textured(lit);
  std::vector<TypicalShader> all = lit.take();
  for (const std::vector<ShaderSet>& sets : {materials, plain}) {
    for (Collector c :
         {Collector(View{}, Light::Kind::kDirectional, sets), Collector(View{}, Light::Kind::kPoint, sets),
          Collector(orthographic, Light::Kind::kDirectional, sets)}) {
      add_plain(c);
      std::ranges::move(c.take(), std::back_inserter(all));
    }
  }
  return all;
}

}  // namespace quadrille::scenes
