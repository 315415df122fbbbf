/// Fine rasteriser: finds the covered pixels of each tile, exactly, and hands the tile to the partition that
/// owns it.
///
/// In    tile_in          tiles of one triangle; boundaries
/// Out   coverage_out[p]  covered tiles of partition p; every boundary to every partition
/// Time  `quads_per_clk` covered quads a cycle, whatever their samples; at least one cycle a tile and covered
///       sample. A tile that was walked is not tested, so its quads cost nothing.
#pragma once

#include "hw/base/param.h"
#include "hw/base/unit.h"
#include "hw/base/work_rate.h"
#include "hw/frame/stores.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

namespace quadrille::hw {

class FineRaster final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> quads_per_clk{*this,      "quads_per_clk", 4,
                             "quad/clk", {1, 16},         "Covered quads a cycle. [G: 16 px/clk]"};
    Param<int> tiles_per_clk{*this,
                             "tiles_per_clk",
                             1,
                             "tile/clk",
                             {1, 64},
                             "Tiles a cycle whose quads would leave room for more; the links to the depth "
                             "units take link.fine_to_depth.width each. [G: one "
                             "raster engine]"};
  };
  struct Stats : StatGroup {
    Counter tiles{*this, "tiles", "tile", "Tiles taken in"};
    Counter tiles_empty{*this, "tiles_empty", "tile", "Tiles without a covered pixel"};
    Counter tiles_full{*this, "tiles_full", "tile", "Tiles with all samples of their 64 pixels covered"};
    Counter quads{*this, "quads", "quad", "Quads with a covered pixel"};
    Counter fragments{*this, "fragments", "fragment",
                      "Covered pixels; of several samples a pixel, covered samples"};
  };
  FineRaster(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
             const TriangleStore& triangles, const WalkedStore& walked);

  FifoIn<TileToken> tile_in{*this, "tile_in"};
  std::vector<std::unique_ptr<FifoOut<CoverageToken>>> coverage_out;

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;

 private:
  void rasterize(Tick now, const TileToken& tile);
  /// Finds what is covered of each sample, and the quads of which one is.
  [[nodiscard]] int cover(const TileToken& tile);
  [[nodiscard]] std::uint64_t coverage_of(const TileToken& tile, const models::SampleGrid& samples,
                                          int sample) const;
  void hand_on(Tick now);
  /// To the depth unit of the tile's partition.
  [[nodiscard]] FifoOut<CoverageToken>& output_of(std::uint32_t tile_x, std::uint32_t tile_y) const;

  const Params& params_;
  const Frame& frame_;
  const TriangleStore& triangles_;
  const WalkedStore& walked_;
  const models::ScreenShare screen_;
  Stats stats_;
  WorkRate rate_;
  std::array<CoverageToken, models::kMaxSamples> planes_;  ///< of the tile in work, by covered sample
  int next_plane_ = 0, plane_count_ = 0;
  std::int64_t quad_cost_ = 0;  ///< of its quads; the planes that are gone have paid some of it
  Tick free_ = 0;
};

}  // namespace quadrille::hw
