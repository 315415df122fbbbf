/// Tile census: counts tiles by how many of their 16 quads are covered, and passes them on.
///
/// In    coverage_in    tiles with their coverage; markers      Out   coverage_out   the same
/// Time  `tiles_per_clk` tiles a cycle
#pragma once

#include "hw/base/fifo.h"
#include "hw/base/param.h"
#include "hw/base/unit.h"
#include "hw/base/work_rate.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

namespace quadrille::hw {

class TileCensus final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<double> tiles_per_clk{*this,     "tiles_per_clk",
                                1,         "tile/clk",
                                {0.01, 1}, "Tiles counted a cycle. [G: as the fine rasteriser]"};
  };
  struct Stats : StatGroup {
    Counter small{*this, "small", "tile", "Tiles with one to four covered quads"};
    Counter middle{*this, "middle", "tile", "Tiles with five to fifteen covered quads"};
    Counter full{*this, "full", "tile", "Tiles whose sixteen quads are all covered"};
  };
  TileCensus(sc_core::sc_module_name name, const UnitContext& context, const Params& params);

  FifoIn<CoverageToken> coverage_in{*this, "coverage_in"};
  FifoOut<CoverageToken> coverage_out{*this, "coverage_out"};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  [[nodiscard]] std::vector<Facet> row() const override;

 private:
  const Params& params_;
  Stats stats_;
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
