/// Fine rasteriser: cycles of a tile, empty tiles, boundaries, back-pressure.
#include "hw/raster/fine_raster.h"
#include "tests/hw/bench_stub.h"
#include "tests/hw/raster/triangles.h"

#include "models/raster/fine.h"

#include <catch2/catch.hpp>

#include <bit>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

TileToken tile(int x, int y, bool full = false, std::uint64_t triangle = 0) {
  return {TokenKind::kWork, full,    static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
          DrawId(0),        triangle};
}

struct FineBench final : Bench {
  struct Setup {
    std::vector<Timed<TileToken>> tiles;
    int rate = 4, tiles_per_clk = 1, samples = 1;
    int partitions = 1;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  FineBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v), store(4) {
    // Triangle 0 has its right angle at (0, 0) and legs of 32 pixels; 1 covers the pixels of one column of a
    // tile.
    store[0] = flat_triangle({glm::ivec2{0, 0}, {0, 32}, {32, 0}});
    store[1] = flat_triangle({glm::ivec2{0, 0}, {0, 8}, {1, 0}});
    models::TileCoverage part{0xf00f, 0, 1}, all;
    all.fill(~std::uint64_t{0});
    QUADRILLE_CHECK(walked.put(part) == kFirstWalked && walked.put(all) == kFirstWalked + 1, "other places");
    frame.draws.resize(1);
    frame.draws[0].views[0].setup.samples = models::sample_grid(s.samples, 8);
    params.quads_per_clk.set(s.rate);
    params.tiles_per_clk.set(s.tiles_per_clk);
    unit = std::make_unique<FineRaster>("unit", context({.partitions = s.partitions}), params, store, walked);
    add(*unit);
    feed(unit->tile_in, s.tiles);
    for (auto& out : unit->coverage_out) {
      sinks.push_back(&drain<CoverageToken>(
          *out,
          [](const CoverageToken& t) {
            return t.kind == TokenKind::kWork ? t.tile_x : 900u + static_cast<unsigned>(t.kind);
          },
          s.pace, s.out));
    }
  }
  static constexpr std::uint32_t kFirstWalked = 1;
  FineRaster::Params params;
  TriangleStore store;
  WalkedStore walked{64};
  std::unique_ptr<FineRaster> unit;
  std::vector<StubSink<CoverageToken>*> sinks;
};

/// Visible to the unit at cycle 1, one after the other.
FineBench::Setup tiles_of(const std::vector<TileToken>& tokens, int rate = 4) {
  FineBench::Setup s;
  for (const TileToken& t : tokens) s.tiles.push_back({0, t});
  s.rate = rate;
  return s;
}

std::uint64_t counter(const FineBench& b, std::size_t i) { return b.unit->stats()->counters()[i]->value(); }

}  // namespace

TEST_CASE("fine_raster: a tile keeps it for its covered quads divided by the rate, rounded up") {
  for (const auto& [rate, cycles] : {std::pair{1, 16}, {3, 6}, {4, 4}, {16, 1}}) {
    const auto text = run<FineBench>(tiles_of({tile(0, 0, true), tile(1, 0, true), tile(2, 0, true)}, rate),
                                     [](const FineBench& b) { return b.sinks[0]->text(); });
    CHECK(text == fmt::format("2:0 {}:1 {}:2", 2 + cycles, 2 + 2 * cycles));
  }
}

TEST_CASE("fine_raster: n tiles of few quads take n over tiles_per_clk, and no less than their quads take") {
  // Triangle 1 covers the four pixels of the column whose centres lie under its hypotenuse: two quads.
  for (const auto& [rate, tiles, each] :
       {std::tuple{16, 1, 1.0}, {16, 2, 0.5}, {16, 4, 0.25}, {16, 8, 0.125}, {8, 4, 0.25}, {2, 4, 1.0}}) {
    auto s = tiles_of(std::vector<TileToken>(400, tile(0, 0, false, 1)), rate);
    s.tiles_per_clk = tiles;
    s.pace = {.from = 0, .period = 0};
    s.out = {.depth = 64, .width = 8};
    const auto last = std::stod(run<FineBench>(
        s, [](const FineBench& b) { return fmt::format("{}", b.sinks[0]->got.back().cycle); }));
    CHECK(last == Approx(400 * each).epsilon(0.02));
  }
}

TEST_CASE("fine_raster: a tile with quads on its edge costs only those that are covered") {
  // Tile (3, 0) lies under the hypotenuse from (24, 8) to (32, 0): pixels with x + y < 31, so quads in 4 + 3
  // + 2 + 1 = 10 places.
  const auto text = run<FineBench>(tiles_of({tile(3, 0), tile(0, 0, true)}), [](const FineBench& b) {
    return fmt::format("{} quads {} fragments {}", b.sinks[0]->text(), counter(b, 3) - 16,
                       counter(b, 4) - 64);
  });
  CHECK(text == "2:3 5:0 quads 10 fragments 28");
}

TEST_CASE("fine_raster: a tile sends a token for each sample, one a cycle, while its quads are worked on") {
  // A full tile of sixteen quads: as many cycles as its quads take, or as it has samples, whichever is more.
  for (const auto& [samples, rate, cycles] :
       {std::tuple{4, 4, 4}, {4, 16, 4}, {4, 1, 16}, {2, 4, 4}, {8, 4, 8}}) {
    auto s = tiles_of({tile(0, 0, true), tile(1, 0, true)}, rate);
    s.samples = samples;
    std::string expected;
    for (int i = 0; i < samples; ++i) expected += fmt::format("{}{}:0", i == 0 ? "" : " ", 2 + i);
    for (int i = 0; i < samples; ++i) expected += fmt::format(" {}:1", 2 + cycles + i);
    CHECK(run<FineBench>(s, [](const FineBench& b) { return b.sinks[0]->text(); }) == expected);
  }
}

