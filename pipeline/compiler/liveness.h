/// Which virtual registers hold a value that is still needed: the flow of control as basic blocks, and what
/// is live where they begin and end.
#pragma once

#include "pipeline/compiler/ir.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::pipeline {

/// A set of registers that is walked, grown and shrunk in constant time a step.
class RegisterSet {
 public:
  explicit RegisterSet(std::size_t registers) : place_(registers, kAbsent) {}
  void insert(std::uint32_t r);
  void erase(std::uint32_t r);
  void clear();
  [[nodiscard]] bool contains(std::uint32_t r) const { return place_[r] != kAbsent; }
  [[nodiscard]] const std::vector<std::uint32_t>& items() const { return items_; }

 private:
  static constexpr std::uint32_t kAbsent = 0xffffffffu;
  std::vector<std::uint32_t> place_, items_;
};

struct BasicBlock {
  std::size_t first = 0, last = 0;  ///< instructions [first, last)
  std::vector<std::size_t> next;
  std::vector<std::uint64_t> live_in, live_out;  ///< a bit a register
};

class Liveness {
 public:
  Liveness(const std::vector<ScalarInstruction>& code, std::size_t registers);
  [[nodiscard]] const std::vector<BasicBlock>& blocks() const { return blocks_; }
  /// `live` becomes what is live behind the block.
  void live_behind(const BasicBlock& block, RegisterSet& live) const;
  /// Goes back over an instruction: from what is live behind it to what is live before it.
  void step_back(std::size_t at, RegisterSet& live) const;
  /// Registers that the instruction reads. The results of a texture instruction that nobody reads count as
  /// read where the first of them is, because all are written late.
  template <class Visit>
  void for_each_use(std::size_t at, Visit visit) const {
    const auto width = static_cast<std::uint32_t>(models::operand_width(code_[at].op));
    for (const Value& v : {code_[at].a, code_[at].b, code_[at].c})
      for (std::uint32_t k = 0; v.is_register() && k < width; ++k) visit(v.bits + k);
    for (const std::uint32_t r : late_[at]) visit(r);
  }

 private:
  using Jumps = std::vector<std::vector<std::size_t>>;
  void find_late_results();
  [[nodiscard]] Jumps find_jumps() const;
  void build_blocks();
  void solve();

  const std::vector<ScalarInstruction>& code_;
  std::size_t registers_;
  std::vector<std::vector<std::uint32_t>> late_;
  std::vector<BasicBlock> blocks_;
};

/// Consecutive registers that the instruction writes.
[[nodiscard]] inline std::uint32_t result_count(const ScalarInstruction& i) {
  return static_cast<std::uint32_t>(models::destination_count(i.op));
}

}  // namespace quadrille::pipeline
