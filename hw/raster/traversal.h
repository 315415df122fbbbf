/// How the coarse rasteriser finds the tiles of a triangle, one file a policy (traversal_*.cpp).
///
/// Both find the same samples covered. They differ in what is done for a tile, and in when it can leave.
#pragma once

#include "models/base/policy.h"
#include "models/raster/coarse.h"
#include "models/raster/engine.h"
#include "models/raster/span_tiles.h"
#include "models/raster/tile_order.h"

#include <cstdint>

namespace quadrille::hw {

class Traversal {
 public:
  struct Tile {
    models::TileHit hit;
    /// what is covered, where the traversal knows it; the fine rasteriser need not test it then
    bool walked = false;
    models::TileCoverage coverage{};
    /// Of the first tile of a row of tiles that was walked: cycles in which the next one is walked while this
    /// one leaves. None for all others.
    std::int64_t next_row_clk = kNoRow;
    static constexpr std::int64_t kNoRow = -1;
    [[nodiscard]] bool begins_row() const { return next_row_clk != kNoRow; }
  };
  struct Work {
    std::uint64_t tests = 0;  ///< of tiles
    std::uint64_t parts = 0, rows = 0, spans = 0, segments = 0;
  };

  virtual ~Traversal() = default;
  /// Takes a triangle. Returns the cycles of walking after which its first tile can leave.
  virtual std::int64_t begin(const models::TriangleSetup& triangle, const models::SampleGrid& samples) = 0;
  /// The next tile that is the engine's; false at the end of the triangle.
  virtual bool next(Tile& tile) = 0;
  /// Work since it was last asked for.
  virtual Work take_work() = 0;
  /// What of the unit limits it: the resource's name.
  [[nodiscard]] virtual std::string_view limited_by() const = 0;
};

struct TraversalSetup {
  const models::TileOrderPolicy& order;
  int walk_setup_clk = 1, rows_per_clk = 1, segments_per_clk = 1;
  models::ScreenShare screen;
  std::uint32_t engine = 0;
  [[nodiscard]] bool owns(std::int32_t tile_x, std::int32_t tile_y) const {
    return screen.engines == 1 || screen.engine_of_tile(static_cast<std::uint32_t>(tile_x),
                                                        static_cast<std::uint32_t>(tile_y)) == engine;
  }
};
using TraversalPolicy = Policy<Traversal, const TraversalSetup&>;
/// What `coarse_raster.traversal` chooses from.
[[nodiscard]] PolicyList<TraversalPolicy>& traversal_policies();
extern const TraversalPolicy kEdgeFunctions, kEdgeWalking;

}  // namespace quadrille::hw
