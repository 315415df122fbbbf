#include "hw/raster/fine_raster.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "models/memory/interleave.h"
#include "models/raster/fine.h"

#include <bit>

namespace quadrille::hw {

FineRaster::FineRaster(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                       const TriangleStore& triangles)
    : Unit(name, Kind::kFixedOrder, context.clock),
      params_(params),
      triangles_(triangles),
      screen_(context.machine.screen()),
      rate_(context.clock) {
  add_initiation_rate("quads_per_clk");
  for (int i = 0; i < context.machine.partitions_of_engine(); ++i) {
    coverage_out.push_back(
        std::make_unique<FifoOut<CoverageToken>>(*this, fmt::format("coverage_out_{}", i).c_str()));
  }
}

Wake FineRaster::next() const {
  Wake wake = Wake(free_).input(tile_in);
  if (tile_in.ready() == kNever) return wake;
  const TileToken& tile = tile_in.front();
  if (tile.kind == TokenKind::kWork) { return wake.output(output_of(tile)); }
  for (const auto& out : coverage_out) wake.output(*out);
  return wake;
}

FifoOut<CoverageToken>& FineRaster::output_of(const TileToken& tile) const {
  return *coverage_out[models::partition_of(tile.tile_x, tile.tile_y, screen_.partitions).index() /
                       screen_.engines];
}

void FineRaster::act(Tick now) {
  const TileToken tile = tile_in.pop(now);
  stats_.working_for(tile.part.draw());
  if (tile.kind == TokenKind::kWork) return rasterize(now, tile);
  for (auto& out : coverage_out) out->push(now, {tile.kind, false, 0, 0, tile.part, tile.triangle, 0});
  free_ = rate_.charge(now, WorkRate::kCycle);
  occupy(now, rate_.cycles());
}

void FineRaster::rasterize(Tick now, const TileToken& tile) {
  const std::uint64_t coverage =
      tile.fully_covered ? ~std::uint64_t{0}
                         : models::tile_coverage(triangles_[tile.triangle].setup, tile.tile_x, tile.tile_y);
  const int quads = std::popcount(models::quads_of(coverage));
  ++stats_.tiles;
  if (coverage == 0) ++stats_.tiles_empty;
  if (~coverage == 0) ++stats_.tiles_full;
  stats_.quads += static_cast<std::uint64_t>(quads);
  stats_.fragments += static_cast<std::uint64_t>(std::popcount(coverage));
  free_ = rate_.charge(
      now, std::max(WorkRate::cost(params_.tiles_per_clk), WorkRate::cost_of(quads, params_.quads_per_clk)));
  occupy(now, rate_.cycles());
  if (coverage == 0) return;
  output_of(tile).push(
      now, {TokenKind::kWork, false, tile.tile_x, tile.tile_y, tile.part, tile.triangle, coverage});
}

void FineRaster::audit(Audit& audit) const {
  audit.right(laws::kTiles, stats_.tiles.value());
  audit.left(laws::kFragmentsCovered, stats_.fragments.value());
  audit.left(laws::kFragmentsDeferredOrNot, stats_.fragments.value());
}

void FineRaster::details(Details& details) const { details.by_draw(DrawCount::kCovered, stats_.fragments); }

std::vector<Facet> FineRaster::row() const {
  return {rate("quads", stats_.quads, params_.quads_per_clk),
          mean("fragments/quad", stats_.fragments, stats_.quads),
          mean("quads/tile", stats_.quads, stats_.tiles),
          share("full tiles", stats_.tiles_full, stats_.tiles)};
}

}  // namespace quadrille::hw
