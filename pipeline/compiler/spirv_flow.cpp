#include "pipeline/compiler/spirv_flow.h"

#include <algorithm>

namespace quadrille::pipeline {

SpirvFlow::SpirvFlow(std::span<const std::uint32_t> words) : words_(words) {
  for (const auto& [at, count] : layout_of(words)) add(at, count);
  for (auto& entry : functions) {
    std::unordered_map<Id, Block>& blocks = entry.second.blocks;
    for (auto& [label, block] : blocks) {
      // parts of a wide literal
      std::erase_if(block.successors, [&](Id to) { return !blocks.contains(to); });
      for (const Id to : block.successors) blocks.at(to).predecessors.push_back(label);
    }
  }
  while (spread_kills()) {}
}

/// A call may end the invocation when the function called may. Returns whether that was news of any block.
bool SpirvFlow::spread_kills() {
  std::unordered_set<Id> killers;
  for (const auto& [id, function] : functions) {
    for (const auto& entry : function.blocks) {
      if (entry.second.kills) killers.insert(id);
    }
  }
  bool news = false;
  for (auto& function : functions) {
    for (auto& entry : function.second.blocks) {
      Block& block = entry.second;
      if (block.kills ||
          std::ranges::none_of(block.calls, [&](Id callee) { return killers.contains(callee); }))
        continue;
      news = block.kills = block.ends = true;
    }
  }
  return news;
}

void SpirvFlow::add(std::size_t at, std::size_t count) {
  const std::uint32_t* const operands = words_.data() + at + 1;
  switch (static_cast<std::uint32_t>(opcode(words_, at))) {
    case spv::OpEntryPoint: entry_points.push_back(operands[1]); break;
    case spv::OpConstantTrue:
    case spv::OpSpecConstantTrue: constants_[operands[1]] = true; break;
    case spv::OpConstantFalse:
    case spv::OpSpecConstantFalse: constants_[operands[1]] = false; break;
    case spv::OpLine: line_ = operands[1]; break;
    case spv::OpNoLine: line_ = 0; break;
    case spv::OpFunction: function_ = &functions[operands[1]]; break;
    case spv::OpLabel: open_block(operands[0]); break;
    default:
      if (block_ != nullptr) add_to_block(operands, at, count);
  }
}

void SpirvFlow::open_block(Id label) {
  if (function_->entry == 0) function_->entry = label;
  block_ = &function_->blocks[label];
}

void SpirvFlow::add_to_block(const std::uint32_t* operands, std::size_t at, std::size_t count) {
  const auto leads_to = [&](std::size_t operand) { block_->successors.push_back(operands[operand]); };
  switch (static_cast<std::uint32_t>(opcode(words_, at))) {
    case spv::OpFunctionCall: block_->calls.push_back(operands[2]); break;
    case spv::OpLoopMerge:
      block_->loop = true;
      block_->merge = operands[0];
      block_->continue_target = operands[1];
      block_->line = line_;
      break;
    case spv::OpBranch: leads_to(0); break;
    case spv::OpBranchConditional: {
      const auto known = constants_.find(operands[0]);
      if (known == constants_.end() || known->second) leads_to(1);
      if (known == constants_.end() || !known->second) leads_to(2);
      break;
    }
    // a default, then pairs of literal and label; wider selectors than 32 bits are refused later
    case spv::OpSwitch:
      for (std::size_t target = 1; target + 1 < count; target += 2) leads_to(target);
      break;
    case spv::OpKill:
    case spv::OpTerminateInvocation: block_->kills = block_->ends = true; break;
    case spv::OpReturn:
    case spv::OpReturnValue:
    case spv::OpUnreachable: block_->ends = true; break;
    default: break;
  }
}

std::unordered_set<SpirvFlow::Id> SpirvFlow::reached(const Function& function, std::vector<Id> from,
                                                     std::vector<Id> Block::*edges,
                                                     const std::unordered_set<Id>& walls) {
  std::unordered_set<Id> found(from.begin(), from.end());
  while (!from.empty()) {
    const Block& block = function.blocks.at(from.back());
    from.pop_back();
    for (const Id next : block.*edges) {
      if (!walls.contains(next) && found.insert(next).second) from.push_back(next);
    }
  }
  return found;
}

}  // namespace quadrille::pipeline
