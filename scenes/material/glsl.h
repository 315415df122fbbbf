/// GLSL 4.50 (Vulkan) to SPIR-V, by glslang: how materials and a user's own shaders enter the command stream.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::scenes {

/// Compiles one stage to SPIR-V 1.3 (Vulkan 1.1), entry point "main", with names kept for error messages.
/// `name` stands for the source in errors (a file name); each of `defines` is "NAME" or "NAME VALUE" and is
/// defined before the first line. Throws `UserError` "name:line: message" with the first error of glslang's
/// log.
[[nodiscard]] std::vector<std::uint32_t> compile_glsl(std::string_view source, traces::ShaderStage stage,
                                                      std::string_view name,
                                                      std::span<const std::string> defines = {});

}  // namespace quadrille::scenes
