/// The schema of what the loader reads of a glTF file, as tables: types, what may not be missing, which words
/// are legal, and what an index leads into. [glTF2.0 #properties-reference]
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace quadrille::scenes::schema {

enum class Type : std::uint8_t {
  kAny,
  kObject,
  kArray,
  kIndex,
  kInt,
  kNumber,
  kStride,
  kString,
  kBool,
  kTwo,
  kThree,
  kFour,
  kSixteen
};

/// Members of one type: names by path from the document's root; "[]" is each element of an array, "*" each
/// member of an object. What leads to a member is by that an object, or an array. One with "!" may not be
/// missing where the object around it stands. An index ends in ">" and the table that it leads into: one of
/// the root, or with a dot before it one of the animation around it.
struct Rule {
  Type type;
  std::string_view paths;       ///< with a blank between two
  std::string_view legal = {};  ///< the only values, with a blank between two; empty: any of the type
};

inline constexpr std::array kRules{
    Rule{Type::kIndex,
         "scene>scenes scenes[].nodes[]>nodes nodes[].mesh>meshes nodes[].camera>cameras nodes[].skin>skins "
         "nodes[].children[]>nodes "
         "nodes[].extensions.KHR_lights_punctual.light!>extensions.KHR_lights_punctual.lights "
         "scenes[].extensions.EXT_lights_image_based.light!>extensions.EXT_lights_image_based.lights "
         "extensions.EXT_lights_image_based.lights[].specularImageSize! "
         "nodes[].extensions.EXT_mesh_gpu_instancing.attributes.*>accessors "
         "meshes[].primitives[].attributes.*>accessors "
         "meshes[].primitives[].indices>accessors meshes[].primitives[].material>materials "
         "meshes[].primitives[].targets[].*>accessors accessors[].bufferView>bufferViews "
         "accessors[].byteOffset accessors[].count! "
         "accessors[].sparse.indices.bufferView!>bufferViews "
         "accessors[].sparse.values.bufferView!>bufferViews bufferViews[].buffer!>buffers "
         "bufferViews[].byteOffset bufferViews[].byteLength! images[].bufferView>bufferViews "
         "textures[].sampler>samplers textures[].source>images "
         "textures[].extensions.EXT_texture_webp.source>images "
         "textures[].extensions.MSFT_texture_dds.source>images "
         "skins[].joints[]>nodes skins[].skeleton>nodes skins[].inverseBindMatrices>accessors "
         "animations[].channels[].sampler!>.samplers "
         "animations[].channels[].target.node>nodes animations[].samplers[].input!>accessors "
         "animations[].samplers[].output!>accessors"},
    Rule{Type::kInt,
         "meshes[].primitives[].mode accessors[].sparse.count! accessors[].sparse.indices.byteOffset "
         "accessors[].sparse.values.byteOffset "
         "bufferViews[].target samplers[].magFilter samplers[].minFilter samplers[].wrapS samplers[].wrapT"},
    Rule{Type::kIndex, "accessors[].componentType!", "5120 5121 5122 5123 5125 5126"},
    Rule{Type::kIndex, "accessors[].sparse.indices.componentType!", "5121 5123 5125"},
    Rule{Type::kNumber,
         "nodes[].weights[] meshes[].weights[] accessors[].min[] accessors[].max[] "
         "materials[].pbrMetallicRoughness.metallicFactor "
         "materials[].pbrMetallicRoughness.roughnessFactor materials[].normalTexture.scale "
         "materials[].occlusionTexture.strength "
         "materials[].alphaCutoff materials[].extensions.KHR_materials_clearcoat.clearcoatFactor "
         "materials[].extensions.KHR_materials_clearcoat.clearcoatRoughnessFactor "
         "materials[].extensions.KHR_materials_clearcoat.clearcoatNormalTexture.scale "
         "materials[].extensions.KHR_materials_emissive_strength.emissiveStrength "
         "materials[].extensions.KHR_materials_ior.ior "
         "materials[].extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor "
         "materials[].extensions.KHR_materials_sheen.sheenRoughnessFactor "
         "materials[].extensions.KHR_materials_specular.specularFactor "
         "materials[].extensions.KHR_materials_transmission.transmissionFactor "
         "materials[].extensions.KHR_materials_volume.thicknessFactor "
         "cameras[].perspective.yfov! cameras[].perspective.aspectRatio cameras[].perspective.znear! "
         "cameras[].perspective.zfar "
         "cameras[].orthographic.xmag! cameras[].orthographic.ymag! cameras[].orthographic.znear! "
         "cameras[].orthographic.zfar! "
         "extensions.KHR_lights_punctual.lights[].intensity extensions.KHR_lights_punctual.lights[].range "
         "extensions.KHR_lights_punctual.lights[].spot.innerConeAngle "
         "extensions.KHR_lights_punctual.lights[].spot.outerConeAngle "
         "extensions.EXT_lights_image_based.lights[].intensity"},
    Rule{Type::kStride, "bufferViews[].byteStride"},
    Rule{Type::kNumber, "materials[].extensions.KHR_materials_volume.attenuationDistance"},
    Rule{Type::kThree,
         "nodes[].translation nodes[].scale materials[].emissiveFactor "
         "materials[].extensions.KHR_materials_pbrSpecularGlossiness.specularFactor "
         "materials[].extensions.KHR_materials_sheen.sheenColorFactor "
         "materials[].extensions.KHR_materials_specular.specularColorFactor "
         "materials[].extensions.KHR_materials_volume.attenuationColor "
         "extensions.KHR_lights_punctual.lights[].color"},
    Rule{Type::kFour,
         "nodes[].rotation extensions.EXT_lights_image_based.lights[].rotation "
         "materials[].pbrMetallicRoughness.baseColorFactor "
         "materials[].extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor"},
    Rule{Type::kSixteen, "nodes[].matrix"},
    Rule{Type::kString,
         "asset.version! asset.minVersion scenes[].name nodes[].name meshes[].name materials[].name "
         "materials[].alphaMode cameras[].name "
         "skins[].name animations[].name animations[].channels[].target.path! "
         "animations[].samplers[].interpolation extensionsUsed[] "
         "extensionsRequired[] buffers[].uri images[].uri images[].name"},
    Rule{Type::kString, "accessors[].type!", "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    Rule{Type::kString, "cameras[].type!", "perspective orthographic"},
    Rule{Type::kString, "extensions.KHR_lights_punctual.lights[].type!", "directional point spot"},
    Rule{Type::kBool,
         "accessors[].normalized materials[].doubleSided nodes[].extensions.KHR_node_visibility.visible"},
    Rule{Type::kArray,
         "meshes[].primitives! skins[].joints! animations[].channels! animations[].samplers! "
         "extensions.EXT_lights_image_based.lights[].irradianceCoefficients! "
         "extensions.EXT_lights_image_based.lights[].specularImages!"},
    Rule{Type::kObject,
         "asset! meshes[].primitives[].attributes! accessors[].sparse.indices! accessors[].sparse.values! "
         "animations[].channels[].target!"}};

/// Where a material mentions a texture.
inline constexpr std::string_view kTextureInfos =
    "pbrMetallicRoughness.baseColorTexture pbrMetallicRoughness.metallicRoughnessTexture normalTexture "
    "occlusionTexture emissiveTexture "
    "extensions.KHR_materials_clearcoat.clearcoatTexture "
    "extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture "
    "extensions.KHR_materials_clearcoat.clearcoatNormalTexture "
    "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture "
    "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture "
    "extensions.KHR_materials_sheen.sheenColorTexture "
    "extensions.KHR_materials_sheen.sheenRoughnessTexture extensions.KHR_materials_specular.specularTexture "
    "extensions.KHR_materials_specular.specularColorTexture "
    "extensions.KHR_materials_transmission.transmissionTexture "
    "extensions.KHR_materials_volume.thicknessTexture";
inline constexpr std::array kTextureInfoRules{
    Rule{Type::kIndex, "index!>textures texCoord extensions.KHR_texture_transform.texCoord"},
    Rule{Type::kNumber, "extensions.KHR_texture_transform.rotation"},
    Rule{Type::kTwo, "extensions.KHR_texture_transform.offset extensions.KHR_texture_transform.scale"}};

}  // namespace quadrille::scenes::schema
