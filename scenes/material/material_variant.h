/// One shader source for all materials, compiled once for each set of features that occurs.
///
/// A variant is decided by what the material asks for and what the primitive has. It is spelled as a list of
/// preprocessor defines, which is also its identity: materials with the same defines share their shaders.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

/// Which shaders a frame uses: the materials' own, the triangle-id shader, the user's, those of a lecture's
/// pipeline (`Shading`), or those that show something else than colours (`Showing`).
enum class ShaderSet : std::uint8_t {
  kMaterial,
  kVisibility,
  kUser,
  kMinimal,
  kFlat,
  kGouraud,
  kPhong,
  kDepth,
  kOverdraw,
  kUv,
  kNormal,
  kTriangle,
  kSamples,
  kLevel
};

/// Is the surface lit by Blinn's and Phong's model?
[[nodiscard]] constexpr bool lights_by_phong(ShaderSet set) {
  return set == ShaderSet::kFlat || set == ShaderSet::kGouraud || set == ShaderSet::kPhong;
}
/// Is something else shown than colours?
[[nodiscard]] constexpr bool shows_values(ShaderSet set) { return set >= ShaderSet::kDepth; }
/// The set that the options ask for.
[[nodiscard]] ShaderSet shader_set(const SceneOptions& options);

struct Variant {
  ShaderSet set = ShaderSet::kMaterial;
  std::array<bool, kSemantics> attributes{};   ///< vertex streams that the shaders read
  std::array<bool, kTextureSlots> textures{};  ///< texture slots that the fragment shader samples
  std::vector<std::string> defines;            ///< of both stages
  /// the vertex shader takes its matrices from streams that advance by instance
  bool instanced = false;
  float point_size = 0;  ///< that the vertex shader writes; 0: none
  /// of the materials' vertex shader (scenes/record/pose_streams.h)
  std::vector<std::string> pose_defines;
  friend bool operator==(const Variant&, const Variant&) = default;
};

/// Are the primitives triangles?
[[nodiscard]] bool draws_triangles(traces::Topology topology);

/// The variant for a material on a primitive. Points and lines without normals are drawn without light.
/// [glTF2.0 #point-and-line-materials] For `kUser` everything that the two offer is read.
/// `samples` a pixel matter to `kSamples` alone. With `file_colors` the levels of the base colour are those
/// of its file.
[[nodiscard]] Variant choose_variant(const Material& material, const Primitive& primitive, ShaderSet set,
                                     bool alpha_to_coverage = false, std::uint32_t samples = 1,
                                     bool file_colors = false);
/// Do the shaders of a variant take the base colour of its texture as multiplied by its alpha?
[[nodiscard]] bool takes_premultiplied(const Variant& variant);
/// Does the alpha of a material's fragments say which samples they keep, where that is wished?
[[nodiscard]] bool covers_by_alpha(const Material& material, ShaderSet set);

/// What a stage of the project's shaders is called in messages and in streams. For `kUser`, as for
/// `kMaterial`.
[[nodiscard]] std::string_view material_shader_name(traces::ShaderStage stage, ShaderSet set);
/// Its GLSL, the same for all variants.
[[nodiscard]] std::string material_shader_glsl(traces::ShaderStage stage, ShaderSet set);
/// The defines that make a variant of it, in order. A vertex shader that lights nothing looks at streams
/// only, and of the frame (`frame_defines` of scenes/material/frame_block.h) at the size of the array of
/// lights, so that it is shared among more materials.
[[nodiscard]] std::vector<std::string> material_shader_defines(traces::ShaderStage stage,
                                                               const Variant& variant,
                                                               const std::vector<std::string>& frame_defines);

}  // namespace quadrille::scenes
