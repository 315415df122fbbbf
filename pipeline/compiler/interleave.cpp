#include "pipeline/compiler/interleave.h"

#include "pipeline/compiler/dependences.h"
#include "pipeline/compiler/passes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>

namespace quadrille::pipeline {
namespace {

using models::IssueTiming;
using models::Op;
using Cycle = std::int64_t;

/// Instructions that could go next and are looked at. A bound on the host's work; real programs stay below.
constexpr int kWindow = 64;

/// A straight-line piece, as nodes: an instruction, or requests that stay together.
class Piece {
 public:
  /// `behind`: registers that later code reads.
  Piece(std::span<const ScalarInstruction> code, const std::vector<bool>& variable, const IssueTiming& timing,
        const RegisterSet& behind)
      : code_(code), timing_(timing) {
    for (std::size_t at = 0; at < code.size(); ++at) {
      const bool joins = at > 0 && is_request(code[at].op) && is_request(code[at - 1].op);
      if (joins) ++nodes_.back().last;
      else nodes_.push_back({at, at + 1, 0, {}, {}, 0});
      node_of_.push_back(nodes_.size() - 1);
    }
    for (const Node& node : nodes_) {
      for_each_read(node, [&](std::uint32_t r) { ++values_[r].reads_left; });
      for_each_write(node, [&](std::uint32_t r) { values_[r]; });
    }
    for (auto& [r, value] : values_) value.needed_behind = behind.contains(r);
    link(dependences(code, variable));
    measure_chains();
  }

  /// `before`: registers that hold values where the piece begins.
  void append(const RegisterSet& before, Preference preference, std::size_t limit,
              std::vector<ScalarInstruction>& out) {
    live_ = before.items().size();
    for (auto& [r, value] : values_) value.held = before.contains(r);
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (nodes_[n].needs == 0) ready_.insert(n);
    while (!ready_.empty()) issue(choose(preference, limit), out);
  }

 private:
  struct Node {
    std::size_t first = 0, last = 0;  ///< instructions [first, last)
    std::size_t needs = 0;            ///< nodes that must come before and have not
    std::vector<std::size_t> before, after;
    Cycle chain = 0;  ///< from its first issue to the end of what depends on it
  };
  /// A register, as far as the piece has been issued.
  struct Held {
    int reads_left = 0;
    bool held = false, needed_behind = false;
    Cycle ready = 0;
  };

  template <class Visit>
  void for_each_read(const Node& node, Visit visit) const {
    for (std::size_t at = node.first; at < node.last; ++at)
      for (const Value& v : {code_[at].a, code_[at].b, code_[at].c})
        if (v.is_register()) visit(v.bits);
  }
  template <class Visit>
  void for_each_write(const Node& node, Visit visit) const {
    for (std::size_t at = node.first; at < node.last; ++at)
      for (std::uint32_t k = 0; k < result_count(code_[at]); ++k) visit(code_[at].dst + k);
  }

  void link(const std::vector<std::vector<std::size_t>>& needs) {
    for (std::size_t at = 0; at < needs.size(); ++at) {
      Node& node = nodes_[node_of_[at]];
      for (const std::size_t before : needs[at])
        if (node_of_[before] != node_of_[at]) node.before.push_back(node_of_[before]);
    }
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      std::vector<std::size_t>& before = nodes_[n].before;
      std::ranges::sort(before);
      before.erase(std::unique(before.begin(), before.end()), before.end());
      nodes_[n].needs = before.size();
      for (const std::size_t b : before) nodes_[b].after.push_back(n);
    }
  }

  [[nodiscard]] Cycle issue_time(const Node& node) const {
    return static_cast<Cycle>(node.last - node.first) * timing_.of(code_[node.first].op).issue;
  }
  [[nodiscard]] Cycle distance(const Node& node) const {
    const IssueTiming::Class& time = timing_.of(code_[node.first].op);
    return std::max<Cycle>(issue_time(node), IssueTiming::distance(time));
  }

  void measure_chains() {
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      nodes_[n].chain = std::max(nodes_[n].chain, distance(nodes_[n]));
      for (const std::size_t b : nodes_[n].before)
        nodes_[b].chain = std::max(nodes_[b].chain, distance(nodes_[b]) + nodes_[n].chain);
    }
  }

  [[nodiscard]] Cycle start(const Node& node) const {
    Cycle at = now_;
    for_each_read(node, [&](std::uint32_t r) { at = std::max(at, values_.at(r).ready); });
    return at;
  }

  /// Registers that hold values behind the node, if it went next.
  [[nodiscard]] std::size_t live_after(const Node& node) {
    std::size_t live = live_;
    for_each_read(node, [&](std::uint32_t r) {
      Held& value = values_[r];
      if (--value.reads_left == 0 && !value.needed_behind) --live;
    });
    for_each_read(node, [&](std::uint32_t r) { ++values_[r].reads_left; });
    for_each_write(node, [&](std::uint32_t r) {
      const Held& value = values_[r];
      if (!value.held && (value.reads_left > 0 || value.needed_behind)) ++live;
    });
    return live;
  }

