/// A frame's figures by draw and by part of the screen, and the laws that they obey: what the draws and the
/// rest did is what the frame did.
///
/// Units name the draw and the tile that they work for (hw/base/work_log.h) and which of their counters are
/// kept so; here is under what name the figures show them.
#pragma once

#include "hw/base/audit.h"
#include "hw/frame/detail_counts.h"
#include "models/base/id.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// Which details of a frame are kept and reported. None changes a pixel or a cycle.
struct DetailOptions {
  bool draws = false, tiles = false;
  /// use is there anyway, and is only reported; what moved in each slice is kept (flow_log.h)
  bool timeline = false;
  bool path = false;      ///< the chain of waits that the frame's end hangs on (critical_path.h)
  bool misses = false;    ///< why texture caches missed (miss_kinds.h)
  bool textures = false;  ///< what each texture was asked for (texture_use.h)
  /// Something is kept by draw or by square.
  [[nodiscard]] bool any() const { return draws || tiles; }
};

using hw::DrawCount;
using hw::kDrawCounts;
using hw::kReportedDrawCounts;
using hw::kTileCounts;
using hw::TileCount;

/// A count of a draw or of a part of the screen: its place in the JSON, and the law of its sum over the
/// frame. Which counters it is the sum of is the units' to say (`hw::Unit::details`).
struct DetailCount {
  std::string_view group, key;
  hw::Law law;
};
/// By `DrawCount`, and by `TileCount`.
[[nodiscard]] const std::array<DetailCount, kDrawCounts>& draw_counts();
[[nodiscard]] const std::array<DetailCount, kTileCounts>& tile_counts();

/// What one draw did, or what belonged to no draw.
struct DrawFigures {
  std::string label;
  std::string vertex_shader, fragment_shader;  ///< as the scene or the trace names them
  models::PassId pass = {};
  /// cycles of the GPU clock: the command processor issues it; every partition has retired it
  std::int64_t issued = 0, retired = 0;
  std::array<std::uint64_t, kDrawCounts> counts{};
  /// by kind of unit: cycles, summed over its units; of cores those of their SIMD units
  std::vector<std::int64_t> busy = {};
  /// by kind of unit: GPU cycles that its busiest unit needs for the draw's work at its peak rates
  std::vector<double> work = {};
  [[nodiscard]] std::uint64_t of(DrawCount count) const { return counts[static_cast<std::size_t>(count)]; }
  [[nodiscard]] std::int64_t in_flight() const { return retired - issued; }
};

/// What limits a draw: the kind of unit with the most work, unless that fills less than half of the time that
/// the draw was in flight.
struct DrawLimiter {
  std::string_view unit;  ///< kind with the most work; empty: no unit worked for it
  double work = 0;        ///< GPU cycles
  double share = 0;       ///< of the cycles in flight
  [[nodiscard]] bool latency() const { return share < 0.5; }
  [[nodiscard]] std::string_view kind() const { return latency() ? "latency" : unit; }
};

/// The screen in squares, row by row from its top left. The last entry of each array is what has no place
/// there.
struct TileFigures {
  std::uint32_t width = 0, height = 0;  ///< squares across and down
  std::uint32_t pixels = 32;            ///< side of a square
  std::array<std::vector<std::uint64_t>, kTileCounts> counts;
};

struct Detail {
  DetailOptions wanted;
  std::vector<std::string> kinds;  ///< of units, in the order of the pipeline
  std::vector<DrawFigures> draws;  ///< in API order
  DrawFigures outside_draws;       ///< clears, scan-out, write-backs of the L2 cache, bounds of passes
  TileFigures tiles;
  std::array<std::uint64_t, kDrawCounts> draw_totals{};  ///< what the units counted in all
  std::array<std::uint64_t, kTileCounts> tile_totals{};
  std::int64_t busy_total = 0;  ///< cycles, all units whose busy cycles are kept by draw

  [[nodiscard]] DrawLimiter limiter(const DrawFigures& draw) const;
  /// Adds both sides of every law of details.
  void audit(hw::Audit& audit) const;
};

}  // namespace quadrille::pipeline
