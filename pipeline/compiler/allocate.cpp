#include "pipeline/compiler/allocate.h"

#include "models/base/error.h"
#include "pipeline/compiler/passes.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <map>
#include <numeric>

namespace quadrille::pipeline {
namespace {

using models::Op;

// beyond the limit, so that an error can say by how much
constexpr std::size_t kColours = 4 * models::kMaxRegisters;

/// A set of registers that is walked, grown and shrunk in constant time a step.
class SparseSet {
 public:
  explicit SparseSet(std::size_t size) : place_(size, kAbsent) {}
  void insert(std::uint32_t r) {
    if (place_[r] != kAbsent) return;
    place_[r] = static_cast<std::uint32_t>(items_.size());
    items_.push_back(r);
  }
  void erase(std::uint32_t r) {
    if (place_[r] == kAbsent) return;
    const std::uint32_t last = items_.back();
    items_[place_[r]] = last;
    place_[last] = place_[r];
    place_[r] = kAbsent;
    items_.pop_back();
  }
  void clear() {
    for (const std::uint32_t r : items_) place_[r] = kAbsent;
    items_.clear();
  }
  [[nodiscard]] const std::vector<std::uint32_t>& items() const { return items_; }

 private:
  static constexpr std::uint32_t kAbsent = 0xffffffffu;
  std::vector<std::uint32_t> place_, items_;
};

using Bits = std::vector<std::uint64_t>;

struct BasicBlock {
  std::size_t first = 0, last = 0;  ///< instructions [first, last)
  std::vector<std::size_t> next;
  Bits live_in, live_out;
};

class Allocator {
 public:
  Allocator(const std::vector<ScalarInstruction>& code, std::size_t registers)
      : code_(code), registers_(registers), neighbours_(registers), parent_(registers), extra_(code.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  Allocation run() {
    find_late_results();
    build_blocks();
    solve_liveness();
    build_interference();
    coalesce();
    return colour();
  }

 private:
  static std::uint32_t results(const ScalarInstruction& i) {
    return static_cast<std::uint32_t>(models::destination_count(i.op));
  }

  template <class Visit>
  void for_each_use(std::size_t at, Visit visit) const {
    for (const Value& v : {code_[at].a, code_[at].b, code_[at].c})
      if (v.is_register()) visit(v.bits);
    for (const std::uint32_t r : extra_[at]) visit(r);
  }

  /// Marks all results of a texture instruction as read where the first of them is.
  void find_late_results() {
    std::vector<std::uint32_t> base(registers_, kNoRegister);
    for (const ScalarInstruction& i : code_)
      if (results(i) > 1)
        for (std::uint32_t k = 0; k < results(i); ++k) base[i.dst + k] = i.dst;
    std::vector<bool> seen(registers_, false);
    std::vector<std::uint32_t> count(registers_, 0);
    for (const ScalarInstruction& i : code_)
      if (results(i) > 1) count[i.dst] = results(i);
    for (std::size_t at = 0; at < code_.size(); ++at)
      for (const Value& v : {code_[at].a, code_[at].b, code_[at].c}) {
        if (!v.is_register() || base[v.bits] == kNoRegister || seen[base[v.bits]]) continue;
        const std::uint32_t first = base[v.bits];
        seen[first] = true;
        for (std::uint32_t k = 0; k < count[first]; ++k) extra_[at].push_back(first + k);
      }
  }

  /// Places of the flow of control: for each IF its ELSE or ENDIF, and so on.
  void build_blocks() {
    const std::size_t n = code_.size();
    std::vector<std::vector<std::size_t>> jumps(n);
    struct Open {
      std::size_t start = 0, middle = 0;
      std::vector<std::size_t> breaks, continues;
    };
    std::vector<Open> ifs, loops;
    for (std::size_t at = 0; at < n; ++at) {
      switch (static_cast<int>(code_[at].op)) {
        case static_cast<int>(Op::kIf): ifs.push_back({at, 0, {}, {}}); break;
        case static_cast<int>(Op::kElse): ifs.back().middle = at; break;
        case static_cast<int>(Op::kEndIf):
          jumps[ifs.back().start].push_back(ifs.back().middle != 0 ? ifs.back().middle + 1 : at);
          if (ifs.back().middle != 0) jumps[ifs.back().middle].push_back(at);
          ifs.pop_back();
          break;
        case static_cast<int>(Op::kLoop): loops.push_back({at, 0, {}, {}}); break;
        case static_cast<int>(Op::kBreakIf): loops.back().breaks.push_back(at); break;
        case static_cast<int>(Op::kContinueIf): loops.back().continues.push_back(at); break;
        case static_cast<int>(Op::kContinuing): loops.back().middle = at; break;
        case static_cast<int>(Op::kEndLoop):
          for (const std::size_t b : loops.back().breaks) jumps[b].push_back(at + 1);
          for (const std::size_t c : loops.back().continues)
            jumps[c].push_back(loops.back().middle != 0 ? loops.back().middle : at);
          jumps[at].push_back(loops.back().start + 1);
          loops.pop_back();
          break;
        default: break;
      }
    }
    std::vector<bool> leader(n + 1, false);
    leader[0] = true;
    for (std::size_t at = 0; at < n; ++at) {
      if (is_control(code_[at].op)) leader[at + 1] = true;
      for (const std::size_t to : jumps[at]) leader[to] = true;
    }
    std::vector<std::size_t> block_at(n + 1, 0);
    for (std::size_t at = 0; at < n; ++at) {
      if (leader[at]) blocks_.push_back({at, at, {}, {}, {}});
      blocks_.back().last = at + 1;
      block_at[at] = blocks_.size() - 1;
    }
    for (BasicBlock& block : blocks_) {
      const std::size_t end = block.last - 1;
      const Op op = code_[end].op;
      for (const std::size_t to : jumps[end])
        if (to < n) block.next.push_back(block_at[to]);
      if (op != Op::kElse && op != Op::kEndLoop && op != Op::kEnd && end + 1 < n)
        block.next.push_back(block_at[end + 1]);
    }
  }

  void solve_liveness() {
    const std::size_t words = (registers_ + 63) / 64;
    std::vector<Bits> used(blocks_.size()), defined(blocks_.size());
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      used[b].assign(words, 0);
      defined[b].assign(words, 0);
      blocks_[b].live_in.assign(words, 0);
      blocks_[b].live_out.assign(words, 0);
      for (std::size_t at = blocks_[b].first; at < blocks_[b].last; ++at) {
        for_each_use(at, [&](std::uint32_t r) {
          if ((defined[b][r / 64] >> (r % 64) & 1) == 0) used[b][r / 64] |= std::uint64_t{1} << (r % 64);
        });
        for (std::uint32_t k = 0; k < results(code_[at]); ++k) {
          const std::uint32_t r = code_[at].dst + k;
          defined[b][r / 64] |= std::uint64_t{1} << (r % 64);
        }
      }
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t b = blocks_.size(); b-- > 0;) {
        BasicBlock& block = blocks_[b];
        for (std::size_t w = 0; w < words; ++w) {
          std::uint64_t out = 0;
          for (const std::size_t s : block.next) out |= blocks_[s].live_in[w];
          const std::uint64_t in = used[b][w] | (out & ~defined[b][w]);
          block.live_out[w] = out;
          if (in == block.live_in[w]) continue;
          block.live_in[w] = in;
          changed = true;
        }
      }
    }
  }

