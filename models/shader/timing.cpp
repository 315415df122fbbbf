#include "models/shader/timing.h"

#include "models/shader/decode.h"

namespace quadrille::models {

ProgramTiming::ProgramTiming(const Program& program, const IssueTiming& timing)
    : run_of_(program.code.size(), 0) {
  const IssueTiming::Class& control = timing.classes[static_cast<std::size_t>(IssueClass::kControl)];
  control_issue_ = control.issue;
  control_distance_ = IssueTiming::distance(control);
  const std::vector<Flow>& flow = program.decoded.get()->flow;
  for (std::uint32_t i = 0; i < flow.size(); ++i) {
    const bool begins = i == 0 || flow[i - 1].control || flow[i].waits;
    if (begins && !flow[i].control) add_run(program, timing, i, flow[i].run_end);
  }
}

void ProgramTiming::add_run(const Program& program, const IssueTiming& timing, std::uint32_t begin,
                            std::uint32_t end) {
  constexpr std::int64_t kBefore = -1;
  std::array<std::int64_t, kMaxRegisters> ready;
  ready.fill(kBefore);
  std::array<bool, kMaxRegisters> needed{};
  Run run;
  run.needs = static_cast<std::uint32_t>(needs_.size());
  std::int64_t now = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Instruction& in = program.code[i];
    const IssueTiming::Class& time = timing.of(in.op);
    const std::array<const Operand*, 3> operands{&in.a, &in.b, &in.c};
    const auto sources = static_cast<std::size_t>(source_count(in.op));
    for (std::size_t s = 0; s < sources; ++s)
      if (operands[s]->kind == Operand::kRegister) now = std::max(now, ready[operands[s]->index]);
    for (std::size_t s = 0; s < sources; ++s) {
      if (operands[s]->kind != Operand::kRegister || ready[operands[s]->index] != kBefore ||
          needed[operands[s]->index])
        continue;
      needed[operands[s]->index] = true;
      needs_.push_back({operands[s]->index, static_cast<std::uint32_t>(now)});
    }
    const std::int64_t done = now + IssueTiming::distance(time);
    for (int d = 0; d < destination_count(in.op); ++d) ready[static_cast<std::size_t>(in.dst + d)] = done;
    now += time.issue;
    run.work += time.issue;
    run.drain = std::max(run.drain, static_cast<std::uint32_t>(done));
  }
  run.span = static_cast<std::uint32_t>(now);
  run.needs_end = static_cast<std::uint32_t>(needs_.size());
  run.writes = static_cast<std::uint32_t>(writes_.size());
  for (std::uint16_t reg = 0; reg < kMaxRegisters; ++reg)
    if (ready[reg] != kBefore) writes_.push_back({reg, static_cast<std::uint32_t>(ready[reg])});
  run.writes_end = static_cast<std::uint32_t>(writes_.size());
  run_of_[begin] = static_cast<std::uint32_t>(runs_.size());
  runs_.push_back(run);
}

}  // namespace quadrille::models
