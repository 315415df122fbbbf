/// Selections: IF and ELSE, small ones flattened to selected values, switches as a sequence of IFs.
#include "pipeline/compiler/lowering.h"

#include <algorithm>
#include <utility>

namespace quadrille::pipeline {
namespace {

using models::Op;

/// scalar operations of both sides that cost less than branching around them
constexpr int kMaxFlatCost = 10;

bool is_phi(const spirv::Instruction& i) { return i.op == spv::OpPhi; }

}  // namespace

Id Lowering::selection(const spirv::Block& block, Value condition, Id yes, Id no, Id merge,
                       const Stop& stop) {
  if (!flatten(block, condition, yes, no)) {
    const Stop inner{merge, nullptr};
    build_.effect(Op::kIf, condition);
    build_.open_scope();
    side(block.label, yes, inner);
    build_.close_scope();
    build_.effect(Op::kElse);
    build_.open_scope();
    side(block.label, no, inner);
    build_.close_scope();
    build_.effect(Op::kEndIf);
  }
  return follow(merge, stop);
}

/// Scalar operations of an instruction that may run for lanes that did not ask for it; a large number for one
/// that may not.
int Lowering::flat_cost(const spirv::Instruction& i) const {
  constexpr int kNever = 1000;
  const int width =
      static_cast<int>(std::min<std::uint32_t>(i.type == 0 ? 1 : module_.type(i.type).scalars, kNever));
  const auto op = static_cast<std::uint32_t>(i.op);
  if (op == spv::OpExtInst) {
    const std::uint32_t name = i.operands[1];
    // rounding, sign; min, max, clamp
    return name >= 1 && name <= 12 ? width : name >= 37 && name <= 45 ? 2 * width : kNever;
  }
  if (op == spv::OpCompositeExtract || op == spv::OpCompositeConstruct || op == spv::OpVectorShuffle ||
      op == spv::OpBitcast || op == spv::OpCopyObject || op == spv::OpAccessChain || op == spv::OpFNegate)
    return 0;
  if (op == spv::OpLoad) {
    const auto found = pointers_.find(i.operands[0]);
    return found != pointers_.end() && found->second.dynamic.empty() &&
                   found->second.storage == spv::StorageClassUniform
               ? 0
               : kNever;
  }
  if (op == spv::OpDot || (op >= spv::OpVectorTimesMatrix && op <= spv::OpOuterProduct)) return kNever;
  if ((op >= spv::OpSNegate && op <= spv::OpVectorTimesScalar) ||
      (op >= spv::OpLogicalEqual && op <= spv::OpNot))
    return width;
  return kNever;
}

int Lowering::flat_cost(Id label, Id merge) const {
  constexpr int kNever = 1000;
  if (label == merge) return 0;
  const spirv::Block& block = module_.block(label);
  if (block.merge_kind != spv::OpNop || block.terminator.op != spv::OpBranch ||
      block.terminator.operands[0] != merge)
    return kNever;
  int cost = 0;
  for (const spirv::Instruction& i : block.body) {
    cost = std::min(kNever, cost + (is_phi(i) ? kNever : flat_cost(i)));
    if (cost >= kNever) break;
  }
  return cost;
}

/// Runs both sides of a small selection for all lanes and selects the results.
bool Lowering::flatten(const spirv::Block& block, Value condition, Id yes, Id no) {
  const spirv::Block& merge = module_.block(block.merge);
  if (flat_cost(yes, block.merge) + flat_cost(no, block.merge) > kMaxFlatCost) return false;
  for (const spirv::Instruction& i : merge.body)
    if (is_phi(i) && i.operands.size() != 4) return false;
  for (const Id arm : {yes, no})
    if (arm != block.merge) body(module_.block(arm));
  const Id yes_edge = yes == block.merge ? block.label : yes;
  for (const spirv::Instruction& i : merge.body) {
    if (!is_phi(i)) break;
    const bool first = i.operands[1] == yes_edge;
    const Values a = value(i.operands[first ? 0 : 2]), b = value(i.operands[first ? 2 : 0]);
    Values& result = resolved_phis_[i.result];
    result.clear();
    for (std::size_t c = 0; c < a.size(); ++c) result.push_back(build_.select(condition, a[c], b[c]));
  }
  return true;
}

/// The case that the default falls into, or 0. The blocks of the default end at the switch's merge, at
/// another case and where they leave the loop around it.
Id Lowering::default_falls_into(const Cases& cases, Id otherwise, Id merge) const {
  std::unordered_set<Id> seen{merge};
  if (const LoopFrame* loop = real_loop(); loop != nullptr)
    seen.insert({loop->merge, loop->continue_target, loop->header});
  std::vector<Id> open{otherwise};
  while (!open.empty()) {
    const Id label = open.back();
    open.pop_back();
    if (!seen.insert(label).second) continue;
    if (std::ranges::find(cases, label, &Cases::value_type::first) != cases.end()) return label;
    for (const Id to : spirv::successors(module_.block(label))) open.push_back(to);
  }
  return 0;
}

/// The others stand in an order in which each falls into a later one, if into any [SPV
/// #StructuredControlFlow]; the default has no place in that list.
void Lowering::add_default(Cases& cases, Id otherwise, Value mask, Id merge) const {
  const Id next = otherwise == merge ? 0 : default_falls_into(cases, otherwise, merge);
  cases.emplace(std::ranges::find(cases, next, &Cases::value_type::first), otherwise, mask);
}

/// Cases are exclusive, so they follow each other as IFs, each with the mask of its lanes; a case that falls
/// into a later one sets that one's flag.
Id Lowering::lower_switch(const spirv::Block& block, const Stop& stop) {
  const auto operands = block.terminator.operands;
  const Value selector = scalar(operands[0]);
  const Id otherwise = operands[1], merge = block.merge;
  if (block.merge_kind != spv::OpSelectionMerge)
    throw unsupported(block.terminator, "a switch without a merge block");
  Cases cases;
  Value matched = literal(0u);
  for (std::size_t k = 2; k + 1 < operands.size(); k += 2) {
    const Id label = operands[k + 1];
    if (label == otherwise) continue;
    const Value equal = build_.emit(Op::kIEq, selector, literal(operands[k]));
    matched = build_.emit(Op::kOr, matched, equal);
    const auto known =
        std::find_if(cases.begin(), cases.end(), [&](const auto& entry) { return entry.first == label; });
    if (known == cases.end()) cases.emplace_back(label, equal);
    else known->second = build_.emit(Op::kOr, known->second, equal);
  }
  add_default(cases, otherwise, build_.invert(matched), merge);
  std::erase_if(cases, [&](const auto& entry) { return entry.first == merge; });
  const bool looped = attempts_.looped_switches.contains(block.label);
  copy_phis(block.label, merge);
  std::map<Id, Value> to_come;
  for (const auto& [label, mask] : cases) {
    copy_phis(block.label, label);
    const Value flag = build_.new_variable();
    build_.assign(flag, literal(0u));
    to_come[label] = flag;
  }
  if (looped) {
    LoopFrame frame;
    frame.is_switch = true;
    frame.merge = merge;
    push_loop(frame);
  } else {
    open_switches_[merge] = block.label;
  }
  for (const auto& [label, mask] : cases) {
    const Value flag = to_come[label];
    to_come.erase(label);
    if (cases.size() == 1 && mask.is_literal() && mask.bits != 0) {
      region(label, {merge, &to_come});
      continue;
    }
    build_.effect(Op::kIf, build_.emit(Op::kOr, mask, build_.read(flag)));
    build_.open_scope();
    region(label, {merge, &to_come});
    build_.close_scope();
    build_.effect(Op::kEndIf);
  }
  if (looped) {
    build_.effect(Op::kBreakIf, literal(kTrue));
    pop_loop();
  } else {
    open_switches_.erase(merge);
  }
  return follow(merge, stop);
}

}  // namespace quadrille::pipeline