  void connect(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }

  void build_interference() {
    SparseSet live(registers_);
    for (const BasicBlock& block : blocks_) {
      live.clear();
      for (std::size_t w = 0; w < block.live_out.size(); ++w)
        for (std::uint64_t bits = block.live_out[w]; bits != 0; bits &= bits - 1)
          live.insert(static_cast<std::uint32_t>(w * 64 + static_cast<std::size_t>(std::countr_zero(bits))));
      for (std::size_t at = block.last; at-- > block.first;) {
        const ScalarInstruction& i = code_[at];
        const bool copy = i.op == Op::kMov && i.flags == 0 && i.a.is_register() && i.a.modifiers == 0;
        for (std::uint32_t k = 0; k < results(i); ++k) {
          const std::uint32_t target = i.dst + k;
          for (const std::uint32_t other : live.items())
            if (!(copy && other == i.a.bits)) connect(target, other);
          for (std::uint32_t m = k + 1; m < results(i); ++m) connect(target, i.dst + m);
        }
        for (std::uint32_t k = 0; k < results(i); ++k) live.erase(i.dst + k);
        for_each_use(at, [&](std::uint32_t r) { live.insert(r); });
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
      if (results(i) > 1)
        for (std::uint32_t k = 0; k < results(i); ++k) group[i.dst + k] = i.dst;
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
      if (results(i) < 2) continue;
      std::vector<std::uint32_t> members;
      for (std::uint32_t k = 0; k < results(i); ++k) members.push_back(find(i.dst + k));
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
      for (std::uint32_t k = 0; k < results(i); ++k) visit(i.dst + k);
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
  std::vector<std::vector<std::uint32_t>> extra_;
  std::vector<BasicBlock> blocks_;
  std::size_t most_live_ = 0;
};

}  // namespace

Allocation allocate_registers(const std::vector<ScalarInstruction>& code, std::size_t registers) {
  return Allocator(code, registers).run();
}

}  // namespace quadrille::pipeline
