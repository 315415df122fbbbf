/// SPIR-V as its instructions. [SPIRV §2.3]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::capture {

using Instruction = std::span<const std::uint32_t>;
inline constexpr std::size_t kSpirvHeader = 5, kSpirvBound = 3;

// Numbers of instructions and decorations. [SPIRV §3]
enum Op : std::uint32_t {
  kName = 5,
  kEntryPoint = 15,
  kExecutionMode = 16,
  kCapability = 17,
  kTypeInt = 21,
  kTypeFloat = 22,
  kTypeVector = 23,
  kTypeArray = 28,
  kTypePointer = 32,
  kConstant = 43,
  kSpecTrue = 48,
  kSpecFalse = 49,
  kSpecConstant = 50,
  kFunction = 54,
  kFunctionEnd = 56,
  kFunctionCall = 57,
  kVariable = 59,
  kLoad = 61,
  kStore = 62,
  kCopyMemory = 63,
  kAccessChain = 65,
  kInBoundsAccessChain = 66,
  kPtrAccessChain = 67,
  kDecorate = 71,
  kMemberDecorate = 72,
  kCompositeExtract = 81,
  kCompositeInsert = 82,
  kCopyObject = 83,
  kFAdd = 129,
  kFMul = 133,
  kSelect = 169,
  kAtomicStore = 228,
  kFirstAtomic = 229,  ///< of those that give what was there
  kLastAtomic = 242,
  kPhi = 245,
  kLabel = 248,
  kReturn = 253,
  kDemote = 5380,
  kAtomicFMin = 5614,
  kAtomicFMax = 5615,
  kAtomicFAdd = 6035
};
inline constexpr std::uint32_t kSpecId = 1, kBuiltIn = 11, kFlat = 14, kLocation = 30, kBinding = 33,
                               kDescriptorSet = 34;

[[nodiscard]] inline std::uint32_t op_of(Instruction i) { return i[0] & 0xffff; }
/// The instructions of a module. Throws `UserError` for words that form none.
[[nodiscard]] std::vector<Instruction> split(std::span<const std::uint32_t> words);

}  // namespace quadrille::capture
