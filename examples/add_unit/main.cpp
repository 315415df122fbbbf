/// The unit of this folder behind our fine rasteriser, with a source and a sink; the cycles are those that
/// arithmetic gives.
#include <fmt/format.h>

#include "hw/base/dispatcher.h"
#include "hw/raster/fine_raster.h"
#include "tile_census.h"

namespace {

using namespace quadrille;

constexpr int kTiles = 100;

/// Hands the rasteriser tiles that are covered whole.
class Source final : public hw::Unit {
 public:
  Source(sc_core::sc_module_name name, const hw::Clock& clock) : Unit(name, Kind::kFixedOrder, clock) {}
  hw::FifoOut<hw::TileToken> out{*this, "out"};
  [[nodiscard]] hw::Wake next() const override {
    return sent_ == kTiles ? hw::Wake(hw::kNever) : hw::Wake().output(out);
  }
  void act(hw::Tick now) override {
    out.push(now, {.fully_covered = true, .tile_x = static_cast<std::uint16_t>(sent_)});
    ++sent_;
  }

 private:
  int sent_ = 0;
};

class Sink final : public hw::Unit {
 public:
  Sink(sc_core::sc_module_name name, const hw::Clock& clock) : Unit(name, Kind::kFixedOrder, clock) {}
  hw::FifoIn<hw::CoverageToken> in{*this, "in"};
  [[nodiscard]] hw::Wake next() const override { return hw::Wake().input(in); }
  void act(hw::Tick now) override {
    (void)in.pop(now);
    if (taken++ == 0) first = now;
    last = now;
  }
  int taken = 0;
  hw::Tick first = 0, last = 0;
};

}  // namespace

int sc_main(int /*count*/, char** /*arguments*/) {
  hw::Dispatcher driver("driver");
  const hw::Clock clock(1'000'000'000);
  const hw::Frame frame{.draws = std::vector<hw::DrawState>(1)};
  models::DeviceMemory memory;
  const hw::UnitContext context{clock, frame, memory, {}};
  const hw::TriangleStore triangles(1);
  const hw::WalkedStore walked(1);

  hw::FineRaster::Params raster_params;
  raster_params.quads_per_clk.set(4);  // a whole tile has 16 quads: one tile in four cycles
  hw::TileCensus::Params census_params;
  census_params.tiles_per_clk.set(0.125);  // one tile in eight cycles: the census is the limit
  Source source("source", clock);
  hw::FineRaster raster("fine_raster", context, raster_params, triangles, walked);
  hw::TileCensus census("tile_census", context, census_params);
  Sink sink("sink", clock);

  hw::Fifo<hw::TileToken> tiles("tiles", {.depth = 8});
  hw::Fifo<hw::CoverageToken> covered("covered", {.depth = 8});
  hw::Fifo<hw::CoverageToken> counted("counted", {.depth = 8});
  source.out.bind(tiles);
  raster.tile_in.bind(tiles);
  raster.coverage_out[0]->bind(covered);
  census.coverage_in.bind(covered);
  census.coverage_out.bind(counted);
  sink.in.bind(counted);
  for (hw::Unit* unit : {static_cast<hw::Unit*>(&source), static_cast<hw::Unit*>(&raster),
                         static_cast<hw::Unit*>(&census), static_cast<hw::Unit*>(&sink)})
    driver.add(*unit);

  driver.run({});
  const std::int64_t cycles = clock.edges_before(sink.last) - clock.edges_before(sink.first);
  fmt::print("{} tiles, {} of them full; {} cycles from the first to the last, {} by arithmetic\n",
             sink.taken, census.stats()->full.value(), cycles, 8 * (kTiles - 1));
  return sink.taken == kTiles && census.stats()->full.value() == kTiles && cycles == 8 * (kTiles - 1) ? 0 : 1;
}
