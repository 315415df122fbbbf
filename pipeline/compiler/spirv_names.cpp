#include "pipeline/compiler/spirv_names.h"

#include <fmt/format.h>
#include <spirv-tools/libspirv.hpp>

#include <algorithm>
#include <array>
#include <sstream>

namespace quadrille::pipeline::spirv {
namespace {

using Words = std::vector<std::uint32_t>;

void append(Words& module, spv::Op op, std::initializer_list<std::uint32_t> operands) {
  module.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | static_cast<std::uint32_t>(op));
  module.insert(module.end(), operands);
}

/// The words of the last instruction's line; empty where the disassembler does not take it.
std::vector<std::string> disassemble(const Words& instructions) {
  constexpr std::uint32_t kVersion = 0x00010300, kBound = 0x3fffff;
  Words module{spv::MagicNumber, kVersion, 0, kBound, 0};
  module.insert(module.end(), instructions.begin(), instructions.end());
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  tools.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
  std::string text;
  if (!tools.Disassemble(module, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER)) return {};
  std::istringstream lines(text);
  std::vector<std::string> words;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream parts(line);
    words.assign(std::istream_iterator<std::string>(parts), {});
  }
  return words;
}

std::string word_or_number(const std::vector<std::string>& words, std::size_t place, std::string_view kind,
                           std::uint32_t number) {
  return place < words.size() ? words[place] : fmt::format("{} {}", kind, number);
}

/// What GLSL calls an instruction that the compiler does not know, and what does the same.
struct Advice {
  std::string_view name, advice;
};
constexpr auto kAdvice = std::to_array<Advice>({
    {"OpImageRead", "imageLoad; use a sampler2D"},
    {"OpImageWrite", "imageStore; write to the colour output"},
    {"OpIAddCarry", "uaddCarry; the carry is sum < a"},
    {"OpISubBorrow", "usubBorrow; the borrow is a < b"},
    {"OpUMulExtended", "umulExtended; multiply 16-bit halves"},
    {"OpSMulExtended", "imulExtended; multiply 16-bit halves"},
    {"OpFunctionCall", "a call that cannot be expanded in place"},
    {"OpCopyMemory", "a copy between variables; load and store"},
    {"InterpolateAtOffset", "interpolateAtOffset; add dFdx and dFdy times the offset"},
    {"PackDouble2x32", "packDouble2x32; use 32-bit floats"},
    {"UnpackDouble2x32", "unpackDouble2x32; use 32-bit floats"},
});

std::string with_advice(const std::string& name) {
  const auto* const found = std::ranges::find(kAdvice, name, &Advice::name);
  return found == kAdvice.end() ? name : fmt::format("{} ({})", name, found->advice);
}

}  // namespace

std::string name_of(const Instruction& instruction) {
  const std::size_t fixed = 1u + (instruction.type != 0 ? 1u : 0u) + (instruction.result != 0 ? 1u : 0u);
  const std::uint32_t* const first = instruction.operands.data() - fixed;
  const bool extended = instruction.op == spv::OpExtInst;
  Words module;
  // "GLSL.std.450"
  if (extended)
    append(module, spv::OpExtInstImport, {instruction.operands[0], 0x4c534c47, 0x6474732e, 0x3035342e, 0});
  module.insert(module.end(), first, instruction.operands.data() + instruction.operands.size());
  const std::vector<std::string> words = disassemble(module);
  const std::size_t place = instruction.result != 0 ? 2 : 0;  // "%1 = OpName ..."
  const std::string name = word_or_number(words, place, "opcode", static_cast<std::uint32_t>(instruction.op));
  return with_advice(
      extended ? word_or_number(words, place + 3, "GLSL.std.450 function", instruction.operands[1]) : name);
}

std::string capability_name(std::uint32_t capability) {
  Words module;
  append(module, spv::OpCapability, {capability});
  return word_or_number(disassemble(module), 1, "number", capability);
}

std::string storage_class_name(spv::StorageClass storage) {
  Words module;
  append(module, spv::OpTypePointer, {1, static_cast<std::uint32_t>(storage), 2});
  return word_or_number(disassemble(module), 3, "number", static_cast<std::uint32_t>(storage));
}

bool harmless_capability(std::uint32_t capability) {
  return capability == spv::CapabilityMatrix || capability == spv::CapabilityShader ||
         capability == spv::CapabilityImageQuery || capability == spv::CapabilitySampled1D ||
         capability == spv::CapabilitySampledCubeArray || capability == spv::CapabilityImageCubeArray ||
         capability == spv::CapabilityImageGatherExtended || capability == spv::CapabilityDerivativeControl ||
         capability == spv::CapabilitySampleRateShading ||
         capability == spv::CapabilityInterpolationFunction || capability == spv::CapabilityGeometry ||
         capability == spv::CapabilityClipDistance || capability == spv::CapabilityCullDistance ||
         capability == spv::CapabilityDemoteToHelperInvocation ||
         capability == spv::CapabilityDrawParameters || capability == spv::CapabilityMultiViewport ||
         capability == spv::CapabilityShaderViewportIndex ||
         capability == spv::CapabilityShaderViewportIndexLayerEXT ||
         capability == spv::CapabilityVariablePointersStorageBuffer ||
         // Of arrays, which are refused where they are asked for if they are not supported.
         capability == spv::CapabilityUniformBufferArrayDynamicIndexing ||
         capability == spv::CapabilitySampledImageArrayDynamicIndexing ||
         capability == spv::CapabilityStorageBufferArrayDynamicIndexing ||
         // Which accesses of memory others see is asked of buffers that several invocations write: those obey
         // stricter rules here.
         capability == spv::CapabilityVulkanMemoryModel ||
         capability == spv::CapabilityVulkanMemoryModelDeviceScope;
}

std::string instead_of_capability(std::uint32_t capability) {
  switch (capability) {
    case spv::CapabilityFloat64: return "use float instead of double";
    case spv::CapabilityInt64:
    case spv::CapabilityInt16:
    case spv::CapabilityInt8:
    case spv::CapabilityStorageUniform16:
    case spv::CapabilityStorageInputOutput16: return "use 32-bit integers";
    case spv::CapabilityFloat16: return "use 32-bit floats";
    case spv::CapabilitySampledBuffer:
    case spv::CapabilitySampledRect:
    case spv::CapabilityImage1D:
    case spv::CapabilityImageBuffer:
    case spv::CapabilityStorageImageExtendedFormats:
    case spv::CapabilityInputAttachment: return "use a sampler2D";
    case spv::CapabilityMinLod: return "use textureLod";
    case spv::CapabilityTessellation:
    case spv::CapabilityMultiViewport:
    case spv::CapabilityMultiView: return "only vertex and fragment shaders of one view are drawn";
    default: return "";
  }
}

}  // namespace quadrille::pipeline::spirv
