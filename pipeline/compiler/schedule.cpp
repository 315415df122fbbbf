/// Grouping of requests: within a straight-line stretch, texture instructions and buffer loads that do not
/// depend on each other are issued together.
#include "models/shader/warp.h"
#include "pipeline/compiler/dependences.h"
#include "pipeline/compiler/passes.h"

#include <algorithm>
#include <span>

namespace quadrille::pipeline {
namespace {

using models::Op;

class Stretch {
 public:
  Stretch(const ScalarShader& shader, std::size_t first, std::size_t last)
      : shader_(shader),
        first_(first),
        size_(last - first),
        needs_(dependences(std::span(shader.code).subspan(first, size_), shader.variable)) {
    level_.assign(size_, 0);
    done_.assign(size_, false);
    for (std::size_t at = 0; at < size_; ++at)
      for (const std::size_t before : needs_[at])
        level_[at] = std::max(level_[at], level_[before] + (is_request(code(before).op) ? 1 : 0));
  }

  void append(std::vector<ScalarInstruction>& out, Order order) {
    out_ = &out;
    emit_requests();
    if (order == Order::kRequestsDemand)
      for (std::size_t at = 0; at < size_; ++at)
        if (has_effect(code(at).op) || writes_variable(at)) emit(at);
    for (std::size_t at = 0; at < size_; ++at) emit(at);
  }

 private:
  [[nodiscard]] const ScalarInstruction& code(std::size_t at) const { return shader_.code[first_ + at]; }
  [[nodiscard]] bool writes_variable(std::size_t at) const {
    return models::destination_count(code(at).op) > 0 && shader_.variable[code(at).dst];
  }

  /// Emits an instruction after what it needs; depth first, without recursion.
  void emit(std::size_t root) {
    stack_.push_back(root);
    while (!stack_.empty()) {
      const std::size_t at = stack_.back();
      if (done_[at]) {
        stack_.pop_back();
        continue;
      }
      const std::size_t waiting = stack_.size();
      for (auto before = needs_[at].rbegin(); before != needs_[at].rend(); ++before)
        if (!done_[*before]) stack_.push_back(*before);
      if (stack_.size() != waiting) continue;
      done_[at] = true;
      out_->push_back(code(at));
      stack_.pop_back();
    }
  }

  void emit_requests() {
    std::vector<std::size_t> requests;
    for (std::size_t at = 0; at < size_; ++at)
      if (is_request(code(at).op)) requests.push_back(at);
    std::stable_sort(requests.begin(), requests.end(),
                     [&](std::size_t a, std::size_t b) { return level_[a] < level_[b]; });
    for (std::size_t from = 0; from < requests.size();) {
      std::size_t to = from;
      while (to < requests.size() && level_[requests[to]] == level_[requests[from]] &&
             to - from < models::kMaxClauseRequests)
        ++to;
      for (std::size_t k = from; k < to; ++k)
        for (const std::size_t before : needs_[requests[k]]) emit(before);
      for (std::size_t k = from; k < to; ++k) emit(requests[k]);
      from = to;
    }
  }

  const ScalarShader& shader_;
  std::size_t first_, size_;
  std::vector<std::vector<std::size_t>> needs_;
  std::vector<int> level_;
  std::vector<bool> done_;
  std::vector<std::size_t> stack_;
  std::vector<ScalarInstruction>* out_ = nullptr;
};

}  // namespace

std::vector<ScalarInstruction> schedule(const ScalarShader& shader, Order order) {
  if (order == Order::kSource) return shader.code;
  std::vector<ScalarInstruction> out;
  out.reserve(shader.code.size());
  std::size_t first = 0;
  for (std::size_t at = 0; at <= shader.code.size(); ++at) {
    const bool boundary = at == shader.code.size() || is_control(shader.code[at].op) ||
                          shader.code[at].op == Op::kKillIf || shader.code[at].op == Op::kEnd;
    if (!boundary) continue;
    Stretch(shader, first, at).append(out, order);
    if (at < shader.code.size()) out.push_back(shader.code[at]);
    first = at + 1;
  }
  return out;
}

}  // namespace quadrille::pipeline
