/// The driver's shader compiler: SPIR-V of a vertex and a fragment shader in, a linked pair of register-ISA
/// programs out.
///
/// The stages are: validation and optimisation by SPIRV-Tools (`spirv_optimise.h`), reading the module
/// (`spirv_module.h`), lowering to scalar code with structured control flow (`lower.h`), scalar clean-up and
/// texture grouping (`passes.h`), register allocation (`allocate.h`) and linking (here).
/// docs/shader_compiler.md says which SPIR-V is understood and in which order floating-point operations are
/// done.
#pragma once

#include "models/shader/isa.h"
#include "pipeline/compiler/target.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace quadrille::pipeline {

/// Both programs hold the same packed `varyings` list. Vertex outputs that the fragment shader does not read
/// are eliminated, with the code and the vertex inputs that only fed them.
struct CompiledPipeline {
  models::Program vertex, fragment;
  std::uint32_t integer_inputs = 0;  ///< bit i: the vertex shader declares input location i as integers
};

/// Compiles and links two SPIR-V modules (entry point "main"; Vulkan 1.3 environment; specialisation
/// constants take their defaults). Only where `points` are drawn does the vertex program write their size.
/// The names are used in listings and errors. Deterministic, and programs for another `target` compute the
/// same. Throws `UserError` (one line: shader name, place if known, what is not legal or not supported) for
/// any module, however damaged, that cannot be compiled, for mismatched stages, and for programs beyond a
/// limit of the ISA (registers, nesting, varyings, constants).
[[nodiscard]] CompiledPipeline compile_pipeline(std::span<const std::uint32_t> vertex_spirv,
                                                std::string_view vertex_name,
                                                std::span<const std::uint32_t> fragment_spirv,
                                                std::string_view fragment_name,
                                                const ShaderTarget& target = {}, bool points = false);

}  // namespace quadrille::pipeline