TEST_CASE("fine_raster: samples that are not covered send nothing, and the last token says so") {
  // Triangle 1 ends a column of pixels before it: of four samples the two on its left are under it.
  auto s = tiles_of({tile(0, 0, false, 1)}, 16);
  s.samples = 4;
  const auto text = run<FineBench>(s, [](const FineBench& b) {
    std::string all;
    for (const auto& t : b.sinks[0]->got)
      all += fmt::format("{}{}{} ", t.token.sample, t.token.first ? "f" : "", t.token.last ? "l" : "");
    return all + fmt::format("{}", counter(b, 4));
  });
  const models::SampleGrid grid = models::sample_grid(4, 8);
  std::uint64_t covered = 0;
  TriangleSlot slot = flat_triangle({glm::ivec2{0, 0}, {0, 8}, {1, 0}});
  std::string expected;
  std::vector<int> samples;
  for (int i = 0; i < 4; ++i) {
    const std::uint64_t mask = models::sample_coverage(slot.setup, 0, 0, grid, i);
    covered += static_cast<std::uint64_t>(std::popcount(mask));
    if (mask != 0) samples.push_back(i);
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
    expected += fmt::format("{}{}{} ", samples[i], i == 0 ? "f" : "", i + 1 == samples.size() ? "l" : "");
  CHECK(text == expected + fmt::format("{}", covered));
}

TEST_CASE(
    "fine_raster: a tile that was walked takes a cycle a covered sample, and what the walk found is "
    "covered") {
  // Sixteen quads at one a cycle would take sixteen. The store holds masks that no test of edges would give.
  for (const int samples : {1, 4}) {
    TileToken first = tile(0, 0), second = tile(1, 0);
    first.walked = FineBench::kFirstWalked;
    second.walked = FineBench::kFirstWalked + 1;
    auto s = tiles_of({first, second, tile(2, 0, true)}, 1);
    s.samples = samples;
    const auto text = run<FineBench>(s, [](const FineBench& b) {
      std::string all = b.sinks[0]->text();
      for (const auto& [cycle, token] : b.sinks[0]->got) all += fmt::format(" {:x}", token.coverage);
      return all;
    });
    const std::string full = "ffffffffffffffff";
    if (samples == 1) CHECK(text == fmt::format("2:0 3:1 4:2 f00f {} {}", full, full));
    else
      CHECK(text ==
            fmt::format("2:0 3:0 4:1 5:1 6:1 7:1 8:2 9:2 10:2 11:2 f00f 1 {0} {0} {0} {0} {0} {0} {0} {0}",
                        full));
  }
}

TEST_CASE("fine_raster: an empty tile costs a cycle and goes no further") {
  const auto text =
      run<FineBench>(tiles_of({tile(7, 7), tile(7, 6), tile(1, 0, true)}), [](const FineBench& b) {
        return fmt::format("{} tiles {} empty {} full {}", b.sinks[0]->text(), counter(b, 0), counter(b, 1),
                           counter(b, 2));
      });
  CHECK(text == "4:1 tiles 3 empty 2 full 1");
}

TEST_CASE("fine_raster: stops while coverage_out is full, and goes on the cycle its room comes back") {
  auto setup = tiles_of({tile(0, 0, true), tile(1, 0, true), tile(2, 0, true), tile(3, 0, true)}, 16);
  setup.out = {.depth = 2};
  setup.pace = {.from = 50, .period = 10};
  // Two tiles wait in the link; each pop gives room one cycle later, and the tile that takes it is there
  // before the sink looks again.
  const auto text = run<FineBench>(setup, [](const FineBench& b) {
    return fmt::format("{} blocked {}", b.sinks[0]->text(), b.unit->blocked_cycles());
  });
  CHECK(text == "50:0 60:1 70:2 80:3 blocked 57");  // 3..51 and 52..61
}

TEST_CASE("fine_raster: tiles go to the partition that owns them, boundaries to all in one cycle") {
  FineBench::Setup setup = tiles_of({tile(0, 0, true),
                                     tile(1, 0, true),
                                     {TokenKind::kDrawEnd, false, 0, 0, DrawId(0), 0},
                                     tile(0, 1, true),
                                     tile(1, 1, true)},
                                    16);
  setup.partitions = 2;
  const auto text = run<FineBench>(
      setup, [](const FineBench& b) { return b.sinks[0]->text() + " | " + b.sinks[1]->text(); });
  CHECK(text == "2:0 4:902 5:0 | 3:1 4:902 6:1");
}

TEST_CASE("fine_raster: keeps the contract, one-deep links included") {
  auto setup = tiles_of({tile(0, 0),
                         tile(1, 0),
                         tile(0, 0, false, 1),
                         tile(7, 7),
                         {TokenKind::kSync, false, 0, 0, DrawId(0), 1},
                         tile(2, 1),
                         tile(1, 2)},
                        2);
  setup.partitions = 2;
  setup.pace = {.from = 0, .period = 3};
  CHECK(contract_text<FineBench>(setup) == "");
}
