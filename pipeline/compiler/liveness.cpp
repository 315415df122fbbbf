#include "pipeline/compiler/liveness.h"

#include "pipeline/compiler/passes.h"

namespace quadrille::pipeline {

using models::Op;

void RegisterSet::insert(std::uint32_t r) {
  if (contains(r)) return;
  place_[r] = static_cast<std::uint32_t>(items_.size());
  items_.push_back(r);
}

void RegisterSet::erase(std::uint32_t r) {
  if (!contains(r)) return;
  const std::uint32_t last = items_.back();
  items_[place_[r]] = last;
  place_[last] = place_[r];
  place_[r] = kAbsent;
  items_.pop_back();
}

void RegisterSet::clear() {
  for (const std::uint32_t r : items_) place_[r] = kAbsent;
  items_.clear();
}

Liveness::Liveness(const std::vector<ScalarInstruction>& code, std::size_t registers)
    : code_(code), registers_(registers), late_(code.size()) {
  find_late_results();
  build_blocks();
  solve();
}

void Liveness::live_behind(const BasicBlock& block, RegisterSet& live) const {
  live.clear();
  for (std::size_t w = 0; w < block.live_out.size(); ++w)
    for (std::uint64_t bits = block.live_out[w]; bits != 0; bits &= bits - 1)
      live.insert(static_cast<std::uint32_t>(w * 64 + static_cast<std::size_t>(std::countr_zero(bits))));
}

void Liveness::step_back(std::size_t at, RegisterSet& live) const {
  for (std::uint32_t k = 0; k < result_count(code_[at]); ++k) live.erase(code_[at].dst + k);
  for_each_use(at, [&](std::uint32_t r) { live.insert(r); });
}

/// Marks all results of a texture instruction as read where the first of them is.
void Liveness::find_late_results() {
  std::vector<std::uint32_t> base(registers_, kNoRegister);
  for (const ScalarInstruction& i : code_)
    if (result_count(i) > 1)
      for (std::uint32_t k = 0; k < result_count(i); ++k) base[i.dst + k] = i.dst;
  std::vector<bool> seen(registers_, false);
  std::vector<std::uint32_t> count(registers_, 0);
  for (const ScalarInstruction& i : code_)
    if (result_count(i) > 1) count[i.dst] = result_count(i);
  for (std::size_t at = 0; at < code_.size(); ++at)
    for (const Value& v : {code_[at].a, code_[at].b, code_[at].c}) {
      if (!v.is_register() || base[v.bits] == kNoRegister || seen[base[v.bits]]) continue;
      const std::uint32_t first = base[v.bits];
      seen[first] = true;
      for (std::uint32_t k = 0; k < count[first]; ++k) late_[at].push_back(first + k);
    }
}

/// Places of the flow of control: for each IF its ELSE or ENDIF, and so on.
Liveness::Jumps Liveness::find_jumps() const {
  const std::size_t n = code_.size();
  Jumps jumps(n);
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
  return jumps;
}

void Liveness::build_blocks() {
  const Jumps jumps = find_jumps();
  const std::size_t n = code_.size();
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

void Liveness::solve() {
  const std::size_t words = (registers_ + 63) / 64;
  std::vector<std::vector<std::uint64_t>> used(blocks_.size()), defined(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    used[b].assign(words, 0);
    defined[b].assign(words, 0);
    blocks_[b].live_in.assign(words, 0);
    blocks_[b].live_out.assign(words, 0);
    for (std::size_t at = blocks_[b].first; at < blocks_[b].last; ++at) {
      for_each_use(at, [&](std::uint32_t r) {
        if ((defined[b][r / 64] >> (r % 64) & 1) == 0) used[b][r / 64] |= std::uint64_t{1} << (r % 64);
      });
      for (std::uint32_t k = 0; k < result_count(code_[at]); ++k) {
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

}  // namespace quadrille::pipeline
