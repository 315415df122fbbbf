/// The coarse rasteriser with edge walking: closed forms of its cycles, what it hands on, and its counters.
#include "hw/raster/coarse_raster.h"
#include "tests/hw/bench_stub.h"
#include "tests/hw/raster/triangles.h"

#include "models/raster/fine.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr int kWidest = 4096;

using Corners = std::array<glm::ivec2, 3>;  ///< pixels

TriangleSlot slot_of(const Corners& corners, int samples) {
  std::array<models::WindowVertex, 3> vertices;
  for (std::size_t i = 0; i < 3; ++i) vertices[i] = {corners[i].x * 256, corners[i].y * 256, 0.5F, 1.0F};
  models::SetupState state;
  state.scissor = {0, 0, kWidest, kWidest};
  state.samples = models::sample_grid(samples, 8);
  TriangleSlot slot;
  slot.draw = DrawId(0);
  const auto outcome = models::setup_triangle(vertices, models::whole_triangle_weights(), state, slot.setup);
  QUADRILLE_CHECK(outcome == models::SetupOutcome::kKept, "the test's triangle is not kept");
  return slot;
}

struct WalkBench final : Bench {
  struct Setup {
    std::vector<Corners> shapes;  ///< of which `triangles` names numbers, one after the other
    std::vector<std::uint64_t> triangles{0};
    int rows = 1, segments = 2, setup_clk = 2, tiles = 1, tests = 4, samples = 1, engines = 1, engine = 0;
    std::int64_t from = 0;  ///< cycle of the first triangle
    std::vector<Timed<HiZToken>> hiz{};
    Pace pace{.from = 0, .period = 0};
    LinkSpec out{.depth = 64, .width = 8};
  };
  WalkBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), store(16), walked(static_cast<std::size_t>(s.out.depth)) {
    make_frame(s);
    for (std::size_t i = 0; i < s.shapes.size(); ++i) store[i] = slot_of(s.shapes[i], s.samples);
    params.traversal.set(kEdgeWalking);
    params.rows_per_clk.set(s.rows);
    params.segments_per_clk.set(s.segments);
    params.walk_setup_clk.set(s.setup_clk);
    params.tiles_per_clk.set(s.tiles);
    params.tests_per_clk.set(s.tests);
    params.reports.set(1);  // none among so few triangles
    unit = std::make_unique<CoarseRaster>(
        "unit", context({.partitions = s.engines, .engines = s.engines}, s.engine), params, store, walked);
    add(*unit);
    std::vector<Timed<TriangleToken>> script{{0, {TokenKind::kPassBegin, PassId(0), 0}}};
    for (const std::uint64_t number : s.triangles)
      script.push_back({s.from, {TokenKind::kWork, DrawId(0), number}});
    feed(unit->triangle_in, script);
    feed(unit->hiz_in[0], s.hiz);
    sink = &drain<TileToken>(
        unit->tile_out,
        [](const TileToken& t) { return t.kind == TokenKind::kWork ? 100u * t.tile_y + t.tile_x : 90000u; },
        s.pace, s.out);
  }
  void make_frame(const Setup& s) {
    PassState pass;
    pass.has_depth = true;
    pass.depth.surface = {0, kWidest, kWidest, kWidest / 8, kWidest / 8};
    pass.draws = 1;
    frame.passes = {pass};
    DrawState draw;
    draw.fragment.program = &program;
    draw.depth_stencil.depth_test = draw.depth_stencil.depth_write = true;
    draw.views[0].setup.samples = models::sample_grid(s.samples, 8);
    frame.draws.push_back(draw);
  }
  /// The tile's coverage, as its token names it.
  [[nodiscard]] const models::TileCoverage& coverage(const TileToken& tile) const {
    return walked[tile.walked];
  }
  /// Cycles from when the first triangle could be taken to the last tile.
  [[nodiscard]] double cycles(std::int64_t from) const {
    return static_cast<double>(sink->got.back().cycle - 1 - (from + 1));
  }
  models::Program program;
  CoarseRaster::Params params;
  TriangleStore store;
  WalkedStore walked;
  std::unique_ptr<CoarseRaster> unit;
  StubSink<TileToken>* sink = nullptr;
};

double cycles_of(WalkBench::Setup s) {
  s.from = 10;
  return std::stod(
      run<WalkBench>(s, [&](const WalkBench& b) { return fmt::format("{}", b.cycles(s.from)); }));
}
std::string counts_of(const WalkBench::Setup& s) {
  return run<WalkBench>(s, [](const WalkBench& b) {
    return fmt::format("parts {} rows {} spans {} segments {} tiles {}", counter(*b.unit, "walked_parts"),
                       counter(*b.unit, "rows"), counter(*b.unit, "spans"), counter(*b.unit, "segments"),
                       counter(*b.unit, "tiles_kept"));
  });
}
std::string tiles_of(const WalkBench::Setup& s) {
  return run<WalkBench>(s, [](const WalkBench& b) { return b.sink->text(); });
}

}  // namespace

