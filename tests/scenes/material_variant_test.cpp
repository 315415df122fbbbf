/// Every feature on and off: what the shaders are compiled for must compile, and be valid SPIR-V for Vulkan
/// 1.1.
#include "scenes/material/material_variant.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <spirv-tools/libspirv.hpp>

#include "models/base/error.h"
#include "scenes/material/frame_block.h"
#include "scenes/material/glsl.h"
#include "scenes/material/shader_library.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

std::string validation(const std::vector<std::uint32_t>& words) {
  std::string messages;
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  tools.SetMessageConsumer(
      [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { messages += text; });
  return tools.Validate(words) ? std::string() : messages + " (invalid)";
}

/// Bit i of `features` switches feature i.
Material material_with(unsigned features) {
  Material m;
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    if ((features >> slot & 1) != 0) m.textures[slot].image = static_cast<int>(slot);
    m.textures[slot].uv_set = slot % 2 == 1 ? 1 : 0;
    m.textures[slot].transformed = (features >> 5 & 1) != 0;
  }
  m.alpha = static_cast<AlphaMode>((features >> 6) % 3);
  m.double_sided = (features >> 7 & 1) != 0;
  m.unlit = (features >> 8 & 1) != 0;
  m.emissive = glm::vec3((features >> 9 & 1) != 0 ? 1.0F : 0.0F);
  const unsigned layers = features * 2654435761U >> 26;  // in company of their own
  m.layers.specular = (layers & 3) != 0;
  m.layers.specular_glossiness = (layers & 3) == 3;
  m.layers.clearcoat = (layers & 4) != 0 ? 1.0F : 0.0F;
  m.layers.sheen_color = glm::vec3((layers & 8) != 0 ? 1.0F : 0.0F);
  m.layers.transmission = (layers & 16) != 0 ? 1.0F : 0.0F;
  if ((layers & 32) == 0) m.layers = {};
  if ((features >> 10 & 1) != 0)
    m.texture(TextureSlot::kOcclusion) = m.texture(TextureSlot::kMetallicRoughness);
  return m;
}

Primitive primitive_with(unsigned features) {
  Primitive p;
  p.attributes[0] = 0;
  for (std::size_t i = 1; i < kSemantics; ++i)
    p.attributes[i] = (features >> i & 1) != 0 ? static_cast<int>(i) : -1;
  return p;
}

std::vector<std::string> defines_for(int directional, int points, int spots, bool orthographic) {
  View view;
  view.orthographic = orthographic;
  std::vector<Light> lights;
  const auto add = [&](int count, Light::Kind kind) {
    for (int i = 0; i < count; ++i) lights.emplace_back().kind = kind;
  };
  add(directional, Light::Kind::kDirectional);
  add(points, Light::Kind::kPoint);
  add(spots, Light::Kind::kSpot);
  return frame_defines(view, lights);
}

void compile_all(const SceneOptions& options, const std::vector<std::string>& frame, unsigned step) {
  std::vector<traces::Shader> shaders;
  ShaderLibrary library(options, frame, shaders);
  for (unsigned features = 0; features < 2048; features += step) {
    const Variant v =
        choose_variant(material_with(features), primitive_with(features * 7 + features / 64), library.set());
    (void)library.vertex(v);
    (void)library.fragment(v);
  }
  REQUIRE(shaders.size() >= 2);
  for (const traces::Shader& shader : shaders) REQUIRE(validation(shader.spirv) == "");
}

}  // namespace

TEST_CASE("material variants: features in all kinds of company compile to valid SPIR-V") {
  compile_all({}, defines_for(1, 0, 0, false), 37);
}

TEST_CASE("material variants: all kinds and numbers of lights compile to valid SPIR-V") {
  compile_all({}, defines_for(1, 2, 1, false), 311);
  compile_all({}, defines_for(2, 5, 3, true), 311);
  compile_all({}, defines_for(0, 1, 0, false), 311);
}

TEST_CASE("material variants: the visibility shader compiles, and knows only what decides the alpha test") {
  SceneOptions options;
  options.visibility = true;
  compile_all(options, defines_for(1, 0, 0, false), 101);
  Material m = material_with(0x1f);
  REQUIRE(choose_variant(m, primitive_with(0xff), ShaderSet::kVisibility).textures ==
          std::array<bool, kTextureSlots>{});
  m.alpha = AlphaMode::kMask;
  REQUIRE(choose_variant(m, primitive_with(0xff), ShaderSet::kVisibility).textures ==
          std::array<bool, kTextureSlots>{true});
}

