/// Variants of the materials' shaders that were compiled with the program, so that a scene which uses no
/// other needs no GLSL compiler: preparing that one costs more than many a small frame.
///
/// The pack is one array of 32-bit words, found by key: the number of shaders n; n times key's first byte,
/// key's bytes, first word, words, sorted by key; the keys' bytes (from a word of its own); the shaders.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::scenes {

/// What a variant of a stage is found by.
[[nodiscard]] std::string shader_key(traces::ShaderStage stage, const std::vector<std::string>& defines);

[[nodiscard]] std::vector<std::uint32_t> write_shader_pack(
    const std::map<std::string, std::vector<std::uint32_t>>& shaders);

class ShaderPack {
 public:
  /// Of words that `write_shader_pack` made and that outlive it.
  explicit ShaderPack(const std::uint32_t* words) : words_(words) {}
  [[nodiscard]] std::size_t size() const { return words_[0]; }
  [[nodiscard]] std::string_view key(std::size_t i) const;
  [[nodiscard]] std::span<const std::uint32_t> shader(std::size_t i) const;
  /// Empty when there is none.
  [[nodiscard]] std::span<const std::uint32_t> find(std::string_view key) const;

 private:
  const std::uint32_t* words_;
};

}  // namespace quadrille::scenes
