/// Coarse rasteriser with Hi-Z: finds the 8x8-pixel tiles a triangle touches and drops those that are wholly
/// behind what is there.
///
/// In    triangle_in  set-up primitives; boundaries
///       hiz_in[p]    a tile's greatest depth became smaller, from the depth unit of its partition p
/// Out   tile_out     tiles of one primitive, as `order` says; boundaries; now and then a sync for the
///                    triangle store
/// Time  edge functions: `tests_per_clk` tile tests a cycle and `tiles_per_clk` tiles out; waits while
///       tile_out is full
///       edge walking: the tiles of a row of tiles leave once its rows are walked, at `rows_per_clk` rows of
///       samples a cycle, `segments_per_clk` crossed tiles a cycle and `walk_setup_clk` cycles a part of a
///       triangle; meanwhile the next row of tiles is walked, or the first one of the next triangle
///
/// With `hiz_min` it holds a depth too that none is below: the least of all tiles of draws that write depth,
/// as they are handed on, so that no update has to travel. A tile that is wholly nearer passes the depth test
/// unread.
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
#include "hw/raster/traversal.h"

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
    Param<bool> hiz_min{*this, "hiz_min", false, "",
                        "Keep the least depth of each tile too, so that the depths behind a tile that is "
                        "wholly in front are not read."};
    PolicyParam<models::TileOrderPolicy> order{*this, "order", models::tile_order_policies(),
                                               models::kScanTileOrder,
                                               "In which order the tiles of a triangle go on. Their tests "
                                               "cost the same. [G: as the walk finds them]"};
    PolicyParam<TraversalPolicy> traversal{*this, "traversal", traversal_policies(), kEdgeFunctions,
                                           "How the tiles of a triangle are found. Edge walking goes by "
                                           "rows, so its `order` is scan. [G: as GPUs "
                                           "do]"};
    Param<int> rows_per_clk{
        *this,
        "rows_per_clk",
        1,
        "row/clk",
        {1, 16},
        "Edge walking: rows of samples a cycle, each an addition for either edge. [G: one "
        "pair of adders]"};
    Param<int> segments_per_clk{
        *this,
        "segments_per_clk",
        2,
        "tile/clk",
        {1, 16},
        "Edge walking: tiles a cycle of those that a row's span crosses. [G: 16 px/clk, "
        "as tests_per_clk]"};
    Param<int> walk_setup_clk{*this,
                              "walk_setup_clk",
                              2,
                              "clk",
                              {1, 64},
                              "Edge walking: cycles a part of a triangle, of each sample. [G: a division for "
                              "either edge]",
                              Effect::kSlower};
  };
  struct Stats : StatGroup {
    Counter triangles{*this, "triangles", "triangle", "Triangles walked"};
    Counter tiles_tested{*this, "tiles_tested", "tile",
                         "Tiles tested, against the edges and by Hi-Z; with edge walking by Hi-Z alone"};
    Counter tiles_kept{*this, "tiles_kept", "tile", "Tiles handed to the fine rasteriser"};
    Counter tiles_hidden{*this, "tiles_hidden", "tile", "Tiles dropped by Hi-Z"};
    Counter hiz_updates{*this, "hiz_updates", "update", "Hi-Z updates taken in"};
    Counter walked_parts{*this, "walked_parts", "part",
                         "Edge walking: parts of triangles whose edges were set up, of each sample"};
    Counter rows{*this, "rows", "row", "Edge walking: rows of samples walked"};
    Counter spans{*this, "spans", "span", "Edge walking: rows with a covered sample"};
    Counter segments{*this, "segments", "segment", "Edge walking: tiles crossed by spans"};
    Counter tiles_in_front{*this, "tiles_in_front", "tile",
                           "Tiles handed on as wholly in front of all that is there"};
  };
  CoarseRaster(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
               const TriangleStore& triangles, WalkedStore& walked);

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
  void begin_triangle(Tick now, Tick visible, const TriangleToken& token);
  void spend(Tick now, std::int64_t cost);
  void take_updates(Tick now);
  /// Finds the next tile of the triangle, so that the last one is known as such when it leaves.
  void look_ahead();
  /// Begins to walk what follows the row of tiles that begins to leave.
  void walk_ahead(Tick now);
  void walk(Tick now);
  void begin_pass(PassId pass);
  /// The next tile that Hi-Z does not hide; none if the triangle, or what is walked of it now, ends before.
  [[nodiscard]] std::optional<Traversal::Tile> visible_tile(Tick now);
  void hand_on(Tick now, const Traversal::Tile& tile);
  void count(const Traversal::Work& work);
  [[nodiscard]] bool hidden(const models::TileHit& tile) const;
  void drop(const models::TileHit& tile);
  /// Is the tile in front of all that is there? Takes its depths into account from now on.
  [[nodiscard]] bool passes_in_front(const models::TileHit& tile);
  [[nodiscard]] std::size_t tile_number(const models::TileHit& tile) const;
  void note_direction(const DrawState& draw);

  const Params& params_;
  const Frame& frame_;
  const TriangleStore& triangles_;
  WalkedStore& walked_;
  const std::uint64_t sync_interval_;  ///< triangles between syncs
  Stats stats_;
  bool walking_ = false;
  std::unique_ptr<Traversal> traversal_;
  std::optional<Traversal::Tile> ahead_;  ///< the next tile of the triangle; none at its end
  Tick walked_until_ = 0;                 ///< the row of tiles that leaves next is walked by then
  std::uint64_t triangle_ = 0;            ///< being walked
  DrawId draw_;
  PassId pass_;
  bool hiz_usable_ = false;  ///< this draw may be tested
  bool hiz_trusted_ = true;  ///< no draw of the pass has raised depths
  std::uint64_t since_sync_ = 0;
  bool sync_due_ = false;
  std::vector<float> hiz_;      ///< by tile of the pass; empty when no draw of it tests depth
  std::vector<float> hiz_min_;  ///< likewise, and without `hiz_min`
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