  /// The first in the given order, unless another that leaves at most `limit` values can issue sooner, or
  /// makes room where the first has none.
  [[nodiscard]] std::size_t choose(Preference preference, std::size_t limit) {
    std::size_t best = *ready_.begin();
    Cycle best_start = start(nodes_[best]);
    bool fits = live_after(nodes_[best]) <= limit;
    int looked_at = 0;
    for (const std::size_t n : ready_) {
      if (++looked_at > kWindow) break;
      const std::size_t live = live_after(nodes_[n]);
      if (n == *ready_.begin() || live > limit) continue;
      const Cycle at = start(nodes_[n]);
      const bool sooner = at < best_start || (at == best_start && preference == Preference::kLongestChain &&
                                              nodes_[n].chain > nodes_[best].chain);
      if (!sooner && (fits || live >= live_)) continue;
      best = n;
      best_start = at;
      fits = true;
    }
    return best;
  }

  void issue(std::size_t n, std::vector<ScalarInstruction>& out) {
    const Node& node = nodes_[n];
    const Cycle at = start(node);
    live_ = live_after(node);
    for_each_read(node, [&](std::uint32_t r) { --values_[r].reads_left; });
    for_each_write(node, [&](std::uint32_t r) {
      values_[r].held = true;
      values_[r].ready = at + distance(node);
    });
    now_ = at + issue_time(node);
    for (std::size_t i = node.first; i < node.last; ++i) out.push_back(code_[i]);
    ready_.erase(n);
    for (const std::size_t after : node.after)
      if (--nodes_[after].needs == 0) ready_.insert(after);
  }

  std::span<const ScalarInstruction> code_;
  const IssueTiming& timing_;
  std::size_t live_ = 0;  ///< registers that hold values
  std::vector<Node> nodes_;
  std::vector<std::size_t> node_of_;
  std::unordered_map<std::uint32_t, Held> values_;
  std::set<std::size_t> ready_;  ///< nodes that could go next, in the given order
  Cycle now_ = 0;
};

/// Whether the instruction reads a value that has been asked for since `pending` was empty.
bool waits(const ScalarInstruction& i, const std::vector<std::uint32_t>& pending) {
  return std::ranges::any_of(std::array{i.a, i.b, i.c}, [&](const Value& v) {
    return v.is_register() && std::ranges::find(pending, v.bits) != pending.end();
  });
}

void note_request(const ScalarInstruction& i, std::vector<std::uint32_t>& pending) {
  if (!is_request(i.op)) return;
  for (std::uint32_t k = 0; k < result_count(i); ++k) pending.push_back(i.dst + k);
}

/// Instructions [first, last); one by itself that others may not cross is fixed.
struct Range {
  std::size_t first = 0, last = 0;
  bool fixed = false;
};

std::vector<Range> pieces_of(const std::vector<ScalarInstruction>& code, const BasicBlock& block) {
  std::vector<Range> ranges;
  std::vector<std::uint32_t> pending;
  for (std::size_t at = block.first; at < block.last; ++at) {
    const Op op = code[at].op;
    const bool fixed = is_control(op) || op == Op::kKillIf || op == Op::kEnd;
    const bool wait = waits(code[at], pending);
    if (wait) pending.clear();
    if (ranges.empty() || wait || fixed || ranges.back().fixed) ranges.push_back({at, at, fixed});
    ranges.back().last = at + 1;
    note_request(code[at], pending);
  }
  return ranges;
}

}  // namespace

std::vector<ScalarInstruction> Interleaver::run(Preference preference, std::size_t live) const {
  std::vector<ScalarInstruction> out = code_;
  std::vector<ScalarInstruction> ordered;
  RegisterSet held(variable_.size());
  for (const BasicBlock& block : liveness_.blocks()) {
    liveness_.live_behind(block, held);
    const std::vector<Range> ranges = pieces_of(code_, block);
    for (auto range = ranges.rbegin(); range != ranges.rend(); ++range) {
      const std::size_t size = range->last - range->first;
      std::optional<Piece> piece;
      if (!range->fixed && size > 1)
        piece.emplace(std::span(code_).subspan(range->first, size), variable_, timing_, held);
      for (std::size_t at = range->last; at-- > range->first;) liveness_.step_back(at, held);
      if (!piece) continue;
      ordered.clear();
      piece->append(held, preference, live, ordered);
      std::ranges::copy(ordered, out.begin() + static_cast<std::ptrdiff_t>(range->first));
    }
  }
  return out;
}

double issue_cycles(const std::vector<ScalarInstruction>& code, std::size_t registers,
                    const IssueTiming& timing) {
  constexpr double kTurns = 8;
  std::vector<Cycle> ready(registers, 0);
  std::vector<std::uint32_t> pending;
  double cycles = 0, turns = 1;
  Cycle now = 0, all = 0;
  for (const ScalarInstruction& i : code) {
    const Cycle before = now;
    if (waits(i, pending) || (is_control(i.op) && !pending.empty())) {
      now = std::max(now, all);
      pending.clear();
    }
    for (const Value& v : {i.a, i.b, i.c})
      if (v.is_register()) now = std::max(now, ready[v.bits]);
    const Cycle done = now + IssueTiming::distance(timing.of(i.op));
    for (std::uint32_t k = 0; k < result_count(i); ++k) ready[i.dst + k] = done;
    all = std::max(all, done);
    now = is_control(i.op) ? done : now + timing.of(i.op).issue;
    note_request(i, pending);
    cycles += turns * static_cast<double>(now - before);
    if (i.op == Op::kLoop) turns *= kTurns;
    if (i.op == Op::kEndLoop) turns /= kTurns;
  }
  return cycles;
}

}  // namespace quadrille::pipeline
