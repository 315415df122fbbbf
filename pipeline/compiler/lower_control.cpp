/// Control flow: the structured graph of SPIR-V becomes nested IF and LOOP.
///
/// A region is lowered block by block until an edge leads to where it stops. Phis: each edge into a block
/// copies the values of the block's phis into one variable a scalar, the block begins by reading them; copies
/// that turn out to be needless are removed by the register allocator.
#include "pipeline/compiler/lowering.h"

#include <algorithm>
#include <utility>

namespace quadrille::pipeline {
namespace {

using models::Op;

constexpr std::size_t kMaxBlocks = 20000;
constexpr int kMaxNesting = 200;

bool is_phi(const spirv::Instruction& i) { return i.op == spv::OpPhi; }

}  // namespace

void Lowering::region(Id first, const Stop& stop) {
  if (++nesting_ > kMaxNesting)
    throw user_error("{}: control flow is nested deeper than {}", module_.shader, kMaxNesting);
  for (Id current = first; current != 0;) current = lower_block(current, stop);
  --nesting_;
}

Id Lowering::lower_block(Id label, const Stop& stop) {
  if (++work_ > kMaxBlocks) {
    roll_a_loop();
    throw user_error("{}: more than {} blocks of control flow", module_.shader, kMaxBlocks);
  }
  const spirv::Block& block = module_.block(label);
  const LoopFrame* loop = real_loop();
  if (block.merge_kind == spv::OpLoopMerge && (loop == nullptr || loop->header != label))
    return lower_loop(block, stop);
  begin_block(block);
  body(block);
  return terminator(block, stop);
}

void Lowering::begin_block(const spirv::Block& block) {
  for (const spirv::Instruction& i : block.body) {
    if (!is_phi(i)) break;
    check_size(i);
    value_types_[i.result] = i.type;
    Values values;
    if (const auto resolved = resolved_phis_.find(i.result); resolved != resolved_phis_.end()) {
      values = std::move(resolved->second);
      resolved_phis_.erase(resolved);
    } else {
      for (const Value variable : phis_[i.result]) values.push_back(build_.read(variable));
      if (values.empty()) values.assign(module_.type(i.type).scalars, literal(0u));  // no path leads here
    }
    define(i, std::move(values));
  }
}

void Lowering::body(const spirv::Block& block) {
  for (const spirv::Instruction& i : block.body) instruction(i);
}

void Lowering::copy_phis(Id from, Id to) {
  const bool unrolled = may_unroll(to);
  for (const spirv::Instruction& i : module_.block(to).body) {
    if (!is_phi(i)) break;
    for (std::size_t k = 0; k + 1 < i.operands.size(); k += 2) {
      if (i.operands[k + 1] != from) continue;
      const Values incoming = value(i.operands[k]);
      if (unrolled) {
        resolved_phis_[i.result] = incoming;
        continue;
      }
      Values& variables = phis_[i.result];
      while (variables.size() < incoming.size()) variables.push_back(build_.new_variable());
      for (std::size_t c = 0; c < incoming.size(); ++c) build_.assign(variables[c], incoming[c]);
    }
  }
}

Lowering::LoopFrame* Lowering::real_loop() {
  const auto found =
      std::find_if(loops_.rbegin(), loops_.rend(), [](const LoopFrame& frame) { return !frame.is_switch; });
  return found == loops_.rend() ? nullptr : &*found;
}
const Lowering::LoopFrame* Lowering::real_loop() const { return const_cast<Lowering*>(this)->real_loop(); }

/// Whether an edge to `to` leaves the construct being lowered other than by reaching its end.
bool Lowering::is_exit(Id to, const Stop& stop) const {
  if (to == stop.merge) return false;
  const LoopFrame* loop = real_loop();
  if (loop != nullptr && (to == loop->merge || to == loop->continue_target || to == loop->header))
    return true;
  if (open_switches_.contains(to)) return true;
  return std::any_of(loops_.begin(), loops_.end(),
                     [&](const LoopFrame& frame) { return frame.is_switch && frame.merge == to; });
}

/// Emits what an edge does; returns the block to go on with, or 0 where the edge leaves the region.
Id Lowering::edge(Id from, Id to, const Stop& stop) {
  copy_phis(from, to);
  return follow(to, stop);
}

Id Lowering::follow(Id to, const Stop& stop) {
  if (to == stop.merge) return 0;
  if (stop.falls_into != nullptr) {
    if (const auto next = stop.falls_into->find(to); next != stop.falls_into->end()) {
      build_.assign(next->second, literal(kTrue));
      return 0;
    }
  }
  if (!loops_.empty() && loops_.back().is_switch && loops_.back().merge == to) {
    build_.effect(Op::kBreakIf, literal(kTrue));
    return 0;
  }
  if (const auto found = open_switches_.find(to); found != open_switches_.end())
    throw StartAgain{&Attempts::looped_switches, found->second};
  if (const LoopFrame* loop = real_loop();
      loop != nullptr && (to == loop->merge || to == loop->continue_target || to == loop->header)) {
    if (loop->unrolled) {
      if (to != loop->merge || nesting_ != loop->nesting + 1)
        throw StartAgain{&Attempts::rolled_loops, loop->header};
      real_loop()->finished = true;
      return 0;
    }
    if (to == loop->merge) return leave(LoopFrame::kBreak), 0;
    return leave(LoopFrame::kContinue), 0;
  }
  return to;
}

/// Takes the lanes that execute out of the innermost loop of the source (or out of all, if they are killed).
void Lowering::leave(LoopFrame::Leave how) {
  for (const LoopFrame& frame : loops_)
    if (frame.unrolled) throw StartAgain{&Attempts::rolled_loops, frame.header};  // it has no LOOP to leave
  for (std::size_t k = loops_.size(); k-- > 0;) {
    LoopFrame& frame = loops_[k];
    const bool last = how == LoopFrame::kKill ? k == 0 : !frame.is_switch;
    if (last) break;
    Value& flag = frame.flags[how];
    if (flag.kind == Value::Kind::kNone) {
      flag = build_.new_variable();
      ScalarInstruction& clear = shader_.code[frame.reserved + how];
      clear.op = Op::kMov;
      clear.dst = flag.bits;
      clear.a = literal(0u);
    }
    build_.assign(flag, literal(kTrue));
  }
  build_.effect(how == LoopFrame::kContinue && !loops_.back().is_switch ? Op::kContinueIf : Op::kBreakIf,
                literal(kTrue));
}

void Lowering::push_loop(LoopFrame frame) {
  frame.reserved = shader_.code.size();
  for (int k = 0; k < LoopFrame::kLeaveCount; ++k) build_.effect(Op::kNop);
  loops_.push_back(frame);
  build_.effect(Op::kLoop);
  build_.open_scope();
}

void Lowering::pop_loop() {
  build_.close_scope();
  build_.effect(Op::kEndLoop);
  const LoopFrame frame = loops_.back();
  loops_.pop_back();
  for (int how = 0; how < LoopFrame::kLeaveCount; ++how) {
    if (frame.flags[how].kind == Value::Kind::kNone) continue;
    const bool resumes = how == LoopFrame::kContinue && !loops_.back().is_switch;
    build_.effect(resumes ? Op::kContinueIf : Op::kBreakIf, frame.flags[how]);
  }
}

/// Whether the lowering tries to write the loop out. Its phis must have one way in, whose values are then
/// simply those of the first iteration.
bool Lowering::may_unroll(Id header) const {
  const spirv::Block& block = module_.block(header);
  if (block.merge_kind != spv::OpLoopMerge || (block.loop_control & spv::LoopControlDontUnrollMask) != 0)
    return false;
  if (attempts_.rolled_loops.contains(header)) return false;
  return std::all_of(block.body.begin(), block.body.end(),
                     [](const spirv::Instruction& i) { return !is_phi(i) || i.operands.size() == 4; });
}

/// Iterations one after the other, as long as the way out is decided by literals. Starts again without
/// unrolling where that fails or gets long.
Id Lowering::lower_unrolled(const spirv::Block& header, const Stop& stop) {
  const bool asked = (header.loop_control & spv::LoopControlUnrollMask) != 0;
  const int most_iterations = asked ? 64 : 8;
  const std::size_t most_code = shader_.code.size() + (asked ? 6000 : 200), first_block = work_;
  LoopFrame frame;
  frame.unrolled = true;
  frame.nesting = nesting_;
  frame.header = header.label;
  frame.merge = header.merge;
  frame.continue_target = header.continue_target;
  loops_.push_back(frame);
  for (int iteration = 0; !loops_.back().finished; ++iteration) {
    if (iteration > most_iterations || shader_.code.size() > most_code)
      throw StartAgain{&Attempts::rolled_loops, header.label};
    region(header.label, {header.continue_target, nullptr});
    if (!loops_.back().finished && header.continue_target != header.label)
      region(header.continue_target, {header.label, nullptr});
  }
  loops_.pop_back();
  if (work_ - first_block > widest_unrolled_.first) widest_unrolled_ = {work_ - first_block, header.label};
  return follow(header.merge, stop);
}

/// Where a limit is passed: starts again with one loop less written out, if any was.
void Lowering::roll_a_loop() const {
  for (const LoopFrame& frame : loops_)
    if (frame.unrolled) throw StartAgain{&Attempts::rolled_loops, frame.header};
  if (widest_unrolled_.second != 0) throw StartAgain{&Attempts::rolled_loops, widest_unrolled_.second};
}

Id Lowering::lower_loop(const spirv::Block& header, const Stop& stop) {
  if (may_unroll(header.label)) return lower_unrolled(header, stop);
  LoopFrame frame;
  frame.header = header.label;
  frame.merge = header.merge;
  frame.continue_target = header.continue_target;
  push_loop(frame);
  region(header.label, {header.continue_target, nullptr});
  if (header.continue_target != header.label) {
    build_.close_scope();
    build_.effect(Op::kContinuing);
    build_.open_scope();
    region(header.continue_target, {header.label, nullptr});
  }
  leave_if_killed();
  pop_loop();
  return follow(header.merge, stop);
}

Id Lowering::terminator(const spirv::Block& block, const Stop& stop) {
  const spirv::Instruction& last = block.terminator;
  switch (static_cast<std::uint32_t>(last.op)) {
    case spv::OpBranch: return edge(block.label, last.operands[0], stop);
    case spv::OpBranchConditional: return conditional(block, stop);
    case spv::OpSwitch: return lower_switch(block, stop);
    case spv::OpKill:
    case spv::OpTerminateInvocation: kill(); return 0;
    case spv::OpUnreachable: return 0;
    case spv::OpReturn:
      if (stop.merge == 0 && loops_.empty()) return 0;
      break;
    default: break;
  }
  throw unsupported(last, "this end of a block (an early return that is left after optimisation)");
}

void Lowering::kill() {
  build_.effect(Op::kKillIf, literal(kTrue));
  if (!loops_.empty()) leave(LoopFrame::kKill);
}

/// At the end of an iteration, where a discard has returned to a loop that only a lane's own values would
/// end.
void Lowering::leave_if_killed() {
  if (!module_.kills_return) return;
  build_.effect(Op::kIf, build_.read(killed_));
  build_.open_scope();
  leave(LoopFrame::kKill);
  build_.close_scope();
  build_.effect(Op::kEndIf);
}

/// Whether `to` is a block that only leaves the innermost loop; `from` is then the block whose edge counts.
bool Lowering::breaks_directly(Id to, Id& from) const {
  if (loops_.empty()) return false;
  if (to == loops_.back().merge) return true;
  const auto found = module_.blocks.find(to);
  if (found == module_.blocks.end()) return false;
  const spirv::Block& block = found->second;
  if (!block.body.empty() || block.merge_kind != spv::OpNop || block.terminator.op != spv::OpBranch)
    return false;
  if (block.terminator.operands[0] != loops_.back().merge) return false;
  from = to;
  return true;
}

/// The phi copies run for all lanes: a lane that stays writes them again on its own way to the same block.
void Lowering::conditional_exit(Value condition, Id from, Id to, const Stop& stop) {
  Id source = from;
  if (breaks_directly(to, source)) {
    // there is no LOOP to break
    if (loops_.back().unrolled) throw StartAgain{&Attempts::rolled_loops, loops_.back().header};
    copy_phis(source, loops_.back().merge);
    build_.effect(Op::kBreakIf, condition);
    return;
  }
  build_.effect(Op::kIf, condition);
  build_.open_scope();
  side(from, to, {0, stop.falls_into});
  build_.close_scope();
  build_.effect(Op::kEndIf);
}

void Lowering::side(Id from, Id to, const Stop& stop) {
  if (const Id next = edge(from, to, stop); next != 0) region(next, stop);
}

Id Lowering::conditional(const spirv::Block& block, const Stop& stop) {
  const Value condition = scalar(block.terminator.operands[0]);
  const Id yes = block.terminator.operands[1], no = block.terminator.operands[2];
  if (yes == no) return edge(block.label, yes, stop);
  if (condition.is_literal()) {
    const Id taken = condition.bits != 0 ? yes : no;
    if (block.merge_kind != spv::OpSelectionMerge) return edge(block.label, taken, stop);
    side(block.label, taken, {block.merge, nullptr});
    // the side left the loop that is written out
    if (const LoopFrame* loop = real_loop(); loop != nullptr && loop->finished) return 0;
    return follow(block.merge, stop);
  }
  if (const LoopFrame* loop = real_loop();
      loop != nullptr && loop->unrolled && (is_exit(yes, stop) || is_exit(no, stop)))
    throw StartAgain{&Attempts::rolled_loops, loop->header};
  if (block.merge_kind == spv::OpSelectionMerge) {
    if (Id from = block.label; yes != block.merge && breaks_directly(yes, from)) {
      conditional_exit(condition, block.label, yes, stop);
      side(block.label, no, {block.merge, nullptr});
      return follow(block.merge, stop);
    }
    return selection(block, condition, yes, no, block.merge, stop);
  }
  if (is_exit(yes, stop)) {
    conditional_exit(condition, block.label, yes, stop);
    return edge(block.label, no, stop);
  }
  if (is_exit(no, stop)) {
    conditional_exit(build_.invert(condition), block.label, no, stop);
    return edge(block.label, yes, stop);
  }
  if (yes != stop.merge && no != stop.merge)
    throw unsupported(block.terminator, "a branch without a merge block");
  build_.effect(Op::kIf, condition);
  build_.open_scope();
  side(block.label, yes, stop);
  build_.close_scope();
  build_.effect(Op::kElse);
  build_.open_scope();
  side(block.label, no, stop);
  build_.close_scope();
  build_.effect(Op::kEndIf);
  return 0;
}

}  // namespace quadrille::pipeline
