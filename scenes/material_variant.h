/// One shader source for all materials, compiled once for each set of features that occurs.
///
/// A variant is decided by what the material asks for and what the primitive has. It is spelled as a list of preprocessor defines, which is also its
/// identity: materials with the same defines share their shaders.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenes/frame_block.h"
#include "scenes/scene.h"
#include "scenes/scene_data.h"

namespace quadrille::scenes {

struct Variant {
  std::array<bool, kSemantics> attributes{};   ///< vertex streams that the shaders read
  std::array<bool, kTextureSlots> textures{};  ///< texture slots that the fragment shader samples
  std::vector<std::string> defines;            ///< of both stages
  bool instanced = false;                      ///< the vertex shader takes its matrices from streams that advance by instance
  std::vector<std::string> pose_defines;       ///< of the materials' vertex shader (scenes/pose_streams.h)
  friend bool operator==(const Variant&, const Variant&) = default;
};

/// Which shaders a frame uses: the materials' own, the triangle-id shader, or the user's.
enum class ShaderSet : std::uint8_t { kMaterial, kVisibility, kUser };

/// The variant for a material on a primitive. For `kUser` everything that the two offer is read.
[[nodiscard]] Variant choose_variant(const Material& material, const Primitive& primitive, ShaderSet set);

/// Compiles variants into the shader table of a stream, each once.
class ShaderLibrary {
 public:
  /// Reads the user's shaders, if any. Throws `UserError` when a file cannot be read.
  ShaderLibrary(const SceneOptions& options, std::vector<std::string> frame_defines, std::vector<traces::Shader>& shaders);
  [[nodiscard]] ShaderSet set() const { return set_; }
  /// Index into the shader table. Throws `UserError` with the compiler's first error.
  [[nodiscard]] traces::Index vertex(const Variant& variant) { return shader(traces::ShaderStage::kVertex, variant); }
  [[nodiscard]] traces::Index fragment(const Variant& variant) { return shader(traces::ShaderStage::kFragment, variant); }

 private:
  struct Source {
    std::string name, glsl;
    std::vector<std::uint32_t> spirv;  ///< instead of GLSL
    std::vector<std::string> frame_defines;
  };
  [[nodiscard]] traces::Index shader(traces::ShaderStage stage, const Variant& variant);
  [[nodiscard]] static Source read_source(const std::string& path);

  ShaderSet set_ = ShaderSet::kMaterial;
  Source vertex_, fragment_;
  std::vector<traces::Shader>& shaders_;
  std::map<std::pair<traces::ShaderStage, std::string>, traces::Index> compiled_;
};

}  // namespace quadrille::scenes
