/// Which variants of the materials' shaders are compiled with the program (scenes/material/shader_pack.h).
#pragma once

#include <string>
#include <vector>

#include "scenes/material/material_variant.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

struct TypicalShader {
  ShaderSet set = ShaderSet::kMaterial;
  traces::ShaderStage stage = traces::ShaderStage::kVertex;
  std::vector<std::string> defines;
};

/// Those of materials as most files have them: the maps of metallic-roughness in their usual combinations,
/// all alpha modes, one or two sides, lit by the default light or by one of the scene's; without layers,
/// texture transforms and poses. Those of the lectures' pipelines, and of pictures of something else than
/// colours, for the same lights. Some may come twice.
[[nodiscard]] std::vector<TypicalShader> typical_shaders();

}  // namespace quadrille::scenes