TEST_CASE("edge_walking: a right triangle of h rows takes h^2 / 32 + h / 4 cycles at two tiles a cycle") {
  // The right angle is above on the left: row y has h - y pixels. A row of n tiles takes n / 2 cycles, at
  // least one, and there are eight such rows for each n.
  for (const int h : {256, 512, 1024})
    CHECK(cycles_of({.shapes = {{{{0, 0}, {0, h}, {h, 0}}}}}) ==
          Approx(h * h / 32.0 + h / 4.0).epsilon(0.02));
}

TEST_CASE("edge_walking: a row of tiles takes the longest of its rows, its spans and the tiles that leave") {
  // Eight rows each of 32 tiles, 31, and so on to 1. While n tiles leave, the rows of n - 1 are walked.
  const Corners left{{{0, 0}, {0, 256}, {256, 0}}};
  for (const auto& [r, s, t] : {std::tuple{1, 16, 16}, {1, 1, 16}, {4, 16, 16}, {16, 16, 1}, {16, 16, 4}}) {
    const auto walk = [r = r, s = s](int n) {
      return n == 0 ? 0.0 : std::ceil(8 * std::max(1.0 / r, static_cast<double>(n) / s));
    };
    double expected = 2 + walk(32);
    for (int n = 32; n > 0; --n) expected += std::max(walk(n - 1), static_cast<double>(n) / t);
    CHECK(cycles_of({.shapes = {left}, .rows = r, .segments = s, .tiles = t, .tests = 64}) ==
          Approx(expected).epsilon(0.02));
  }
}

TEST_CASE("edge_walking: of a long sliver that lies, the spans are walked first and then its tiles leave") {
  // Centres of its first row are covered up to x = 3072, of its second up to 1024.
  const Corners lying{{{0, 0}, {4096, 0}, {0, 2}}};
  const double walk = 2 + (384 + 128) / 2.0;
  CHECK(cycles_of({.shapes = {lying}}) == Approx(walk + 384).epsilon(0.02));
  CHECK(cycles_of({.shapes = {lying}, .tiles = 4, .tests = 64}) == Approx(walk + 96).epsilon(0.02));
}

TEST_CASE("edge_walking: of many that lie, the next one is walked while the tiles of one leave") {
  const Corners lying{{{0, 0}, {4096, 0}, {0, 2}}};
  const std::vector<std::uint64_t> many(40, 0);
  CHECK(cycles_of({.shapes = {lying}, .triangles = many}) == Approx(40 * 384 + 258).epsilon(0.02));
  CHECK(cycles_of({.shapes = {lying}, .triangles = many, .tiles = 4, .tests = 64}) ==
        Approx(40 * 258 + 96).epsilon(0.02));
}

TEST_CASE("edge_walking: of a long sliver that stands, each row takes its turn, covered or not") {
  // Centres are covered down to row 3072; the last rows are walked before the next triangle.
  const Corners standing{{{0, 0}, {2, 0}, {0, 4096}}};
  for (const auto& [rows, segments, each] : {std::tuple{1, 2, 1.0}, {4, 2, 0.5}, {4, 4, 0.25}}) {
    // a span is a tile, so it takes its turn among those too
    const double covered = 3072 * each, rest = 1024.0 / rows;
    CHECK(cycles_of({.shapes = {standing}, .rows = rows, .segments = segments}) ==
          Approx(2 + covered).epsilon(0.02));
    CHECK(cycles_of({.shapes = {standing}, .triangles = {0, 0, 0}, .rows = rows, .segments = segments}) ==
          Approx(3 * (2 + covered) + 2 * rest).epsilon(0.02));
  }
}

TEST_CASE("edge_walking: many small triangles take set-up of their parts and their rows each") {
  // Of the first, the second row's only centre lies on the right edge, so it has no tile.
  const Corners corner{{{0, 0}, {0, 2}, {2, 0}}}, two_parts{{{1, 1}, {6, 4}, {3, 7}}};
  const std::vector<std::uint64_t> many(1000, 0);
  for (const int setup : {1, 2, 7}) {
    CHECK(cycles_of({.shapes = {corner}, .triangles = many, .setup_clk = setup}) ==
          Approx(1000 * (setup + 2)).epsilon(0.02));
    CHECK(cycles_of({.shapes = {two_parts}, .triangles = many, .setup_clk = setup}) ==
          Approx(1000 * (2 * setup + 6)).epsilon(0.02));
  }
  CHECK(cycles_of({.shapes = {two_parts}, .triangles = many, .setup_clk = 1, .samples = 4}) ==
        Approx(1000 * 4 * (2 + 6)).epsilon(0.02));
}

TEST_CASE("edge_walking: tiles leave when the rows of their row of tiles are walked, from left to right") {
  // Set-up and eight rows take ten cycles from cycle 11 on; meanwhile nothing leaves. The next eight rows are
  // walked by cycle 29.
  const WalkBench::Setup s{.shapes = {{{{0, 0}, {0, 16}, {16, 0}}}}, .from = 10};
  CHECK(tiles_of(s) == "2:90000 22:0 23:1 30:100");
}

