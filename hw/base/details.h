/// Which of a unit's counters are kept by draw and by part of the screen, what they are a count of, and how
/// much of the unit's time a draw takes.
///
/// Each unit names its own (`Unit::details`); hw/base/work_log.h keeps them. What the counts are is the
/// pipeline's: hw/frame/detail_counts.h.
#pragma once

#include "hw/base/counter.h"

#include <cstdint>
#include <initializer_list>

namespace quadrille::hw {

enum class DrawCount : std::uint8_t;
enum class TileCount : std::uint8_t;

class Details {
 public:
  virtual ~Details() = default;
  /// The counter adds to this count of each draw.
  virtual void by_draw(DrawCount count, const Counter& counter) = 0;
  /// The counter adds to this count of each part of the screen.
  virtual void by_tile(TileCount count, const Counter& counter) = 0;
  /// The counter is a frame's total of this count, kept by another unit than the one that names it by tile.
  virtual void total_of_tiles(TileCount count, const Counter& counter) = 0;

  // The unit's time. If it says nothing here, it works for one draw at a time, and a draw's work are the busy
  // cycles in which the unit worked for it.
  /// Several draws are in the unit at a time, so its busy cycles are of none alone. `cycles` counts those of
  /// each; null: nobody does.
  virtual void shared_by_draws(const Counter* cycles) = 0;
  /// The sum of these counters grows by at most `per_cycle` a cycle of the unit's clock: a draw's work takes
  /// that long at least.
  virtual void work(std::initializer_list<const Counter*> counters, double per_cycle) = 0;
};

}  // namespace quadrille::hw
