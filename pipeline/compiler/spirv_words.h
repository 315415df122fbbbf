/// A SPIR-V module as its instructions lie in memory: for what has to be known before it is optimised and
/// read.
#pragma once

#ifndef SPV_ENABLE_UTILITY_CODE
#define SPV_ENABLE_UTILITY_CODE
#endif
#include <spirv/unified1/spirv.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace quadrille::pipeline {

/// The instructions in order: (first word, number of words).
using Layout = std::vector<std::pair<std::size_t, std::size_t>>;

[[nodiscard]] inline Layout layout_of(std::span<const std::uint32_t> words) {
  constexpr std::size_t kHeaderWords = 5;
  Layout result;
  for (std::size_t i = kHeaderWords; i < words.size();) {
    const std::size_t count = std::max<std::size_t>(1, words[i] >> 16);
    result.emplace_back(i, std::min(count, words.size() - i));
    i += count;
  }
  return result;
}

[[nodiscard]] inline spv::Op opcode(std::span<const std::uint32_t> words, std::size_t at) {
  return static_cast<spv::Op>(words[at] & 0xffffu);
}

}  // namespace quadrille::pipeline
