/// Finds the runs of a program, where its jumps lead, and where results of requests must have arrived.
#include "models/shader/decode.h"
#include "models/shader/op_table.h"

#include <array>
#include <bitset>
#include <vector>

namespace quadrille::models {
namespace {

/// kKillIf changes no mask that execution depends on, so it is an instruction like others here.
bool changes_flow(Op op) { return issue_class(op) == IssueClass::kControl && op != Op::kKillIf; }

bool is_request(Op op) {
  return issue_class(op) == IssueClass::kTex || issue_class(op) == IssueClass::kStorage;
}

/// Registers that outstanding requests will write.
class Outstanding {
 public:
  /// Must the instruction wait for the requests before it?
  [[nodiscard]] bool conflicts(const Instruction& in) const {
    if (count_ == 0) return false;
    const OpInfo& info = op_info(in.op);
    if (changes_flow(in.op) || (is_request(in.op) && count_ == kMaxClauseRequests)) return true;
    const std::array<const Operand*, 3> operands{&in.a, &in.b, &in.c};
    for (unsigned i = 0; i < info.sources; ++i)
      if (operands[i]->kind == Operand::kRegister && reads_any(operands[i]->index, operand_width(in.op)))
        return true;
    for (unsigned i = 0; i < info.destinations; ++i)
      if (registers_[in.dst + i]) return true;
    return false;
  }
  void clear() {
    registers_.reset();
    count_ = 0;
  }
  void add(const Instruction& in) {
    if (!is_request(in.op)) return;
    for (unsigned i = 0; i < op_info(in.op).destinations; ++i) registers_.set(in.dst + i);
    ++count_;
  }

 private:
  [[nodiscard]] bool reads_any(std::size_t first, int count) const {
    for (std::size_t r = first; r < first + static_cast<std::size_t>(count); ++r)
      if (registers_[r]) return true;
    return false;
  }

  std::bitset<kMaxRegisters> registers_;
  int count_ = 0;
};

void mark_stops(const Program& program, std::vector<Flow>& flow) {
  Outstanding outstanding;
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    const Instruction& in = program.code[i];
    flow[i].control = changes_flow(in.op);
    flow[i].waits = outstanding.conflicts(in);
    flow[i].stops = flow[i].control || flow[i].waits;
    if (flow[i].waits) outstanding.clear();
    outstanding.add(in);
  }
}

void mark_runs(std::vector<Flow>& flow) {
  for (std::size_t i = flow.size() - 1; i-- > 0;)
    flow[i].run_end = flow[i + 1].stops ? static_cast<std::uint32_t>(i + 1) : flow[i + 1].run_end;
}

/// A part of a construct (a side of an IF, a loop's body or its continue block) and the instructions that
/// jump to its end when no lane is left.
struct OpenPart {
  bool loop = false;
  std::uint8_t frame = 0;
  std::vector<std::size_t> jumps;
};

void close(OpenPart& part, std::size_t end, std::vector<Flow>& flow) {
  for (const std::size_t jump : part.jumps) flow[jump].target = static_cast<std::uint32_t>(end);
  part.jumps.clear();
}

void mark_targets(const Program& program, std::vector<Flow>& flow) {
  std::vector<OpenPart> open;
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    const Op op = program.code[i].op;
    if (op == Op::kElse || op == Op::kContinuing) close(open.back(), i, flow);
    if (op == Op::kEndIf || op == Op::kEndLoop) {
      close(open.back(), i, flow);
      open.pop_back();
    }
    if (op == Op::kIf || op == Op::kLoop)
      open.push_back({op == Op::kLoop, static_cast<std::uint8_t>(open.size()), {}});
    if (op == Op::kContinueIf)
      for (const OpenPart& part : open)
        if (part.loop) flow[i].loop_frame = part.frame;
    if (flow[i].control && !open.empty()) open.back().jumps.push_back(i);
  }
}

}  // namespace

std::vector<Flow> analyse_flow(const Program& program) {
  std::vector<Flow> flow(program.code.size());
  mark_stops(program, flow);
  mark_runs(flow);
  mark_targets(program, flow);
  return flow;
}

}  // namespace quadrille::models
