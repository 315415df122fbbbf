/// OpSpecConstantOp: what SPIRV-Tools leaves of specialisation constants, which it folds for integers and
/// booleans only.
#pragma once

#include "pipeline/compiler/spirv_module.h"

#include <optional>

namespace quadrille::pipeline::spirv {

/// The value, flattened to words, of the operation `operands[0]` on the constants and literals after it, for
/// a result of `scalars` words. Nothing where the operation is not one of SPIR-V's for shaders on 32-bit
/// values, or takes a part of anything but a vector. [SPV #OpSpecConstantOp]
[[nodiscard]] std::optional<std::vector<std::uint32_t>> evaluate_spec_constant(
    const Module& module, std::span<const std::uint32_t> operands, std::uint32_t scalars);

}  // namespace quadrille::pipeline::spirv
