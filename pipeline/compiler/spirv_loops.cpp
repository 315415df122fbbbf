#include "pipeline/compiler/spirv_loops.h"

#include "models/base/error.h"
#include "pipeline/compiler/spirv_flow.h"

#include <unordered_set>
#include <vector>

namespace quadrille::pipeline {

void refuse_endless_loops(std::span<const std::uint32_t> words, std::string_view shader) {
  using Id = SpirvFlow::Id;
  const SpirvFlow flow(words);
  std::vector<Id> open = flow.entry_points;
  std::unordered_set<Id> seen(open.begin(), open.end());
  while (!open.empty()) {
    const SpirvFlow::Function& function = flow.functions.at(open.back());
    open.pop_back();
    if (function.entry == 0) continue;  // it is elsewhere
    std::vector<Id> ends;
    for (const auto& [label, block] : function.blocks) {
      if (block.ends) ends.push_back(label);
    }
    const std::unordered_set<Id> can_end =
        SpirvFlow::reached(function, ends, &SpirvFlow::Block::predecessors);
    for (const Id label : SpirvFlow::reached(function, {function.entry}, &SpirvFlow::Block::successors)) {
      const SpirvFlow::Block& block = function.blocks.at(label);
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
