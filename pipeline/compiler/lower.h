/// SPIR-V to scalar code: every vector and matrix becomes its scalars, phis become copies, and the
/// control-flow graph becomes nested IF and LOOP.
#pragma once

#include "pipeline/compiler/ir.h"
#include "pipeline/compiler/spirv_module.h"

namespace quadrille::pipeline {

/// Lowers the entry point. Throws `UserError` with shader name and line for what is not supported.
[[nodiscard]] ScalarShader lower_shader(const spirv::Module& module, models::ShaderStage stage);

}  // namespace quadrille::pipeline
