/// One SIMD unit of a core: the clauses that issue on it, and how they share its one instruction a turn.
///
/// A clause needs `work` issue cycles, and `span` cycles if it has the SIMD to itself: in the rest it waits
/// for its own results, and other clauses issue. Clauses proceed at rates: one that has all it can use
/// advances by a cycle of its span a cycle, and uses work / span of the SIMD; the sum is at most one. So a
/// chain of dependent instructions takes its span however few others run, and enough others fill the SIMD and
/// no more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace quadrille::hw {

/// Who issues when more clauses could than the SIMD has cycles for.
enum class WarpScheduling : std::uint8_t {
  kOldest,     ///< the clause that came first takes what it can use, then the next
  kRoundRobin  ///< all get the same share; what one cannot use goes to the others
};

class Simd {
 public:
  using Cycle = std::int64_t;
  static constexpr Cycle kNever = std::numeric_limits<Cycle>::max();

  explicit Simd(WarpScheduling scheduling) : scheduling_(scheduling) {}

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
  struct Running {
    std::uint32_t name = 0;
    double left = 0;   ///< cycles of its span
    double share = 0;  ///< of the SIMD that it can use
    double speed = 0;  ///< cycles of its span a cycle
  };
  void advance(Cycle now);
  void share_out();
  void share_out_evenly();

  WarpScheduling scheduling_;
  Cycle now_ = 0, next_end_ = kNever;
  double issued_ = 0;             ///< up to `now_`
  std::vector<Running> running_;  ///< in order of arrival
  std::vector<double> shares_;    ///< scratch of share_out_evenly
};

}  // namespace quadrille::hw
