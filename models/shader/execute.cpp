/// Executes a warp: runs of straight-line instructions, and between them the mask stack of structured control
/// flow.
#include "models/base/error.h"
#include "models/shader/decode.h"
#include "models/shader/lanes.h"
#include "models/shader/op_table.h"
#include "models/shader/timing.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace quadrille::models {
namespace {

class Execution {
 public:
  Execution(Warp& warp, WarpClock* clock) : warp_(warp), program_(*warp.code), clock_(clock) {
    context_.regs = reinterpret_cast<std::byte*>(warp.regs.data());
    context_.constants = warp.constants;
    context_.warp = &warp;
    const FragmentInputs* in = warp.fragment;
    context_.one_triangle =
        in != nullptr && std::all_of(in->varyings.begin(), in->varyings.end(),
                                     [&](const float* v) { return v == in->varyings[0]; });
    mask_changed();
  }

  ClauseResult run() {
    ClauseResult result;
    for (;;) {
      const Flow& flow = program_.flow[warp_.pc];
      if (flow.waits && warp_.requests() > 0) {
        result.end = ClauseEnd::kRequests;
        return result;
      }
      if (flow.control) {
        result.cost.control += 1;
        result.cost.lane_ops += static_cast<std::uint64_t>(std::popcount(warp_.exec));
        if (clock_ != nullptr) clock_->control(warp_.program->code[warp_.pc].a);
        if (program_.code[warp_.pc].op == Op::kEnd) return result;
        step_control(flow);
        mask_changed();
      } else {
        if (clock_ != nullptr) clock_->run(warp_.pc);
        run_straight(flow.run_end, result.cost);
      }
    }
  }

 private:
  void mask_changed() {
    for (int g = 0; g < kWarpGroups; ++g)
      store(context_.exec_lanes.data() + g * kGroupLanes, expand_mask(warp_.exec, g));
  }

  void run_straight(std::uint32_t end, ClauseCost& cost) {
    const std::uint32_t begin = std::exchange(warp_.pc, end);
    program_.execute_run(program_, begin, end, warp_.exec == warp_.launched, context_);
    warp_.instructions += end - begin;
    charge(begin, end, cost);
  }

  void charge(std::uint32_t begin, std::uint32_t end, ClauseCost& cost) const {
    const IssueCounts& before = program_.counts[begin];
    const IssueCounts& after = program_.counts[end];
    cost.alu += after.alu - before.alu;
    cost.sfu += after.sfu - before.sfu;
    cost.interp += after.interp - before.interp;
    cost.constant += after.constant - before.constant;
    cost.control += after.control - before.control;
    cost.exported += after.exported - before.exported;
    cost.lane_ops +=
        static_cast<std::uint64_t>(end - begin) * static_cast<std::uint64_t>(std::popcount(warp_.exec));
  }

  /// Executing lanes whose condition (operand a) is not zero.
  [[nodiscard]] LaneMask condition() const {
    const DecodedOperand& a = program_.code[warp_.pc].a;
    if (warp_.program->code[warp_.pc].a.kind == Operand::kConstant)
      return context_.constants[a.offset] != 0 ? warp_.exec : 0;
    LaneMask met = 0;
    for (int g = 0; g < kWarpGroups; ++g)
      met |= nonzero_bits(load_words(context_.regs + a.offset + g * 32)) << (g * kGroupLanes);
    return met & warp_.exec;
  }

  Warp::Frame& top() { return warp_.frames[static_cast<std::size_t>(warp_.control_depth - 1)]; }
  Warp::Frame& push(LaneMask outer) {
    Warp::Frame& frame = warp_.frames[static_cast<std::size_t>(warp_.control_depth++)];
    frame = {outer, 0, warp_.pc + 1};
    return frame;
  }

  /// Updates the masks and the place; when no lane is left, goes where lanes may come back.
  void step_control(const Flow& flow) {
    const Op op = program_.code[warp_.pc].op;
    std::uint32_t next = warp_.pc + 1;
    if (op == Op::kIf) {
      const LaneMask taken = condition();
      push(warp_.exec).other = warp_.exec & ~taken;
      warp_.exec = taken;
    } else if (op == Op::kElse) {
      std::swap(warp_.exec, top().other);
    } else if (op == Op::kEndIf) {
      warp_.exec |= top().other;
      --warp_.control_depth;
    } else if (op == Op::kLoop) {
      push(warp_.exec);
    } else if (op == Op::kBreakIf) {
      warp_.exec &= ~condition();
    } else if (op == Op::kContinueIf) {
      const LaneMask leaving = condition();
      warp_.frames[flow.loop_frame].other |= leaving;
      warp_.exec &= ~leaving;
    } else if (op == Op::kContinuing) {
      warp_.exec |= std::exchange(top().other, 0u);
    } else if (op == Op::kEndLoop) {
      next = end_loop(next);
    }
    warp_.pc = warp_.exec != 0 ? next : flow.target;
  }

  std::uint32_t end_loop(std::uint32_t after) {
    warp_.exec |= std::exchange(top().other, 0u);
    if (warp_.exec == 0) {
      warp_.exec = top().outer;
      --warp_.control_depth;
      return after;
    }
    if (++warp_.back_edges > kMaxBackEdges || warp_.instructions > kMaxLoopInstructions) {
      throw user_error(
          "shader '{}', instruction {}: a loop ran {} iterations and {} instructions without an end; does "
          "its condition ever become false?",
          warp_.program->name, warp_.pc, warp_.back_edges - 1, warp_.instructions);
    }
    return top().start;
  }

  Warp& warp_;
  const DecodedProgram& program_;
  WarpClock* const clock_;
  ExecutionContext context_;
};

void check_interface(const Warp& warp) {
  const bool vertex = warp.program->stage == ShaderStage::kVertex;
  const bool has_inputs = vertex ? warp.vertex != nullptr : warp.fragment != nullptr;
  QUADRILLE_CHECK(has_inputs && warp.outputs != nullptr, "warp of '{}' runs without inputs or outputs",
                  warp.program->name);
}

ClauseResult run(Warp& warp, WarpClock* clock) {
  warp.instructions += kRequestInstructions * static_cast<std::uint64_t>(warp.requests());
  warp.texture_count = 0;
  warp.access_count = 0;
  if (warp.launched == 0) return {};
  check_interface(warp);
  return Execution(warp, clock).run();
}

}  // namespace

void interpret_run(const DecodedProgram& program, std::uint32_t begin, std::uint32_t end, bool all_lanes,
                   ExecutionContext& context) {
  const DecodedInstruction* const last = program.code.data() + end;
  if (all_lanes)
    for (const DecodedInstruction* d = program.code.data() + begin; d != last; ++d) d->all_lanes(*d, context);
  else
    for (const DecodedInstruction* d = program.code.data() + begin; d != last; ++d)
      d->some_lanes(*d, context);
}

ClauseResult run_clause(Warp& warp) { return run(warp, nullptr); }
ClauseResult run_clause(Warp& warp, WarpClock& clock) { return run(warp, &clock); }

}  // namespace quadrille::models
