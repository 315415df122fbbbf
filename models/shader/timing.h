/// When the instructions of a warp issue: a dependent instruction waits for its operands.
///
/// Instructions of a warp issue in order. One holds the issue slot for `issue` cycles of its class; its
/// results can be read max(issue, latency) cycles after its first issue cycle. A branch waits for its
/// condition. Which instructions run is known from execution; so the times of each straight run are found
/// once a program (`ProgramTiming`), and a warp keeps when its registers are ready (`WarpClock`). Where a run
/// waits for a register from before it, it waits as a whole. That is late by a few cycles at most: for what
/// issues in the run before the first reader.
#pragma once

#include "models/shader/isa.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

inline constexpr std::size_t kIssueClasses = 8;

/// Cycles, by IssueClass.
struct IssueTiming {
  struct Class {
    std::uint32_t issue = 1, latency = 1;
    friend bool operator==(const Class&, const Class&) = default;
  };
  std::array<Class, kIssueClasses> classes;
  [[nodiscard]] const Class& of(Op op) const { return classes[static_cast<std::size_t>(issue_class(op))]; }
  /// First issue of an instruction to the first issue of one that reads its result.
  [[nodiscard]] static std::uint32_t distance(const Class& c) { return std::max(c.issue, c.latency); }
};

/// The straight runs of a program: each for a warp that has its SIMD to itself, in cycles from the run's
/// first issue.
class ProgramTiming {
 public:
  struct At {
    std::uint16_t reg = 0;
    std::uint32_t cycle = 0;
  };
  struct Run {
    /// into `needs()`: registers from before the run, by their first reader
    std::uint32_t needs = 0, needs_end = 0;
    /// into `writes()`: registers that it leaves, when they can be read
    std::uint32_t writes = 0, writes_end = 0;
    std::uint32_t work = 0;   ///< issue cycles
    std::uint32_t span = 0;   ///< to the end of the last issue
    std::uint32_t drain = 0;  ///< until all its results are there
  };
  /// The program has been prepared.
  ProgramTiming(const Program& program, const IssueTiming& timing);

  /// The run that begins at an instruction.
  [[nodiscard]] const Run& run(std::uint32_t begin) const { return runs_[run_of_[begin]]; }
  [[nodiscard]] const std::vector<At>& needs() const { return needs_; }
  [[nodiscard]] const std::vector<At>& writes() const { return writes_; }
  [[nodiscard]] std::uint32_t control_issue() const { return control_issue_; }
  /// From a branch to the first instruction after it.
  [[nodiscard]] std::uint32_t control_distance() const { return control_distance_; }

 private:
  void add_run(const Program& program, const IssueTiming& timing, std::uint32_t begin, std::uint32_t end);

  std::vector<std::uint32_t> run_of_;
  std::vector<Run> runs_;
  std::vector<At> needs_, writes_;
  std::uint32_t control_issue_, control_distance_;
};

/// A clause of a warp as its instructions go by: cycles from the clause's first issue, for a warp that has
/// its SIMD to itself.
class WarpClock {
 public:
  /// All registers are ready: a clause begins when the results of the one before it are there.
  void restart(const ProgramTiming& timing, int registers) {
    timing_ = &timing;
    ready_.assign(static_cast<std::size_t>(registers), 0);
    work_ = front_ = drain_ = 0;
  }
  void run(std::uint32_t begin) {
    const ProgramTiming::Run& run = timing_->run(begin);
    std::uint32_t start = front_;
    for (std::uint32_t i = run.needs; i < run.needs_end; ++i) {
      const ProgramTiming::At& need = timing_->needs()[i];
      if (ready_[need.reg] > start + need.cycle) start = ready_[need.reg] - need.cycle;
    }
    for (std::uint32_t i = run.writes; i < run.writes_end; ++i) {
      const ProgramTiming::At& write = timing_->writes()[i];
      ready_[write.reg] = start + write.cycle;
    }
    work_ += run.work;
    front_ = start + run.span;
    drain_ = std::max(drain_, start + run.drain);
  }
  void control(const Operand& condition) {
    if (condition.kind == Operand::kRegister) front_ = std::max(front_, ready_[condition.index]);
    work_ += timing_->control_issue();
    front_ += timing_->control_distance();
    drain_ = std::max(drain_, front_);
  }
  /// Issue cycles.
  [[nodiscard]] std::uint32_t work() const { return work_; }
  /// To the end of the last issue: `work` and the cycles in which the warp could not issue.
  [[nodiscard]] std::uint32_t span() const { return front_; }
  /// Until all results are there; at least the span.
  [[nodiscard]] std::uint32_t drain() const { return std::max(drain_, front_); }

 private:
  const ProgramTiming* timing_ = nullptr;
  std::vector<std::uint32_t> ready_;
  std::uint32_t work_ = 0, front_ = 0, drain_ = 0;
};

}  // namespace quadrille::models
