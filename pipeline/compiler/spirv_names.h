/// What SPIR-V calls things, for messages: the tables of SPIRV-Tools, which only its disassembler gives away.
#pragma once

#include "pipeline/compiler/spirv_module.h"

#include <string>

namespace quadrille::pipeline::spirv {

/// "OpBitCount", or the name of an extended instruction ("FindILsb"); with what GLSL calls it and what to
/// write instead where that is known.
[[nodiscard]] std::string name_of(const Instruction& instruction);
/// "Float64" of the capability, "StorageBuffer" of the storage class. Those that SPIRV-Tools does not know
/// are called by number.
[[nodiscard]] std::string capability_name(std::uint32_t capability);
[[nodiscard]] std::string storage_class_name(spv::StorageClass storage);
/// May a module declare it? What it allows is supported, or refused where it is used.
[[nodiscard]] bool harmless_capability(std::uint32_t capability);
/// What a shader can do without the capability; empty: nothing known.
[[nodiscard]] std::string instead_of_capability(std::uint32_t capability);

}  // namespace quadrille::pipeline::spirv
