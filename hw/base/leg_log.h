/// What a unit with many pieces of work in hand did for each: kept only where somebody asks for the critical
/// path of a frame. Of such a unit it says little that it was busy: another piece of work may have been.
///
/// A piece of work is done in legs. A leg begins with a token that the unit takes: the work itself, or an
/// answer that it waited for; and ends with a token that the unit sends.
#pragma once

#include "hw/base/clock.h"
#include "hw/base/work_log.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::hw {

class LegLog {
 public:
  /// A token was taken.
  struct Take {
    Tick arrived = 0, taken = 0;
    std::uint32_t port = 0;  ///< its number
    bool enters = false;     ///< it needs a place in the unit, which an earlier leg may have left
    DrawId draw = kNoDraw;
  };
  struct Leg {
    std::uint32_t take = 0;  ///< that it began with
    /// behind the take: up to then it waited for what the legs before it used
    Tick from = 0;
    /// done but for what is sent; all sent. Legs are noted in the order of the latter
    Tick able = 0, sent = 0;
    Tick latency = 0;       ///< of the time up to `able`: what an emptier unit would not save
    std::uint32_t out = 0;  ///< number of the port
    bool own_rate = false;  ///< from `able` on it waited for what is sent before it, not for room in the port
    bool leaves = false;    ///< a place gets free
  };

  /// Returns the number of the take.
  std::uint32_t take(const Take& take) {
    takes_.push_back(take);
    return static_cast<std::uint32_t>(takes_.size() - 1);
  }
  /// A piece of work, `entry`, has an answer; it has `token.draw`, and keeps the take's number as `leg_take`.
  template <class Entry>
  void take_answer(Entry& entry, Tick now, std::uint32_t port) {
    entry.leg_take = take({now, now, port, false, entry.token.draw});
  }
  void end(const Leg& leg);

  /// Is it through this port that legs end? Else what goes out there is asked for something on the way.
  [[nodiscard]] bool ends_legs(std::uint32_t port) const { return port < outs_.size() && outs_[port]; }
  /// The last leg that had sent all through the port by `t`; null if none.
  [[nodiscard]] const Leg* ended_by(Tick t, std::uint32_t port) const;
  /// The last leg that left its place by `t`, of those noted before `before` (null: of all); null if none.
  [[nodiscard]] const Leg* left_by(Tick t, const Leg* before) const;
  /// The last take by `t`, or the last of those that enter; null if none.
  [[nodiscard]] const Take* taken_by(Tick t) const;
  [[nodiscard]] const Take* entered_by(Tick t) const;
  [[nodiscard]] const Take& take_of(const Leg& leg) const { return takes_[leg.take]; }
  /// No leg was noted before it.
  [[nodiscard]] bool first(const Leg* leg) const { return leg == legs_.data(); }
  [[nodiscard]] bool empty() const { return legs_.empty(); }
  [[nodiscard]] std::size_t bytes() const {
    return legs_.size() * sizeof(Leg) + takes_.size() * sizeof(Take);
  }

 private:
  std::vector<Take> takes_;
  std::vector<Leg> legs_;
  std::vector<bool> outs_;  ///< by number of a port: legs end there
};

/// The number of the take, for a piece of work to keep; 0 while nobody keeps a log.
[[nodiscard]] inline std::uint32_t noted(LegLog* log, const LegLog::Take& take) {
  return log == nullptr ? 0 : log->take(take);
}

}  // namespace quadrille::hw