TEST_CASE("material variants: the lectures' pipelines, and pictures of values, compile to valid SPIR-V") {
  for (const Shading shading : {Shading::kMinimal, Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
    SceneOptions options;
    options.shading = shading;
    compile_all(options, defines_for(1, 0, 0, false), 37);
    compile_all(options, defines_for(1, 2, 1, true), 311);
    compile_all(options, defines_for(0, 5, 2, false), 311);
  }
  for (const Showing shown : {Showing::kDepth, Showing::kOverdraw, Showing::kUv, Showing::kNormal,
                              Showing::kTriangle, Showing::kSamples, Showing::kLevel}) {
    SceneOptions options;
    options.shown = shown;
    compile_all(options, defines_for(1, 0, 0, false), 101);
  }
}

TEST_CASE("material variants: alpha covers where it would be tested and nothing shines through") {
  Material m = material_with(0x1f);
  m.alpha = AlphaMode::kMask;
  const auto has = [&](const char* define, ShaderSet set, bool wished) {
    const Variant v = choose_variant(m, primitive_with(0xff), set, wished);
    return std::ranges::count(v.defines, define) == 1;
  };
  for (const ShaderSet set : {ShaderSet::kMaterial, ShaderSet::kPhong}) {
    CHECK((has("ALPHA_TO_COVERAGE", set, true) && !has("ALPHA_MASK", set, true)));
    CHECK((has("ALPHA_MASK", set, false) && !has("ALPHA_TO_COVERAGE", set, false)));
    const Variant v = choose_variant(m, primitive_with(0xff), set, true);
    CHECK(compile_glsl(
              material_shader_glsl(traces::ShaderStage::kFragment, set), traces::ShaderStage::kFragment, "t",
              material_shader_defines(traces::ShaderStage::kFragment, v, defines_for(1, 0, 0, false)))
              .size() > 100);
  }
  for (const ShaderSet set : {ShaderSet::kVisibility, ShaderSet::kTriangle, ShaderSet::kSamples})
    CHECK(has("ALPHA_MASK", set, true));
  m.alpha = AlphaMode::kBlend;
  CHECK_FALSE(has("ALPHA_TO_COVERAGE", ShaderSet::kMaterial, true));
}

TEST_CASE("material variants: the lectures' pipelines know of a material its colour and its alpha") {
  const Material m = material_with(0x1f);
  using Textures = std::array<bool, kTextureSlots>;
  for (const ShaderSet set : {ShaderSet::kFlat, ShaderSet::kGouraud, ShaderSet::kPhong})
    REQUIRE(choose_variant(m, primitive_with(0xff), set).textures == Textures{true});
  const Variant minimal = choose_variant(m, primitive_with(0xff), ShaderSet::kMinimal);
  REQUIRE(minimal.textures == Textures{});
  REQUIRE(minimal.attributes == std::array<bool, kSemantics>{true});
  // Position, normal, texture coordinates and colour: no tangents.
  REQUIRE(choose_variant(m, primitive_with(0xff), ShaderSet::kPhong).attributes ==
          std::array<bool, kSemantics>{true, true, false, true, false, true});
}

TEST_CASE("material variants: the same features share shaders, a texture without coordinates is left out") {
  std::vector<traces::Shader> shaders;
  ShaderLibrary library({}, defines_for(1, 0, 0, false), shaders);
  Material a = material_with(1), b = a;
  b.base_color = glm::vec4(0.5F);
  b.textures[0].image = 77;
  const Variant v = choose_variant(a, primitive_with(0xff), library.set()),
                w = choose_variant(b, primitive_with(0xff), library.set());
  REQUIRE(library.fragment(v) == library.fragment(w));
  REQUIRE(shaders.size() == 1);
  REQUIRE_FALSE(choose_variant(a, primitive_with(0), library.set()).textures[0]);
}

TEST_CASE("material variants: occlusion in the metallic-roughness texture is read with it") {
  Material m = material_with(0x02);
  m.layers = {};
  m.texture(TextureSlot::kOcclusion) = m.texture(TextureSlot::kMetallicRoughness);
  const Variant v = choose_variant(m, primitive_with(0xff), ShaderSet::kMaterial);
  REQUIRE(v.textures == std::array<bool, kTextureSlots>{false, true, false, false, false});
  REQUIRE(std::ranges::count(v.defines, "OCCLUSION_IN_METALLIC_ROUGHNESS") == 1);
}

TEST_CASE(
    "material variants: a user's fragment shader is compiled with the same interface, its mistakes carry its "
    "name") {
  const TempGltf good(
      "#version 450\nlayout(location = 0) out vec4 c;\nlayout(location = 1) in vec3 v_normal;\nvoid main() { "
      "c = vec4(v_normal, 1.0); }\n",
      "good.frag");
  const TempGltf bad("#version 450\nvoid main() { oops }\n", "bad.frag");
  SceneOptions options;
  options.fragment_shader = good.path();
  compile_all(options, defines_for(1, 0, 0, false), 1024);
  options.fragment_shader = bad.path();
  std::vector<traces::Shader> shaders;
  ShaderLibrary library(options, defines_for(1, 0, 0, false), shaders);
  REQUIRE_THROWS_WITH(library.fragment(choose_variant({}, primitive_with(1), library.set())),
                      Catch::Contains("bad.frag"));
  options.fragment_shader = "/nonexistent.frag";
  REQUIRE_THROWS_AS(ShaderLibrary(options, defines_for(1, 0, 0, false), shaders), UserError);
}
