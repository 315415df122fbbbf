/// Loops that nothing leads out of. An optimiser may take for granted that a shader ends, and SPIRV-Tools'
/// does: `for (;;) {}` would vanish without a word.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace quadrille::pipeline {

/// Throws `UserError` with the shader's name and the loop's line if an entry point can reach a loop from
/// which no edge leads to the end of its function. Branches on constants count as what they are. `words` is a
/// valid module.
void refuse_endless_loops(std::span<const std::uint32_t> words, std::string_view shader);

}  // namespace quadrille::pipeline
