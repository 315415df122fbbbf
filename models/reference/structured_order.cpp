/// The order of a function's blocks that lets diverged lanes meet again.
#include <algorithm>
#include <set>
#include <spirv/unified1/spirv.hpp>

#include "models/reference/spirv_module.h"

namespace quadrille::models::reference {
namespace {

/// Depth-first search that visits merge and continue blocks before the others, so that they come later in the
/// reversed post-order.
class StructuredOrder {
 public:
  explicit StructuredOrder(const SpirvFunction& function) : function_(function) {
    for (std::size_t i = 0; i < function.blocks.size(); ++i) index_[function.blocks[i].label] = i;
    mark_reachable();
  }

  std::vector<std::size_t> order() {
    visit_from(0);
    std::reverse(post_order_.begin(), post_order_.end());
    std::erase_if(post_order_, [this](std::size_t block) { return !reachable_.contains(block); });
    return post_order_;
  }

 private:
  void mark_reachable() {
    std::vector<std::size_t> open{0};
    while (!open.empty()) {
      const std::size_t block = open.back();
      open.pop_back();
      if (!reachable_.insert(block).second) continue;
      for (const Id next : successors(function_.blocks[block].terminator)) open.push_back(index_.at(next));
    }
  }

  [[nodiscard]] std::vector<std::size_t> children(std::size_t block) const {
    const SpirvBlock& b = function_.blocks[block];
    std::vector<std::size_t> out;
    if (b.merge != 0) out.push_back(index_.at(b.merge));
    if (b.loop_continue != 0) out.push_back(index_.at(b.loop_continue));
    for (const Id next : successors(b.terminator)) out.push_back(index_.at(next));
    return out;
  }

  void visit_from(std::size_t root) {  // with its own stack: hostile modules nest deeply
    struct Visit {
      std::size_t block;
      std::vector<std::size_t> children;
      std::size_t next = 0;
    };
    std::vector<Visit> stack;
    const auto enter = [&](std::size_t block) {
      if (seen_.insert(block).second) stack.push_back({block, children(block)});
    };
    enter(root);
    while (!stack.empty()) {
      Visit& top = stack.back();
      if (top.next < top.children.size()) {
        enter(top.children[top.next++]);
      } else {
        post_order_.push_back(top.block);
        stack.pop_back();
      }
    }
  }

  const SpirvFunction& function_;
  std::unordered_map<Id, std::size_t> index_;
  std::set<std::size_t> reachable_, seen_;
  std::vector<std::size_t> post_order_;
};

}  // namespace

std::vector<std::size_t> structured_order(const SpirvFunction& function) {
  return StructuredOrder(function).order();
}

std::vector<Id> successors(const SpirvInstruction& terminator) {
  const std::vector<std::uint32_t>& w = terminator.words;
  switch (terminator.op) {
    case spv::OpBranch: return {w[0]};
    case spv::OpBranchConditional: return {w[1], w[2]};
    case spv::OpSwitch: {
      std::vector<Id> out{w[1]};
      for (std::size_t i = 3; i < w.size(); i += 2) out.push_back(w[i]);
      return out;
    }
    default: return {};
  }
}

}  // namespace quadrille::models::reference
