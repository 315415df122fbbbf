/// One SIMD unit of a core: the clauses that issue on it, and how they share its one instruction a turn.
///
/// A clause needs `work` issue cycles, and `span` cycles if it has the SIMD to itself: in the rest it waits
/// for its own results, and other clauses issue. Clauses proceed at rates: one that has all it can use
/// advances by a cycle of its span a cycle, and uses work / span of the SIMD; the sum is at most one. So a
/// chain of dependent instructions takes its span however few others run, and enough others fill the SIMD and
/// no more. Who issues first is a policy (simd_sharing.h).
#pragma once

#include "hw/shader/simd_sharing.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace quadrille::hw {

class Simd {
 public:
  using Cycle = std::int64_t;
  static constexpr Cycle kNever = std::numeric_limits<Cycle>::max();

  explicit Simd(const SimdSharingPolicy& sharing) : sharing_(sharing.make()) {}

  /// A clause begins to issue at `now`; `name` comes back when its last instruction has issued. Cycles do not
  /// go back from call to call.
  void add(Cycle now, std::uint32_t name, std::uint32_t work, std::uint32_t span);
  /// The first cycle in which a clause has issued its last instruction.
  [[nodiscard]] Cycle next_end() const { return next_end_; }
  /// Takes a clause that has ended by `now` out. False when there is none.
  bool take_ended(Cycle now, std::uint32_t& name);
  /// Issue cycles used up to `now`, which is not before the latest call and not after `next_end()`.
  [[nodiscard]] double issued(Cycle now) const;
  [[nodiscard]] std::size_t clauses() const { return running_.size(); }

 private:
  void advance(Cycle now);
  void share_out();

  std::unique_ptr<SimdSharing> sharing_;
  Cycle now_ = 0, next_end_ = kNever;
  double issued_ = 0;                ///< up to `now_`
  std::vector<SimdClause> running_;  ///< in order of arrival
};

}  // namespace quadrille::hw
