/// What a unit did with its time, interval by interval, from the first tick on: busy, waiting for something
/// of its own, or waiting for a port. Kept only where somebody asks for the critical path of a frame.
///
/// An interval takes about two bytes, since like ones that follow each other are one, and lengths are kept in
/// cycles of as few bytes as they need.
#pragma once

#include "hw/base/clock.h"
#include "hw/base/work_log.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::hw {

class StatGroup;

class ChargeLog {
 public:
  /// What an interval went to: one of these, or `kFirstPort` and the number of a port of the unit's.
  static constexpr std::uint32_t kBusy = 0, kWaiting = 1, kFirstPort = 2;
  struct Interval {
    Tick from = 0, to = 0;
    std::uint32_t what = kBusy;
    DrawId draw = kNoDraw;  ///< that the unit worked for, where its group has a log; else none
  };

  /// `stats`: the unit's counters, null if it has none. `period`: length of its cycle in ticks.
  ChargeLog(const StatGroup* stats, Tick period) : stats_(stats), period_(period) {}

  /// The time up to `to`, from where the latest interval ended, went to `what`.
  void note(Tick to, std::uint32_t what);
  /// The last interval is as long as it gets. Before the first `Reader`.
  void finish();
  /// End of the last interval.
  [[nodiscard]] Tick end() const { return open_.to; }
  [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }

  /// Asked for ever earlier ticks, it unpacks every part of a log once.
  class Reader {
   public:
    explicit Reader(const ChargeLog& log) : log_(log) {}
    /// The interval that `t` lies in or at the end of; `t` is above 0 and not behind the log's end.
    [[nodiscard]] const Interval& at(Tick t);

   private:
    void unpack(std::size_t block);
    const ChargeLog& log_;
    std::vector<Interval> block_;
  };

 private:
  /// Where every `kBlock`-th interval lies, and what its predecessors have come to.
  struct Block {
    std::size_t offset = 0;
    Tick from = 0;
    DrawId draw = kNoDraw;
  };
  static constexpr std::size_t kBlock = 512;
  void put(std::uint64_t number);
  void pack(const Interval& interval);

  const StatGroup* stats_;
  Tick period_;
  Interval open_;  ///< the latest, which may become longer
  DrawId packed_draw_ = kNoDraw;
  std::size_t packed_ = 0;  ///< intervals
  std::vector<std::uint8_t> bytes_;
  std::vector<Block> blocks_;
};

}  // namespace quadrille::hw
