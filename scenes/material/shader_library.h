/// The shaders of a stream, each variant once: taken from those that were compiled with the program, or
/// compiled from GLSL when they are none of them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/data/scene_options.h"
#include "scenes/material/material_variant.h"

namespace quadrille::scenes {

class ShaderLibrary {
 public:
  /// Reads the user's shaders, if any. Throws `UserError` when a file cannot be read.
  ShaderLibrary(const SceneOptions& options, std::vector<std::string> frame_defines,
                std::vector<traces::Shader>& shaders);
  [[nodiscard]] ShaderSet set() const { return set_; }
  /// Index into the shader table. Throws `UserError` with the compiler's first error.
  [[nodiscard]] traces::Index vertex(const Variant& variant) {
    return shader(traces::ShaderStage::kVertex, variant);
  }
  [[nodiscard]] traces::Index fragment(const Variant& variant) {
    return shader(traces::ShaderStage::kFragment, variant);
  }
  /// Shaders of the table that had to be compiled from GLSL.
  [[nodiscard]] std::size_t compiled() const { return compiled_; }

 private:
  struct Source {
    std::string name;
    std::string glsl;                  ///< of a user's own, or of a visibility frame
    std::vector<std::uint32_t> spirv;  ///< instead of GLSL
    bool material = false;             ///< the materials' own; its GLSL is put together when it is needed
  };
  [[nodiscard]] static Source read_source(traces::ShaderStage stage, const std::string& path);
  [[nodiscard]] traces::Index shader(traces::ShaderStage stage, const Variant& variant);
  [[nodiscard]] std::vector<std::string> defines(traces::ShaderStage stage, const Source& source,
                                                 const Variant& variant) const;
  [[nodiscard]] std::vector<std::uint32_t> spirv(traces::ShaderStage stage, const Source& source,
                                                 const std::vector<std::string>& defines);

  ShaderSet set_ = ShaderSet::kMaterial;
  bool leave_out_ = true;
  Source vertex_, fragment_;
  std::vector<std::string> frame_defines_;
  std::vector<traces::Shader>& shaders_;
  std::map<std::pair<traces::ShaderStage, std::string>, traces::Index> known_;
  std::size_t compiled_ = 0;
};

}  // namespace quadrille::scenes
