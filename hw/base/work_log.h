/// For which draw, and for which part of the screen, a unit counted what it counted.
///
/// A unit names the draw that it works for (`StatGroup::working_for`), and what its counters grow by until it
/// names another one is added to that draw's row. A unit without a log pays for a test. Nothing that a unit
/// decides may depend on its log.
#pragma once

#include "models/base/id.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::hw {

using models::DrawId;

inline constexpr DrawId kNoDraw{0xffffffffu};
inline constexpr std::uint32_t kNoTile = 0xffffffffu;

/// A draw of the frame, and a tile of 8x8 pixels of its target; either may be none.
struct Work {
  DrawId draw = kNoDraw;
  std::uint32_t tile = kNoTile;  ///< y * 65536 + x
  bool operator==(const Work&) const = default;
};
[[nodiscard]] constexpr std::uint32_t tile_at(std::uint32_t tile_x, std::uint32_t tile_y) {
  return tile_y << 16 | tile_x;
}

/// The screen in square cells of several tiles. Only work of the draws that are on the screen has a cell.
struct ScreenCells {
  DrawId first_draw;                    ///< of the pass that is shown
  std::uint32_t draws = 0;              ///< those of the pass
  std::uint32_t columns = 0, rows = 0;  ///< cells
  std::uint32_t tiles = 4;              ///< side of a cell, in tiles
  [[nodiscard]] std::uint32_t count() const { return columns * rows; }
  /// `count()` where there is none.
  [[nodiscard]] std::uint32_t cell_of(Work work) const {
    if (work.tile == kNoTile || work.draw.index() - first_draw.index() >= draws) return count();
    const std::uint32_t x = (work.tile & 0xffffu) / tiles, y = (work.tile >> 16) / tiles;
    return x < columns && y < rows ? y * columns + x : count();
  }
};

class WorkLog {
 public:
  /// Counts by `draws` draws and by the cells of `screen`; what belongs to none goes to a row of its own
  /// behind them.
  WorkLog(std::uint32_t draws, const ScreenCells& screen)
      : draws_(draws), screen_(screen), cell_(screen.count()) {}

  /// Keeps the growth of `count` by draw, from now on. Returns its column. Before the first turn.
  std::size_t by_draw(const std::uint64_t& count) { return draw_rows_.add(count, draws_ + 1); }
  std::size_t by_draw(const std::int64_t& count) {
    return by_draw(reinterpret_cast<const std::uint64_t&>(count));
  }
  /// The same by cell.
  std::size_t by_cell(const std::uint64_t& count) { return cell_rows_.add(count, screen_.count() + 1); }

  /// What is counted from here on is for `work`.
  void turn_to(Work work);
  [[nodiscard]] Work now() const { return now_; }
  /// Adds what was counted since the latest turn; then the rows add up to the counts.
  void settle();

  /// `kNoDraw`, or the number of cells: what belongs to none.
  [[nodiscard]] std::uint64_t of_draw(std::size_t column, DrawId draw) const {
    return draw_rows_.at(row_of(draw), column);
  }
  [[nodiscard]] std::uint64_t of_cell(std::size_t column, std::uint32_t cell) const {
    return cell_rows_.at(cell, column);
  }

 private:
  /// A row of sums for each draw or cell, a column for each count.
  class Rows {
   public:
    std::size_t add(const std::uint64_t& count, std::size_t rows) {
      counts_.push_back({&count, count});
      sums_.assign(rows * counts_.size(), 0);
      return counts_.size() - 1;
    }
    void note(std::size_t row) {
      std::uint64_t* sum = sums_.data() + row * counts_.size();
      for (Count& c : counts_) {
        *sum++ += *c.count - c.noted;
        c.noted = *c.count;
      }
    }
    [[nodiscard]] std::uint64_t at(std::size_t row, std::size_t column) const {
      return sums_[row * counts_.size() + column];
    }

   private:
    struct Count {
      const std::uint64_t* count;
      std::uint64_t noted;
    };
    std::vector<Count> counts_;
    std::vector<std::uint64_t> sums_;
  };

  [[nodiscard]] std::uint32_t row_of(DrawId draw) const { return std::min(draw.index(), draws_); }
  std::uint32_t draws_;
  ScreenCells screen_;
  Work now_;
  std::uint32_t cell_;  ///< of `now_`
  Rows draw_rows_, cell_rows_;
};

}  // namespace quadrille::hw
