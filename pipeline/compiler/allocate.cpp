#include "pipeline/compiler/allocate.h"

#include "models/base/error.h"
#include "pipeline/compiler/liveness.h"

#include <algorithm>
#include <bitset>
#include <map>
#include <numeric>

namespace quadrille::pipeline {
namespace {

using models::Op;

// beyond the limit, so that an error can say by how much
constexpr std::size_t kColours = 4 * models::kMaxRegisters;

class Allocator {
 public:
  Allocator(const std::vector<ScalarInstruction>& code, std::size_t registers)
      : code_(code), registers_(registers), neighbours_(registers), parent_(registers) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  Allocation run() {
    build_interference();
    coalesce();
    return colour();
  }

 private:
  void connect(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }

  void build_interference() {
    const Liveness liveness(code_, registers_);
    RegisterSet live(registers_);
    for (const BasicBlock& block : liveness.blocks()) {
      liveness.live_behind(block, live);
      for (std::size_t at = block.last; at-- > block.first;) {
        const ScalarInstruction& i = code_[at];
        const bool copy = i.op == Op::kMov && i.flags == 0 && i.a.is_register() && i.a.modifiers == 0;
        for (std::uint32_t k = 0; k < result_count(i); ++k) {
          const std::uint32_t target = i.dst + k;
          for (const std::uint32_t other : live.items())
            if (!(copy && other == i.a.bits)) connect(target, other);
          for (std::uint32_t m = k + 1; m < result_count(i); ++m) connect(target, i.dst + m);
        }
        liveness.step_back(at, live);
        most_live_ = std::max(most_live_, live.items().size());
      }
      if (most_live_ > kColours) break;
    }
    for (auto& list : neighbours_) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }

  std::uint32_t find(std::uint32_t r) {
    while (parent_[r] != r) r = parent_[r] = parent_[parent_[r]];
    return r;
  }

  /// Joins the two sides of copies that do not conflict. Neighbours stay lists of registers; a class owns
  /// those of its members.
  void coalesce() {
    std::vector<std::uint32_t> group(registers_, kNoRegister);
    for (const ScalarInstruction& i : code_)
      if (result_count(i) > 1)
        for (std::uint32_t k = 0; k < result_count(i); ++k) group[i.dst + k] = i.dst;
    for (const ScalarInstruction& i : code_) {
      if (i.op != Op::kMov || i.flags != 0 || !i.a.is_register() || i.a.modifiers != 0) continue;
      std::uint32_t a = find(i.dst), b = find(i.a.bits);
      if (a == b || (group[a] != kNoRegister && group[b] != kNoRegister)) continue;
      if (neighbours_[a].size() > neighbours_[b].size()) std::swap(a, b);
      if (std::any_of(neighbours_[a].begin(), neighbours_[a].end(),
                      [&](std::uint32_t r) { return find(r) == b; }))
        continue;
      parent_[a] = b;
      if (group[b] == kNoRegister) group[b] = group[a];
      neighbours_[b].insert(neighbours_[b].end(), neighbours_[a].begin(), neighbours_[a].end());
      neighbours_[a].clear();
    }
  }

  /// Colours classes in order of their first appearance, each with the lowest colours that are free.
  Allocation colour() {
    std::vector<int> colours(registers_, -1);
    const auto taken = [&](std::uint32_t root) {
      std::bitset<kColours + 4> used;
      for (const std::uint32_t r : neighbours_[root])
        if (const int c = colours[find(r)]; c >= 0) used.set(static_cast<std::size_t>(c));
      return used;
    };
    // class -> the classes of its texture's results
    std::map<std::uint32_t, std::vector<std::uint32_t>> wide;
    for (const ScalarInstruction& i : code_) {
      if (result_count(i) < 2) continue;
      std::vector<std::uint32_t> members;
      for (std::uint32_t k = 0; k < result_count(i); ++k) members.push_back(find(i.dst + k));
      for (const std::uint32_t member : members) wide[member] = members;
    }
    Allocation allocation;
    allocation.physical.assign(registers_, 0);
    const auto visit = [&](std::uint32_t r) {
      const std::uint32_t root = find(r);
      if (colours[root] >= 0) return;
      const auto found = wide.find(root);
      const std::vector<std::uint32_t> members =
          found == wide.end() ? std::vector<std::uint32_t>{root} : found->second;
      std::vector<std::bitset<kColours + 4>> used;
      used.reserve(members.size());
      for (const std::uint32_t member : members) used.push_back(taken(member));
      int base = 0;
      const auto fits = [&] {
        for (std::size_t k = 0; k < members.size(); ++k)
          if (used[k].test(static_cast<std::size_t>(base) + k)) return false;
        return true;
      };
      while (base < static_cast<int>(kColours) - 4 && !fits()) ++base;
      for (std::size_t k = 0; k < members.size(); ++k) colours[members[k]] = base + static_cast<int>(k);
      allocation.num_regs = std::max(allocation.num_regs, base + static_cast<int>(members.size()));
    };
    if (most_live_ > models::kMaxRegisters) {
      allocation.num_regs = static_cast<int>(most_live_);
      return allocation;
    }
    for (const ScalarInstruction& i : code_)
      for (std::uint32_t k = 0; k < result_count(i); ++k) visit(i.dst + k);
    for (const ScalarInstruction& i : code_)
      for (const Value& v : {i.a, i.b, i.c})
        if (v.is_register()) visit(v.bits);
    for (std::uint32_t r = 0; r < registers_; ++r)
      allocation.physical[r] = static_cast<std::uint16_t>(std::max(0, colours[find(r)]));
    return allocation;
  }

  const std::vector<ScalarInstruction>& code_;
  std::size_t registers_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<std::uint32_t> parent_;
  std::size_t most_live_ = 0;
};

}  // namespace

Allocation allocate_registers(const std::vector<ScalarInstruction>& code, std::size_t registers) {
  return Allocator(code, registers).run();
}

}  // namespace quadrille::pipeline
