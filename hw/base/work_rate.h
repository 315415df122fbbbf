/// Work at a rate of several things a cycle, or of several cycles a thing: exact for whole numbers up to 16
/// either way, never faster than asked for others.
#pragma once

#include "hw/base/clock.h"

#include <cmath>
#include <cstdint>

namespace quadrille::hw {

class WorkRate {
 public:
  /// Parts of a cycle; what is charged is counted in them. Divisible by 1 to 16.
  static constexpr std::int64_t kCycle = 720720;
  /// What one of `per_clk` a cycle costs.
  [[nodiscard]] static std::int64_t cost(double per_clk) {
    return static_cast<std::int64_t>(std::ceil(kCycle / per_clk));
  }
  /// What `count` at `per_clk` a cycle cost: their part of a cycle, and whole cycles where one does not
  /// suffice.
  [[nodiscard]] static std::int64_t cost_of(std::int64_t count, std::int64_t per_clk) {
    return count > per_clk ? (count + per_clk - 1) / per_clk * kCycle
                           : count * cost(static_cast<double>(per_clk));
  }

  explicit WorkRate(const Clock& clock) : clock_(clock) {}
  /// Charges work that begins at `now`; returns when the next may begin, which is `now` while the cycle has
  /// room for more. What a cycle has left lapses with it.
  Tick charge(Tick now, std::int64_t cost) {
    if (now != at_) used_ = 0;
    used_ += cost;
    cycles_ = used_ / kCycle;
    used_ %= kCycle;
    return at_ = cycles_ == 0 ? now : clock_.after(now, cycles_);
  }
  /// Cycles from its beginning that the work charged last makes use of, the begun one included.
  [[nodiscard]] std::int64_t cycles() const { return cycles_ + (used_ > 0 ? 1 : 0); }

 private:
  Clock clock_;
  Tick at_ = -1;  ///< the next may begin here, in a cycle of which `used_` is gone
  std::int64_t used_ = 0, cycles_ = 0;
};

}  // namespace quadrille::hw
