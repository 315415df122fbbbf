#include "tile_census.h"

#include <bit>

#include "models/raster/fine.h"

namespace quadrille::hw {

TileCensus::TileCensus(sc_core::sc_module_name name, const UnitContext& context, const Params& params)
    : Unit(name, Kind::kFixedOrder, context.clock), params_(params), rate_(context.clock) {
  // doubling this parameter doubles the rate: the limit of a frame is found from that
  add_initiation_rate("tiles_per_clk");
}

Wake TileCensus::next() const { return Wake(free_).input(coverage_in).output(coverage_out); }

void TileCensus::act(Tick now) {
  const CoverageToken tile = coverage_in.pop(now);
  if (tile.kind == TokenKind::kWork) {
    const int quads = std::popcount(models::quads_of(tile.coverage));
    ++(quads == 16 ? stats_.full : quads > 4 ? stats_.middle : stats_.small);
  }
  coverage_out.push(now, tile);
  free_ = rate_.charge(now, WorkRate::cost(params_.tiles_per_clk));
  occupy(now, rate_.cycles());
}

std::vector<Facet> TileCensus::row() const {
  const std::uint64_t tiles = stats_.small.value() + stats_.middle.value() + stats_.full.value();
  return {share("small", stats_.small, tiles), share("middle", stats_.middle, tiles),
          share("full", stats_.full, tiles)};
}

}  // namespace quadrille::hw
