/// Evaluates operations on literals at compile time, where the result is exactly the machine's: integers,
/// correctly rounded float arithmetic, comparisons.
#pragma once

#include "models/shader/isa.h"

#include <cstdint>
#include <optional>

namespace quadrille::pipeline {

/// The result of `op` on literal operands (unused ones 0), or nothing where only the machine decides (special
/// functions, NaN operands of min and max).
[[nodiscard]] std::optional<std::uint32_t> fold(models::Op op, std::uint32_t a, std::uint32_t b,
                                                std::uint32_t c);

}  // namespace quadrille::pipeline
