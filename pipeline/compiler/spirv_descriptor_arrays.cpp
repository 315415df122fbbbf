#include "pipeline/compiler/spirv_descriptor_arrays.h"

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "pipeline/compiler/spirv_words.h"

#include <spirv-tools/optimizer.hpp>

#include <unordered_map>
#include <unordered_set>

namespace quadrille::pipeline {
namespace {

/// The types of a module that arrays of descriptors are made of.
struct DescriptorTypes {
  std::unordered_set<std::uint32_t> descriptors;             ///< images, samplers, both in one, structures
  std::unordered_map<std::uint32_t, std::uint32_t> arrays;   ///< of them: the id of the length; 0: none
  std::unordered_map<std::uint32_t, std::uint32_t> pointed;  ///< by pointer type
  std::unordered_map<std::uint32_t, std::uint32_t> constants;
};

DescriptorTypes types_of(std::span<const std::uint32_t> words) {
  DescriptorTypes types;
  for (const auto& [at, count] : layout_of(words)) {
    switch (opcode(words, at)) {
      case spv::OpTypeImage:
      case spv::OpTypeSampler:
      case spv::OpTypeSampledImage:
      case spv::OpTypeStruct: types.descriptors.insert(words[at + 1]); break;
      case spv::OpTypeArray:
      case spv::OpTypeRuntimeArray:
        if (types.descriptors.contains(words[at + 2]))
          types.arrays[words[at + 1]] = count > 3 ? words[at + 3] : 0;
        break;
      case spv::OpTypePointer: types.pointed[words[at + 1]] = words[at + 3]; break;
      case spv::OpConstant:
      case spv::OpSpecConstant: types.constants[words[at + 2]] = words[at + 3]; break;
      default: break;
    }
  }
  return types;
}

bool is_resource(std::uint32_t storage) {
  return storage == spv::StorageClassUniformConstant || storage == spv::StorageClassUniform ||
         storage == spv::StorageClassStorageBuffer;
}

template <class Change>
void change_bindings(std::vector<std::uint32_t>& words, const Change& change) {
  for (const auto& [at, count] : layout_of(words))
    if (opcode(words, at) == spv::OpDecorate && count == 4 && words[at + 2] == spv::DecorationBinding)
      words[at + 3] = change(words[at + 3]);
}

/// The passes know no other uses of resources than those in functions. From SPIR-V 1.4 on entry points name
/// them, too.
void leave_out_of_entry_points(std::vector<std::uint32_t>& words) {
  std::unordered_set<std::uint32_t> resources;
  const Layout layout = layout_of(words);
  for (const auto& [at, count] : layout)
    if (opcode(words, at) == spv::OpVariable && is_resource(words[at + 3])) resources.insert(words[at + 2]);
  std::vector<std::uint32_t> out(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(layout[0].first));
  for (const auto& [at, count] : layout) {
    const std::size_t begin = out.size();
    const bool entry = opcode(words, at) == spv::OpEntryPoint;
    for (std::size_t w = at; w < at + count; ++w)
      if (!entry || w < at + 3 || !resources.contains(words[w])) out.push_back(words[w]);
    out[begin] = static_cast<std::uint32_t>(out.size() - begin) << 16 | opcode(words, at);
  }
  words = std::move(out);
}

}  // namespace

bool has_descriptor_arrays(std::span<const std::uint32_t> words, std::string_view shader) {
  const DescriptorTypes types = types_of(words);
  bool found = false;
  for (const auto& [at, count] : layout_of(words)) {
    if (opcode(words, at) != spv::OpVariable || !is_resource(words[at + 3])) continue;
    const auto pointed = types.pointed.find(words[at + 1]);
    if (pointed == types.pointed.end()) continue;
    const auto array = types.arrays.find(pointed->second);
    if (array == types.arrays.end()) continue;
    const auto length = types.constants.find(array->second);
    if (array->second == 0)
      throw user_error("{}: an array of descriptors without a size is not supported; give it one", shader);
    if (length == types.constants.end())
      throw user_error("{}: an array of descriptors whose size is an expression is not supported", shader);
    if (length->second > models::kMaxDescriptorElements)
      throw user_error("{}: an array of {} descriptors; at most {} are supported", shader, length->second,
                       models::kMaxDescriptorElements);
    found |= length->second > 1;
  }
  return found;
}

void spread_bindings(std::vector<std::uint32_t>& words, std::string_view shader) {
  leave_out_of_entry_points(words);
  change_bindings(words, [&](std::uint32_t binding) {
    if (binding > models::kMaxBinding)
      throw user_error("{}: binding {}; at most {} is possible", shader, binding, models::kMaxBinding);
    return binding << models::kBindingBits;
  });
}

void register_descriptor_array_passes(spvtools::Optimizer& optimizer) {
  optimizer.RegisterPass(spvtools::CreateReplaceDescArrayAccessUsingVarIndexPass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass())  // the chains that it leaves unused
      .RegisterPass(spvtools::CreateDescriptorScalarReplacementPass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass())
      .RegisterPass(spvtools::CreateRemoveUnusedInterfaceVariablesPass());  // and adds those that are used
}

void name_elements(std::vector<std::uint32_t>& words) {
  change_bindings(words, [](std::uint32_t spread) {
    return models::element_binding(spread >> models::kBindingBits, spread & models::kMaxBinding);
  });
}

}  // namespace quadrille::pipeline
