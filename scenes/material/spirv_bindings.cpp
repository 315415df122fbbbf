#include "scenes/material/spirv_bindings.h"

#include <cstddef>
#include <map>

namespace quadrille::scenes {
namespace {

// [SPV #instructions, #decoration]
constexpr std::uint32_t kDecorate = 71, kFunction = 54, kBinding = 33, kDescriptorSet = 34;
constexpr std::size_t kHeaderWords = 5;

struct Place {
  std::uint32_t set = 0, binding = 0;
};

}  // namespace

std::set<std::uint32_t> mentioned_bindings(std::span<const std::uint32_t> spirv, std::uint32_t set) {
  std::map<std::uint32_t, Place> places;  // by the variable's id
  std::set<std::uint32_t> mentioned;
  bool in_functions = false;
  for (std::size_t at = kHeaderWords; at < spirv.size();) {
    const std::uint32_t opcode = spirv[at] & 0xffff;
    const std::size_t words = spirv[at] >> 16;
    if (words == 0 || words > spirv.size() - at) break;
    const std::span<const std::uint32_t> operands = spirv.subspan(at + 1, words - 1);
    in_functions = in_functions || opcode == kFunction;
    if (opcode == kDecorate && operands.size() == 3) {
      if (operands[1] == kBinding) places[operands[0]].binding = operands[2];
      if (operands[1] == kDescriptorSet) places[operands[0]].set = operands[2];
    }
    // A literal that equals an id only makes a binding that is not read look as if it were.
    for (const std::uint32_t id : in_functions ? operands : std::span<const std::uint32_t>()) {
      if (const auto found = places.find(id); found != places.end() && found->second.set == set)
        mentioned.insert(found->second.binding);
    }
    at += words;
  }
  return mentioned;
}

}  // namespace quadrille::scenes
