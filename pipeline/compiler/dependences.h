/// What must come before what in straight-line code.
#pragma once

#include "pipeline/compiler/ir.h"

#include <span>
#include <vector>

namespace quadrille::pipeline {

/// By instruction: those that must come before it, by place. They are the makers of its operands, earlier
/// readers and writers of its variable, and the output before it; of one that accesses storage buffers the
/// write before it, and the reads before a write.
[[nodiscard]] std::vector<std::vector<std::size_t>> dependences(std::span<const ScalarInstruction> code,
                                                                const std::vector<bool>& variable);

}  // namespace quadrille::pipeline
