/// SPIR-V in, SPIR-V out: validation and the optimisations of SPIRV-Tools that leave one function in SSA form
/// with structured control flow.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// Longest module accepted, in words. Larger ones are refused before anything looks at them.
inline constexpr std::size_t kMaxModuleWords = 1u << 20;
/// Most instructions that all calls, expanded in place, may come to.
inline constexpr std::uint64_t kMaxInlinedInstructions = 200000;

struct OptimisedSpirv {
  std::vector<std::uint32_t> words;
  bool kills_return = false;  ///< a demotion stands for a discard (spirv_returning_kills.h)
};

/// Validates `words` for Vulkan 1.1 and optimises them. Every float result is first marked NoContraction, so
/// that no pass reorders, merges or evaluates float arithmetic: the order of operations is the source's
/// (docs/shader_compiler.md). Throws `UserError` naming `shader` for a module that is not valid.
[[nodiscard]] OptimisedSpirv optimise_spirv(std::span<const std::uint32_t> words, std::string_view shader);

}  // namespace quadrille::pipeline
