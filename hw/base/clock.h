/// Simulated time: integer femtoseconds, and clocks whose edges never drift.
#pragma once

#include "models/base/error.h"

#include <cstdint>
#include <limits>
#include <numeric>

namespace quadrille::hw {

/// A point in simulated time, in femtoseconds since the start. 2^63 fs is two and a half hours of device
/// time.
using Tick = std::int64_t;
inline constexpr Tick kNever = std::numeric_limits<Tick>::max();

/// A clock domain. Edge k is at floor(k * 10^15 / frequency_hz), so any frequency keeps its long-run rate
/// exactly.
///
/// The functions divide by nothing: the period is a whole part and a 64-bit binary fraction rounded up, which
/// gives the exact floor for every k below 2^64 / denominator; beyond that (only frequencies with a huge
/// reduced denominator, after seconds of device time) 128-bit arithmetic takes over.
class Clock {
 public:
  explicit Clock(std::int64_t frequency_hz = 1'000'000'000) : hz_(frequency_hz), domain_hz_(frequency_hz) {
    QUADRILLE_CHECK(frequency_hz > 0 && frequency_hz <= kFemto, "clock frequency {} Hz", frequency_hz);
    whole_ = kFemto / hz_;
    per_tick_ = static_cast<double>(hz_) / static_cast<double>(kFemto);
    if (const std::int64_t rest = kFemto % hz_; rest != 0) {
      const std::int64_t divisor = std::gcd(rest, hz_);
      const auto denominator = static_cast<std::uint64_t>(hz_ / divisor);
      fraction_ = static_cast<std::uint64_t>((static_cast<Wide>(rest / divisor) << 64) / denominator) + 1;
      exact_below_ = static_cast<std::int64_t>(std::numeric_limits<std::uint64_t>::max() / denominator);
    }
  }

  /// A clock of the same domain whose cycles are all equal and `times` as short, to a femtosecond. Its edges
  /// are no edges of the domain's; what passes between them waits for none.
  [[nodiscard]] Clock faster(double times) const;

  [[nodiscard]] std::int64_t frequency_hz() const { return hz_; }
  /// Nothing needs a synchroniser between the two.
  [[nodiscard]] bool same_domain(const Clock& other) const { return domain_hz_ == other.domain_hz_; }
  /// Every cycle has the same whole number of femtoseconds: `period()`.
  [[nodiscard]] bool uniform() const { return fraction_ == 0; }
  /// Is every span between actions of its owner a whole number of cycles? Not where the clock is a faster one
  /// of its domain: there, actions need not lie on edges.
  [[nodiscard]] bool spans_are_cycles() const { return uniform() && !free_running_; }
  /// Femtoseconds of a cycle, rounded down.
  [[nodiscard]] Tick period() const { return whole_; }

  /// Tick of edge k >= 0.
  [[nodiscard]] Tick edge(std::int64_t k) const {
    if (k < exact_below_) return k * whole_ + static_cast<Tick>((static_cast<Wide>(k) * fraction_) >> 64);
    return static_cast<Tick>(static_cast<Wide>(k) * kFemto / static_cast<Wide>(hz_));
  }
  /// Index of the first edge at or after `t` >= 0; equally the number of edges in [0, t).
  [[nodiscard]] std::int64_t edges_before(Tick t) const {
    // at most one or two off; the loops make it exact
    auto k = static_cast<std::int64_t>(static_cast<double>(t) * per_tick_);
    while (k > 0 && edge(k - 1) >= t) --k;
    while (edge(k) < t) ++k;
    return k;
  }
  /// The first edge at or after `t`; kNever stays kNever.
  [[nodiscard]] Tick align(Tick t) const { return t == kNever ? kNever : edge(edges_before(t)); }
  /// The edge `cycles` after the edge `t`. `t` must be an edge.
  [[nodiscard]] Tick after(Tick t, std::int64_t cycles) const {
    return uniform() ? t + cycles * whole_ : after_uneven(t, cycles);
  }
  /// Edges in [from, to).
  [[nodiscard]] std::int64_t cycles(Tick from, Tick to) const;

 private:
  __extension__ using Wide = unsigned __int128;
  // out of line, to keep the common case short
  [[nodiscard]] Tick after_uneven(Tick t, std::int64_t cycles) const;
  static constexpr std::int64_t kFemto = 1'000'000'000'000'000;
  std::int64_t hz_, domain_hz_;
  bool free_running_ = false;
  Tick whole_ = 0;  ///< whole femtoseconds of the period
  /// the rest of the period in units of 2^-64 fs, rounded up; 0 for a uniform clock
  std::uint64_t fraction_ = 0;
  std::int64_t exact_below_ = std::numeric_limits<std::int64_t>::max();
  double per_tick_ = 0;  ///< cycles a femtosecond
};

}  // namespace quadrille::hw
