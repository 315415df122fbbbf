#include "pipeline/compiler/atomic_outputs.h"

#include <algorithm>
#include <array>

namespace quadrille::pipeline {
namespace {

using models::Op;

class Followed {
 public:
  explicit Followed(const ScalarShader& shader)
      : shader_(shader), follows_(shader.variable.size(), false), leaves_(shader.code.size(), false) {}

  bool run() {
    do {
      changed_ = false;
      walk();
    } while (changed_ && !reached_);
    return reached_;
  }

 private:
  /// A construct that is open: do its lanes follow an atomic operation?
  struct Construct {
    std::size_t begin = 0;
    bool loop = false, follows = false;
  };

  void walk() {
    open_.clear();
    for (std::size_t at = 0; at < shader_.code.size(); ++at) {
      const ScalarInstruction& i = shader_.code[at];
      if (i.op == Op::kIf) open_.push_back({at, false, reads(i)});
      else if (i.op == Op::kLoop) open_.push_back({at, true, leaves_[at]});
      else if (i.op == Op::kEndIf || i.op == Op::kEndLoop) open_.pop_back();
      else if (i.op == Op::kBreakIf || i.op == Op::kContinueIf) leave(i);
      else visit(i);
    }
  }

  [[nodiscard]] bool reads(const ScalarInstruction& i) const {
    return std::ranges::any_of(std::array{i.a, i.b, i.c},
                               [&](const Value& v) { return v.is_register() && follows_[v.bits]; });
  }
  [[nodiscard]] bool inside() const {
    return std::ranges::any_of(open_, [](const Construct& c) { return c.follows; });
  }

  /// The innermost loop, and what is between, runs for lanes that follow.
  void leave(const ScalarInstruction& i) {
    if (!reads(i) && !inside()) return;
    const auto loop = std::find_if(open_.rbegin(), open_.rend(), [](const Construct& c) { return c.loop; });
    if (loop == open_.rend() || leaves_[loop->begin]) return;
    leaves_[loop->begin] = changed_ = true;
  }

  void visit(const ScalarInstruction& i) {
    const bool followed = reads(i) || inside();
    if (followed && (i.op == Op::kOutput || i.op == Op::kKillIf)) reached_ = true;
    if (followed && models::writes_buffer(i.op)) set(memory_);
    if (!followed && !models::is_atomic(i.op) && !(i.op == Op::kLoadBuffer && memory_)) return;
    for (int k = 0; k < models::destination_count(i.op); ++k) {
      const std::size_t r = i.dst + static_cast<std::size_t>(k);
      if (follows_[r]) continue;
      follows_[r] = changed_ = true;
    }
  }

  void set(bool& flag) {
    changed_ |= !flag;
    flag = true;
  }

  const ScalarShader& shader_;
  std::vector<bool> follows_;  ///< by register
  std::vector<bool> leaves_;   ///< by place of a loop: lanes leave it as atomic operations say
  std::vector<Construct> open_;
  bool memory_ = false;  ///< what the program stores follows
  bool reached_ = false, changed_ = false;
};

}  // namespace

bool outputs_follow_atomics(const ScalarShader& shader) {
  const bool any =
      std::ranges::any_of(shader.code, [](const ScalarInstruction& i) { return models::is_atomic(i.op); });
  return any && Followed(shader).run();
}

}  // namespace quadrille::pipeline
