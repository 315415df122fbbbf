/// Which of a unit's counters are kept by draw and by part of the screen, and what they are a count of.
///
/// Each unit names its own (`Unit::details`); hw/base/work_log.h keeps them. What the counts are is the
/// pipeline's: hw/frame/detail_counts.h.
#pragma once

#include "hw/base/counter.h"

#include <cstdint>

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
};

}  // namespace quadrille::hw
