#include "pipeline/compiler/spirv_returning_kills.h"

#include "pipeline/compiler/spirv_flow.h"

#include <algorithm>
#include <unordered_set>

namespace quadrille::pipeline {
namespace {

using Id = SpirvFlow::Id;

bool may_kill(const SpirvFlow::Function& function) {
  return std::ranges::any_of(function.blocks, [](const auto& entry) { return entry.second.kills; });
}

/// Functions that may kill and are called where a loop continues, and those that may kill and are called by
/// them.
std::unordered_set<Id> killers_in_continues(const SpirvFlow& flow) {
  std::unordered_set<Id> found;
  std::vector<Id> open;
  const auto add_calls = [&](const SpirvFlow::Block& block) {
    for (const Id callee : block.calls) {
      const auto function = flow.functions.find(callee);
      if (function != flow.functions.end() && may_kill(function->second) && found.insert(callee).second)
        open.push_back(callee);
    }
  };
  for (const auto& [id, function] : flow.functions) {
    for (const auto& [header, block] : function.blocks) {
      if (!block.loop || !function.blocks.contains(block.continue_target)) continue;
      const auto construct = SpirvFlow::reached(function, {block.continue_target},
                                                &SpirvFlow::Block::successors, {header, block.merge});
      for (const Id label : construct) add_calls(function.blocks.at(label));
    }
  }
  while (!open.empty()) {
    const Id id = open.back();
    open.pop_back();
    for (const auto& entry : flow.functions.at(id).blocks) add_calls(entry.second);
  }
  return found;
}

void append(std::vector<std::uint32_t>& words, spv::Op op, std::initializer_list<std::uint32_t> operands) {
  words.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | static_cast<std::uint32_t>(op));
  words.insert(words.end(), operands);
}

/// The capability and the extension that demotion needs. Both lists come first in a module, and saying a
/// thing twice does no harm.
void append_permission(std::vector<std::uint32_t>& words, spv::Op last) {
  constexpr std::uint32_t kSpvExtDemote[] = {0x5f565053, 0x5f545845, 0x6f6d6564, 0x745f6574, 0x65685f6f,
                                             // "SPV_EXT_demote_to_helper_invocation"
                                             0x7265706c, 0x766e695f, 0x7461636f, 0x006e6f69};
  if (last == spv::OpCapability)
    return append(words, spv::OpCapability, {spv::CapabilityDemoteToHelperInvocation});
  words.push_back(static_cast<std::uint32_t>(std::size(kSpvExtDemote) + 1) << 16 |
                  static_cast<std::uint32_t>(spv::OpExtension));
  words.insert(words.end(), std::begin(kSpvExtDemote), std::end(kSpvExtDemote));
}

}  // namespace

ReturningKills let_kills_return(std::vector<std::uint32_t> words) {
  const std::unordered_set<Id> killers = killers_in_continues(SpirvFlow(words));
  if (killers.empty()) return {std::move(words), false};
  constexpr std::size_t kHeaderWords = 5, kBoundWord = 3;
  std::vector<std::uint32_t> out(words.begin(), words.begin() + kHeaderWords);
  std::unordered_set<Id> void_types;
  Id function = 0, result_type = 0;
  spv::Op last = spv::OpNop;
  for (const auto& [at, count] : layout_of(words)) {
    const spv::Op op = opcode(words, at);
    if (last == spv::OpCapability && op != spv::OpCapability) {
      append_permission(out, spv::OpCapability);
      append_permission(out, spv::OpExtension);
    }
    last = op;
    if (op == spv::OpTypeVoid) void_types.insert(words[at + 1]);
    if (op == spv::OpFunction) function = words[at + 2], result_type = words[at + 1];
    if ((op == spv::OpKill || op == spv::OpTerminateInvocation) && killers.contains(function)) {
      append(out, spv::OpDemoteToHelperInvocation, {});
      if (void_types.contains(result_type)) {
        append(out, spv::OpReturn, {});
        continue;
      }
      const Id nothing = out[kBoundWord]++;
      append(out, spv::OpUndef, {result_type, nothing});
      append(out, spv::OpReturnValue, {nothing});
      continue;
    }
    out.insert(out.end(), words.begin() + static_cast<std::ptrdiff_t>(at),
               words.begin() + static_cast<std::ptrdiff_t>(at + count));
  }
  return {std::move(out), true};
}

}  // namespace quadrille::pipeline
