#include "pipeline/compiler/spirv_loops.h"

#include "models/base/error.h"
#include "pipeline/compiler/spirv_words.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace quadrille::pipeline {
namespace {

using Id = std::uint32_t;

struct Block {
  std::vector<Id> successors, predecessors, calls;
  bool ends = false;       ///< the function, or the invocation
  bool kills = false;      ///< the invocation
  bool loop = false;       ///< a loop's header
  std::uint32_t line = 0;  ///< of the source where the loop begins, 0: unknown
};

struct Function {
  Id entry = 0;  ///< label of its first block
  std::unordered_map<Id, Block> blocks;
};

/// The control flow of every function.
class Flow {
 public:
  explicit Flow(std::span<const std::uint32_t> words) : words_(words) {
    for (const auto& [at, count] : layout_of(words)) add(at, count);
    for (auto& entry : functions) {
      std::unordered_map<Id, Block>& blocks = entry.second.blocks;
      for (auto& [label, block] : blocks) {
        std::erase_if(block.successors, [&](Id to) { return !blocks.contains(to); });  // parts of a wide literal
        for (const Id to : block.successors) blocks.at(to).predecessors.push_back(label);
      }
    }
    while (spread_kills()) {}
  }
  std::vector<Id> entry_points;
  std::unordered_map<Id, Function> functions;

 private:
  /// A call may end the invocation when the function called may. Returns whether that was news of any block.
  bool spread_kills() {
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
        if (block.kills || std::ranges::none_of(block.calls, [&](Id callee) { return killers.contains(callee); })) continue;
        news = block.kills = block.ends = true;
      }
    }
    return news;
  }
  void add(std::size_t at, std::size_t count) {
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
  void open_block(Id label) {
    if (function_->entry == 0) function_->entry = label;
    block_ = &function_->blocks[label];
  }
  void add_to_block(const std::uint32_t* operands, std::size_t at, std::size_t count) {
    const auto leads_to = [&](std::size_t operand) { block_->successors.push_back(operands[operand]); };
    switch (static_cast<std::uint32_t>(opcode(words_, at))) {
      case spv::OpFunctionCall: block_->calls.push_back(operands[2]); break;
      case spv::OpLoopMerge:
        block_->loop = true;
        block_->line = line_;
        break;
      case spv::OpBranch: leads_to(0); break;
      case spv::OpBranchConditional: {
        const auto known = constants_.find(operands[0]);
        if (known == constants_.end() || known->second) leads_to(1);
        if (known == constants_.end() || !known->second) leads_to(2);
        break;
      }
      case spv::OpSwitch:  // a default, then pairs of literal and label; wider selectors than 32 bits are refused later
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

  std::span<const std::uint32_t> words_;
  std::unordered_map<Id, bool> constants_;
  Function* function_ = nullptr;
  Block* block_ = nullptr;
  std::uint32_t line_ = 0;
};

/// The blocks that edges lead to from `from`, along them or against them.
std::unordered_set<Id> reached(const Function& function, std::vector<Id> from, std::vector<Id> Block::*edges) {
  std::unordered_set<Id> found(from.begin(), from.end());
  while (!from.empty()) {
    const Block& block = function.blocks.at(from.back());
    from.pop_back();
    for (const Id next : block.*edges) {
      if (found.insert(next).second) from.push_back(next);
    }
  }
  return found;
}

}  // namespace

void refuse_endless_loops(std::span<const std::uint32_t> words, std::string_view shader) {
  const Flow flow(words);
  std::vector<Id> open = flow.entry_points;
  std::unordered_set<Id> seen(open.begin(), open.end());
  while (!open.empty()) {
    const Function& function = flow.functions.at(open.back());
    open.pop_back();
    if (function.entry == 0) continue;  // it is elsewhere
    std::vector<Id> ends;
    for (const auto& [label, block] : function.blocks) {
      if (block.ends) ends.push_back(label);
    }
    const std::unordered_set<Id> can_end = reached(function, ends, &Block::predecessors);
    for (const Id label : reached(function, {function.entry}, &Block::successors)) {
      const Block& block = function.blocks.at(label);
      if (block.loop && !can_end.contains(label)) {
        throw user_error("{}{}: a loop without an end: no break, return or discard leads out of it", shader,
                         block.line == 0 ? "" : fmt::format(":{}", block.line));
      }
      for (const Id callee : block.calls) {
        if (seen.insert(callee).second) open.push_back(callee);
      }
    }
  }
}

}  // namespace quadrille::pipeline
