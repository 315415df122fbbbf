/// The order of a program's instructions: few issue cycles, as far as that costs no warp.
///
/// A register has no price by itself. It counts only where one more lowers the number of warps that a core
/// holds.
#pragma once

#include "pipeline/compiler/allocate.h"
#include "pipeline/compiler/ir.h"
#include "pipeline/compiler/target.h"

namespace quadrille::pipeline {

struct OrderedCode {
  std::vector<ScalarInstruction> code;
  Allocation allocation;
};

/// Of the orders with as many warps as the one with the fewest registers, that with the fewest issue cycles;
/// of these, that with the fewest registers. A shader that takes differences between lanes in divergent
/// control flow has the order for the default machine: what an idle neighbour shows there is in its
/// registers, and pictures must not depend on the machine.
[[nodiscard]] OrderedCode best_order(const ScalarShader& shader, const ShaderTarget& target);

}  // namespace quadrille::pipeline
