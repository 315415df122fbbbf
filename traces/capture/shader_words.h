/// What a capture's SPIR-V becomes before it is a shader of the stream: one entry point, called "main";
/// specialisation constants with the pipeline's values; the number of the draw's first instance, which this
/// machine's shaders cannot ask for, as a constant; depths from OpenGL's clip space into Vulkan's; and
/// outputs at the places of a pass without holes.
/// [SPIRV §2.3]
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::capture {

struct ShaderWish {
  std::string entry = "main";
  traces::ShaderStage stage = traces::ShaderStage::kVertex;
  std::map<std::uint32_t, std::uint32_t> constants;  ///< by constant number: the bits of a 32-bit value
  /// Clip space of its position is -w <= z <= w: behind its last instruction z becomes (z + w) / 2.
  bool negative_one_to_one = false;
  std::uint32_t first_instance = 0;  ///< what gl_BaseInstance is
  /// Of a fragment shader: locations of outputs that move, and where to.
  std::map<std::uint32_t, std::uint32_t> outputs;
};

/// Does it ask for the number of the draw's first instance?
[[nodiscard]] bool reads_first_instance(std::span<const std::uint32_t> module);

/// Throws `UserError` for a module without that entry point, or whose words do not form instructions.
[[nodiscard]] std::vector<std::uint32_t> shader_words(std::span<const std::uint32_t> module,
                                                      const ShaderWish& wish);

/// What a draw has to know of a shader.
struct ShaderFacts {
  /// By set and binding of what it declares: how many descriptors.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> bindings;
  /// Those of them that it may write to.
  std::set<std::pair<std::uint32_t, std::uint32_t>> written;
  bool flat_input = false;  ///< of the provoking vertex
};
[[nodiscard]] ShaderFacts shader_facts(std::span<const std::uint32_t> words);

}  // namespace quadrille::capture