TEST_CASE("edge_walking: while tile_out is full the next row of tiles is walked") {
  // There is room for one tile beside the boundary. When the sink takes both, what is left is ready.
  const WalkBench::Setup s{.shapes = {{{{0, 0}, {0, 16}, {16, 0}}}},
                           .from = 10,
                           .pace = {.from = 100, .period = 1},
                           .out = {.depth = 2}};
  CHECK(tiles_of(s) == "100:90000 101:0 102:1 103:100");
}

TEST_CASE("edge_walking: counts parts, rows, spans and the tiles that they cross") {
  const Corners right{{{0, 0}, {0, 16}, {16, 0}}}, two_parts{{{1, 1}, {6, 4}, {3, 7}}};
  // Rows of 15 to 0 pixels: seven lie in two tiles, eight in one.
  CHECK(counts_of({.shapes = {right}}) == "parts 1 rows 16 spans 15 segments 22 tiles 3");
  CHECK(counts_of({.shapes = {two_parts}}) == "parts 2 rows 6 spans 5 segments 5 tiles 1");
  CHECK(counts_of({.shapes = {two_parts}, .samples = 4}).starts_with("parts 8 rows 24 "));
}

TEST_CASE("edge_walking: a token names the coverage that edge functions find") {
  for (const int samples : {1, 4}) {
    const auto text = run<WalkBench>(
        {.shapes = {{{{3, 1}, {61, 30}, {9, 55}}}}, .samples = samples}, [&](const WalkBench& b) {
          const models::SampleGrid grid = models::sample_grid(samples, 8);
          std::size_t right = 0, tiles = 0;
          for (const auto& [cycle, tile] : b.sink->got) {
            if (tile.kind != TokenKind::kWork) continue;
            ++tiles;
            bool same = true, full = true;
            for (int s = 0; s < samples; ++s) {
              const std::uint64_t mask =
                  models::sample_coverage(b.store[0].setup, tile.tile_x, tile.tile_y, grid, s);
              same = same && b.coverage(tile)[static_cast<std::size_t>(s)] == mask;
              full = full && ~mask == 0;
            }
            right += same && tile.fully_covered == full ? 1 : 0;
          }
          return fmt::format("{} {}", tiles > 20, right == tiles);
        });
    CHECK(text == "true true");
  }
}

TEST_CASE("edge_walking: every engine walks all rows, and gathers the tiles that are its own") {
  const Corners large{{{0, 0}, {0, 256}, {256, 0}}};
  const std::string alone = counts_of({.shapes = {large}});
  std::uint64_t segments = 0, tiles = 0;
  for (int engine = 0; engine < 2; ++engine) {
    const std::string text =
        run<WalkBench>({.shapes = {large}, .engines = 2, .engine = engine}, [](const WalkBench& b) {
          return fmt::format("{} {} {}", counter(*b.unit, "rows"), counter(*b.unit, "segments"),
                             counter(*b.unit, "tiles_kept"));
        });
    CHECK(text.starts_with("256 "));
    std::size_t end = 0;
    segments += std::stoul(text.substr(4), &end);
    tiles += std::stoul(text.substr(4 + end));
  }
  CHECK(alone == fmt::format("parts 1 rows 256 spans 255 segments {} tiles {}", segments, tiles));
}

TEST_CASE("edge_walking: a tile that Hi-Z hides is dropped after its rows were walked") {
  const HiZToken update{0, 0, PassId(0), 0.25F};
  const WalkBench::Setup s{.shapes = {{{{0, 0}, {0, 16}, {16, 0}}}}, .from = 10, .hiz = {{5, update}}};
  CHECK(tiles_of(s) == "2:90000 22:1 30:100");
  const auto counts = run<WalkBench>(s, [](const WalkBench& b) {
    return fmt::format("{} hidden, {} tested", counter(*b.unit, "tiles_hidden"),
                       counter(*b.unit, "tiles_tested"));
  });
  CHECK(counts == "1 hidden, 3 tested");
}

TEST_CASE("edge_walking: rows of tiles that are hidden whole take the time of their walk") {
  std::vector<Timed<HiZToken>> all;
  for (std::uint16_t y = 0; y < 4; ++y)
    for (std::uint16_t x = 0; x < 4; ++x)
      if (x != 0 || y != 3) all.push_back({5, {x, y, PassId(0), 0.25F}});  // the last tile is shown
  const WalkBench::Setup s{.shapes = {{{{0, 0}, {0, 32}, {32, 0}}}}, .from = 20, .hiz = all};
  // Eight rows each of 4, 3, 2 and 1 tiles take 16, 12, 8 and 8 cycles behind two of set-up.
  const std::string text = tiles_of(s);
  CHECK(text == "2:90000 68:300");
}

TEST_CASE("edge_walking: keeps the contract, one-deep links included") {
  const WalkBench::Setup s{
      .shapes = {{{{0, 0}, {0, 40}, {40, 0}}}, {{{1, 1}, {6, 4}, {3, 7}}}, {{{0, 0}, {50, 0}, {0, 2}}}},
      .triangles = {0, 1, 2, 1, 0, 2},
      .pace = {.from = 0, .period = 3},
      .out = {.depth = 8}};
  CHECK(contract_text<WalkBench>(s) == "");
}
