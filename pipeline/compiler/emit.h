/// The last step: scalar code and its allocation become a program, with the constant file laid out.
#pragma once

#include "pipeline/compiler/ir.h"
#include "pipeline/compiler/target.h"

namespace quadrille::pipeline {

/// How the raw slots of a shader map to packed ones (see `ScalarShader`).
struct Linkage {
  std::map<std::uint16_t, std::uint16_t> varyings;   ///< 4 * location + component -> packed component
  std::vector<models::Interpolation> interpolation;  ///< by packed component
  models::VertexExtras extras;                       ///< behind them
};

/// Schedules, allocates and encodes. Throws `UserError` naming the shader where a limit of the ISA is passed.
[[nodiscard]] models::Program emit_program(const ScalarShader& shader, const Linkage& linkage,
                                           const ShaderTarget& target);

}  // namespace quadrille::pipeline
