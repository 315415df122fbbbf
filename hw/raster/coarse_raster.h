/// Coarse rasteriser with Hi-Z: finds the 8x8-pixel tiles a triangle touches and drops those that are wholly
/// behind what is there.
///
/// In    triangle_in  set-up primitives; boundaries
///       hiz_in[p]    a tile's greatest depth became smaller, from the depth unit of its partition p
/// Out   tile_out     tiles of one primitive, as `order` says; boundaries; now and then a sync for the
///                    triangle store
/// Time  `tests_per_clk` tile tests a cycle and at most one tile out a cycle; waits while tile_out is full
///
/// Hi-Z holds, for each tile of the pass, a depth that no stored depth exceeds. It may be late (updates
/// travel by FIFO), which only keeps more. It is trusted only while every depth write of the pass can but
/// lower depths: a draw that writes with another comparison switches it off until the next clear.
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/base/work_rate.h"
#include "hw/frame/stores.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "models/raster/coarse.h"
#include "models/raster/tile_order.h"

#include <optional>

namespace quadrille::hw {

class CoarseRaster final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> tests_per_clk{*this,      "tests_per_clk", 4,
                             "tile/clk", {1, 64},         "Tile tests a cycle. [G: feeds 16 px/clk]"};
    Param<int> tiles_per_clk{*this,
                             "tiles_per_clk",
                             1,
                             "tile/clk",
                             {1, 64},
                             "Tiles handed on, or triangles without any, a cycle; more than "
                             "link.coarse_to_fine.width tiles are not. [G: one raster "
                             "engine]"};
    Param<int> reports{*this,
                       "reports",
                       8,
                       "report",
                       {1, 1 << 20},
                       "Reports behind which a triangle's slot may be used again, a turn of the triangle "
                       "store; each takes a cycle. [G: an eighth of "
                       "the store waits]",
                       Effect::kTradeOff};
    Param<bool> hiz{*this, "hiz", true, "", "Drop tiles that Hi-Z proves hidden."};
    PolicyParam<models::TileOrderPolicy> order{*this, "order", models::tile_order_policies(),
                                               models::kScanTileOrder,
                                               "In which order the tiles of a triangle go on. Their tests "
                                               "cost the same. [G: as the walk finds them]"};
  };
  struct Stats : StatGroup {
    Counter triangles{*this, "triangles", "triangle", "Triangles walked"};
    Counter tiles_tested{*this, "tiles_tested", "tile", "Tiles tested against edges"};
    Counter tiles_kept{*this, "tiles_kept", "tile", "Tiles handed to the fine rasteriser"};
    Counter tiles_hidden{*this, "tiles_hidden", "tile", "Tiles dropped by Hi-Z"};
    Counter hiz_updates{*this, "hiz_updates", "update", "Hi-Z updates taken in"};
  };
  CoarseRaster(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
               const TriangleStore& triangles);

  FifoIn<TriangleToken> triangle_in{*this, "triangle_in"};
  FifoInGroup<HiZToken> hiz_in;
  FifoOut<TileToken> tile_out{*this, "tile_out"};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  [[nodiscard]] Wake work_wake() const;
  void work(Tick now);
  void take_token(Tick now);
  void spend(Tick now, std::int64_t cost);
  void take_updates(Tick now);
  /// Finds the next tile of the walk, so that the last one is known as such when it leaves.
  void look_ahead();
  /// The next tile of the walk, in the machine's order; false at its end.
  [[nodiscard]] bool next_tile(models::TileHit& tile);
  void sort_tiles();
  [[nodiscard]] bool owns(const models::TileHit& tile) const;
  /// Of this walk so far: those of its own tiles, and its share of those that failed.
  [[nodiscard]] std::uint64_t tests() const;
  void walk(Tick now);
  void begin_pass(PassId pass);
  [[nodiscard]] bool hidden(const models::TileHit& tile) const;
  void drop(const models::TileHit& tile);
  void note_direction(const DrawState& draw);

  const Params& params_;
  const Frame& frame_;
  const TriangleStore& triangles_;
  const models::ScreenShare screen_;
  const std::uint32_t engine_;
  const std::uint64_t sync_interval_;  ///< triangles between syncs
  Stats stats_;
  bool walking_ = false;
  models::TileWalk walk_;
  std::unique_ptr<models::TileOrder> order_;
  /// of the walk, where they do not go on as they are found; with their places
  std::vector<std::pair<std::uint64_t, models::TileHit>> sorted_;
  std::size_t next_sorted_ = 0;
  std::optional<models::TileHit> ahead_;   ///< the next tile of the walk; none at its end
  std::uint64_t charged_tests_ = 0;        ///< of this walk
  std::uint64_t touched_ = 0, owned_ = 0;  ///< tiles of this walk, and those of them that are the engine's
  std::uint64_t triangle_ = 0;             ///< being walked
  DrawId draw_;
  PassId pass_;
  bool hiz_usable_ = false;  ///< this draw may be tested
  bool hiz_trusted_ = true;  ///< no draw of the pass has raised depths
  std::uint64_t since_sync_ = 0;
  bool sync_due_ = false;
  std::vector<float> hiz_;  ///< by tile of the pass; empty when no draw of it tests depth
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
