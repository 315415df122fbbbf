#include "hw/raster/fine_raster.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "models/memory/interleave.h"
#include "models/raster/fine.h"

#include <bit>

namespace quadrille::hw {

FineRaster::FineRaster(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                       const TriangleStore& triangles, const WalkedStore& walked)
    : Unit(name, Kind::kFixedOrder, context.clock),
      params_(params),
      frame_(context.frame),
      triangles_(triangles),
      walked_(walked),
      screen_(context.machine.screen()),
      rate_(context.clock) {
  add_initiation_rate("quads_per_clk");
  for (int i = 0; i < context.machine.partitions_of_engine(); ++i) {
    coverage_out.push_back(
        std::make_unique<FifoOut<CoverageToken>>(*this, fmt::format("coverage_out_{}", i).c_str()));
  }
}

Wake FineRaster::next() const {
  if (next_plane_ < plane_count_) {
    const CoverageToken& plane = planes_[static_cast<std::size_t>(next_plane_)];
    return Wake(free_).output(output_of(plane.tile_x, plane.tile_y));
  }
  Wake wake = Wake(free_).input(tile_in);
  if (tile_in.ready() == kNever) return wake;
  const TileToken& tile = tile_in.front();
  if (tile.kind == TokenKind::kWork) { return wake.output(output_of(tile.tile_x, tile.tile_y)); }
  for (const auto& out : coverage_out) wake.output(*out);
  return wake;
}

FifoOut<CoverageToken>& FineRaster::output_of(std::uint32_t tile_x, std::uint32_t tile_y) const {
  return *coverage_out[models::partition_of(tile_x, tile_y, screen_.partitions).index() / screen_.engines];
}

void FineRaster::act(Tick now) {
  if (next_plane_ < plane_count_) {
    const CoverageToken& plane = planes_[static_cast<std::size_t>(next_plane_)];
    stats_.working_for(plane.part.draw());
    return hand_on(now);
  }
  const TileToken tile = tile_in.pop(now);
  stats_.working_for(tile.part.draw());
  if (tile.kind == TokenKind::kWork) return rasterize(now, tile);
  for (auto& out : coverage_out) out->push(now, {tile.kind, false, 0, 0, tile.part, tile.triangle, 0});
  free_ = rate_.charge(now, WorkRate::kCycle);
  occupy(now, rate_.cycles());
}

std::uint64_t FineRaster::coverage_of(const TileToken& tile, const models::SampleGrid& samples,
                                      int sample) const {
  if (tile.fully_covered) return ~std::uint64_t{0};
  if (tile.walked != TileToken::kNotWalked) return walked_[tile.walked][static_cast<std::size_t>(sample)];
  return models::sample_coverage(triangles_[tile.triangle].setup, tile.tile_x, tile.tile_y, samples, sample);
}

int FineRaster::cover(const TileToken& tile) {
  const DrawState& draw = frame_.draw(tile.part.draw());
  const models::SampleGrid& samples = draw.samples();
  next_plane_ = plane_count_ = 0;
  std::uint64_t any = 0, all = ~std::uint64_t{0};
  for (int s = 0; s < samples.count; ++s) {
    const std::uint64_t coverage = draw.covers(s) ? coverage_of(tile, samples, s) : 0;
    any |= coverage;
    all &= coverage;
    stats_.fragments += static_cast<std::uint64_t>(std::popcount(coverage));
    if (coverage == 0) continue;
    planes_[static_cast<std::size_t>(plane_count_)] = {
        TokenKind::kWork,  false,         tile.tile_x,  tile.tile_y,
        tile.part,         tile.triangle, coverage,     static_cast<std::uint8_t>(s),
        plane_count_ == 0, false,         tile.in_front};
    ++plane_count_;
  }
  if (plane_count_ > 0) planes_[static_cast<std::size_t>(plane_count_ - 1)].last = true;
  if (any == 0) ++stats_.tiles_empty;
  if (~all == 0) ++stats_.tiles_full;
  return std::popcount(models::quads_of(any));
}

void FineRaster::rasterize(Tick now, const TileToken& tile) {
  const int quads = cover(tile);
  ++stats_.tiles;
  stats_.quads += static_cast<std::uint64_t>(quads);
  quad_cost_ = tile.walked == TileToken::kNotWalked ? WorkRate::cost_of(quads, params_.quads_per_clk) : 0;
  if (plane_count_ > 0) return hand_on(now);
  free_ = rate_.charge(now, WorkRate::cost(params_.tiles_per_clk));
  occupy(now, rate_.cycles());
}

/// Planes leave one by one while the quads are worked on: the last one pays for what is left of that.
void FineRaster::hand_on(Tick now) {
  const CoverageToken& plane = planes_[static_cast<std::size_t>(next_plane_++)];
  const std::int64_t least = WorkRate::cost(params_.tiles_per_clk);
  const std::int64_t cost = plane.last ? std::max(least, quad_cost_) : least;
  quad_cost_ -= cost;
  output_of(plane.tile_x, plane.tile_y).push(now, plane);
  free_ = rate_.charge(now, cost);
  occupy(now, rate_.cycles());
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
