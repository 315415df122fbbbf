/// Keeps, while a machine runs, for which draw and which part of the screen its units count; afterwards, the
/// figures of that.
#pragma once

#include "hw/base/work_log.h"
#include "pipeline/machine/machine.h"
#include "pipeline/report/detail.h"
#include "pipeline/report/kept_counters.h"

#include <memory>
#include <optional>
#include <vector>

namespace quadrille::pipeline {

/// The squares in which the figures count by part of the screen: of the pass that is shown.
[[nodiscard]] hw::ScreenCells screen_cells(const hw::Frame& frame);

class DetailLog {
 public:
  /// Gives every unit of the machine a log. Before the run; the machine lives longer than this or is not run
  /// any more. `kept`: what to keep beside it; lives as long.
  DetailLog(const Machine& machine, const DeviceFrame& frame, DetailOptions wanted,
            KeptCounters* kept = nullptr);
  /// After the run.
  [[nodiscard]] Detail collect();

  struct Column {
    std::size_t count = 0, column = 0;  ///< which count, and where the log keeps a counter of it
    const hw::Counter* counter = nullptr;
  };
  struct LoggedUnit {
    const hw::Unit* unit = nullptr;
    std::size_t kind = 0;
    std::unique_ptr<hw::WorkLog> log;
    std::vector<Column> draws, tiles;
    /// `count` is the place in `CountersByDraw::asked`, and in `KeptCounters::by_square`
    std::vector<Column> asked, asked_squares;
    std::vector<Column> tile_totals;  ///< by counters that are not kept by tile
    std::size_t busy = 0;             ///< column
    bool shared = false;              ///< several draws are in it at a time
    std::optional<Column> own_busy;   ///< then: cycles of each, where they are counted
    struct Work {
      std::vector<std::size_t> columns;
      double per_cycle = 1;
    };
    std::vector<Work> work;
  };

 private:
  void add(const hw::Unit& unit);
  void add_asked(LoggedUnit& unit, const std::string& kind) const;
  void collect_asked();
  void collect_squares();
  void collect_draw(const LoggedUnit& u, hw::DrawId id, DrawFigures& draw) const;
  void collect_tiles(const LoggedUnit& u, TileFigures& tiles) const;
  /// Cycles that a unit was busy for a draw; 0 where that is not known.
  [[nodiscard]] static std::int64_t busy_of(const LoggedUnit& u, hw::DrawId id);
  /// GPU cycles of a unit's work for a draw at its peak rates.
  [[nodiscard]] double work_of(const LoggedUnit& u, hw::DrawId id) const;

  const Machine& machine_;
  const DeviceFrame& frame_;
  Detail detail_;
  KeptCounters* kept_;
  hw::ScreenCells screen_;
  std::vector<LoggedUnit> units_;
};

}  // namespace quadrille::pipeline
