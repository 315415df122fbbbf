/// Coarse rasteriser: cycles of a walk, Hi-Z and when it may be trusted, syncs.
#include "hw/raster/coarse_raster.h"
#include "tests/hw/bench_stub.h"
#include "tests/hw/raster/triangles.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr std::uint64_t kBoundary = 900;

struct CoarseBench final : Bench {
  struct Setup {
    std::vector<Timed<TriangleToken>> triangles;
    std::vector<Timed<HiZToken>> hiz{};
    int rate = 4, tiles_per_clk = 1, reports = 8;
    Pace pace{};
    LinkSpec out{.depth = 64};
    bool use_hiz = true, use_least = false;
    std::size_t store_slots = 64;
  };
  CoarseBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), store(s.store_slots) {
    make_frame();
    // Sequence numbers: 0 is in the two tiles (0, 0) and (1, 0); 1 lies in tile (0, 0) alone; 2 the same but
    // nearer; 3 like 1, farther; 4 like 1, of draw 1.
    store[0] = flat_triangle({glm::ivec2{0, 0}, {0, 4}, {12, 0}});
    store[1] = flat_triangle({glm::ivec2{0, 0}, {0, 4}, {4, 0}});
    store[2] = flat_triangle({glm::ivec2{0, 0}, {0, 4}, {4, 0}}, 0.25f);
    store[3] = flat_triangle({glm::ivec2{0, 0}, {0, 4}, {4, 0}}, 0.75f);
    store[4] = flat_triangle({glm::ivec2{0, 0}, {0, 4}, {4, 0}}, 0.75f, 1);
    params.tests_per_clk.set(s.rate);
    params.tiles_per_clk.set(s.tiles_per_clk);
    params.reports.set(s.reports);
    params.hiz.set(s.use_hiz);
    params.hiz_min.set(s.use_least);
    unit = std::make_unique<CoarseRaster>("unit", context(), params, store, walked);
    add(*unit);
    feed(unit->triangle_in, s.triangles);
    feed(unit->hiz_in[0], s.hiz);
    sink = &drain<TileToken>(
        unit->tile_out,
        [](const TileToken& t) {
          return t.kind == TokenKind::kWork ? 10 * t.triangle + t.tile_x
                                            : kBoundary + static_cast<std::uint64_t>(t.kind);
        },
        s.pace, s.out);
  }
  void make_frame() {
    PassState pass;
    pass.has_depth = true;
    pass.depth.surface = {0, 64, 64, 8, 8};
    pass.draws = 4;
    frame.passes = {pass};
    // Draws 0 and 2 write with "less", 1 writes with "greater", 3 only tests with "greater".
    for (const models::CompareOp op : {models::CompareOp::kLess, models::CompareOp::kGreater,
                                       models::CompareOp::kLess, models::CompareOp::kGreater}) {
      DrawState draw;
      draw.fragment.program = &program;
      draw.depth_stencil.depth_test = true;
      draw.depth_stencil.depth_write = frame.draws.size() != 3;
      draw.depth_stencil.depth_compare = op;
      frame.draws.push_back(draw);
    }
  }
  models::Program program;
  CoarseRaster::Params params;
  TriangleStore store;
  WalkedStore walked{64};
  std::unique_ptr<CoarseRaster> unit;
  StubSink<TileToken>* sink = nullptr;
};

TriangleToken triangle(std::uint64_t sequence, std::uint32_t draw = 0) {
  return {TokenKind::kWork, DrawId(draw), sequence};
}
const TriangleToken kBegin{TokenKind::kPassBegin, PassId(0), 0};

std::uint64_t counter(const CoarseBench& b, std::size_t i) { return b.unit->stats()->counters()[i]->value(); }
std::string tiles(const CoarseBench::Setup& setup) {
  return run<CoarseBench>(setup, [](const CoarseBench& b) { return b.sink->text(); });
}

}  // namespace

TEST_CASE("coarse_raster: one tile a cycle, from one triangle to the next") {
  CoarseBench::Setup s{.triangles = {{0, kBegin}, {0, triangle(0)}, {0, triangle(1)}, {0, triangle(1)}}};
  // Boundary at 1; tiles of the first triangle at 2 and 3, the only ones of the others at 4 and 5; all are
  // seen a cycle later.
  CHECK(tiles(s) == "2:903 3:0 4:1 5:10 6:10");
}

TEST_CASE(
    "coarse_raster: n triangles of one tile take n over tiles_per_clk, and no less than their tests take") {
  for (const auto& [rate, tiles] : {std::pair{4, 1}, {4, 2}, {4, 4}, {2, 4}, {64, 8}}) {
    CoarseBench::Setup s{.triangles = {{0, kBegin}},
                         .rate = rate,
                         .tiles_per_clk = tiles,
                         .reports = 1,
                         .pace = {.from = 0, .period = 0},
                         .out = {.depth = 64, .width = 8},
                         .store_slots = 4096};
    for (int i = 0; i < 4000; ++i) s.triangles.push_back({0, triangle(1)});
    const auto text = run<CoarseBench>(s, [](const CoarseBench& b) {
      return fmt::format("{} {}", b.sink->got.back().cycle, counter(b, 1));
    });
    const double last = std::stod(text), tests = std::stod(text.substr(text.find(' ')));
    CHECK(last == Approx(std::max(4000.0 / tiles, tests / rate)).epsilon(0.02));
  }
}

TEST_CASE(
    "coarse_raster: tests beyond a cycle's rate delay what follows, by tests divided by the rate, rounded "
    "up") {
  // A thin diagonal crosses many rows, each of which costs its kept tiles and the failing tests beside them.
  const auto cycles_at = [](int rate) {
    CoarseBench::Setup s{
        .triangles = {{0, kBegin}, {0, triangle(5)}, {0, {TokenKind::kDrawEnd, DrawId(0), 0}}}, .rate = rate};
    return contract::in_child([&] {
      Dispatcher driver("driver");
      CoarseBench b(driver, {}, s);
      b.store[5] = flat_triangle({glm::ivec2{0, 0}, {62, 64}, {64, 64}});
      driver.run({});
      models::TileWalk walk(b.store[5].setup);
      models::TileHit hit;
      (void)walk.next(hit);
      std::int64_t expected = 2, before = 0;  // taken at cycle 2
      for (bool more = true; more;) {
        // a tile is charged with what finds the one after it, the first one also with what found itself
        more = walk.next(hit);
        const auto tests = static_cast<std::int64_t>(walk.tests()) - before;
        expected += std::max<std::int64_t>(1, (tests + rate - 1) / rate);
        before += tests;
      }
      return fmt::format("{} {}", b.sink->got.back().cycle - 1 == expected,
                         counter(b, 1) == static_cast<std::uint64_t>(before));
    });
  };
  for (const int rate : {1, 2, 4, 64}) CHECK(cycles_at(rate) == "true true");
}

TEST_CASE("coarse_raster: a tile that Hi-Z proves hidden is dropped, from the cycle the update is there") {
  const HiZToken update{0, 0, PassId(0), 0.5f};
  CoarseBench::Setup s{.triangles = {{0, kBegin}, {10, triangle(3)}}, .hiz = {{10, update}}};
  const auto read = [](const CoarseBench& b) {
    return fmt::format("{} hidden {} updates {}", b.sink->text(), counter(b, 3), counter(b, 4));
  };
  CHECK(run<CoarseBench>(s, read) == "2:903 hidden 1 updates 1");
  s.hiz[0].cycle = 11;
  CHECK(run<CoarseBench>(s, read) == "2:903 12:30 hidden 0 updates 1");
  s.hiz[0].cycle = 10;
  s.use_hiz = false;
  CHECK(run<CoarseBench>(s, read) == "2:903 12:30 hidden 0 updates 1");
}

TEST_CASE("coarse_raster: with 'less' a triangle at the held depth is hidden, a nearer one is kept") {
  const HiZToken update{0, 0, PassId(0), 0.5f};
  CoarseBench::Setup s{.triangles = {{0, kBegin}, {10, triangle(1)}, {10, triangle(2)}},
                       .hiz = {{5, update}}};
  CHECK(tiles(s) == "2:903 13:20");  // the hidden one costs a cycle
}

TEST_CASE("coarse_raster: a tile that is nearer than all before it in its place is handed on as in front") {
  // At depth 0.5, 0.25 and 0.75, and at 0.75 of a draw that writes with "greater".
  CoarseBench::Setup s{
      .triangles = {{0, kBegin}, {10, triangle(1)}, {20, triangle(2)}, {30, triangle(1)}, {40, triangle(3)}},
      .use_hiz = false,
      .use_least = true};
  const auto in_front = [](const CoarseBench& b) {
    std::string text;
    for (const auto& t : b.sink->got)
      if (t.token.kind == TokenKind::kWork) text += t.token.in_front ? "front " : "- ";
    return text + fmt::format("{}", counter(*b.unit, "tiles_in_front"));
  };
  CHECK(run<CoarseBench>(s, in_front) == "front front - - 2");
  s.triangles[1] = {10, triangle(4, 1)};  // it asks for greater depths, and leaves its own behind
  CHECK(run<CoarseBench>(s, in_front) == "- front - - 1");
  s.use_least = false;
  CHECK(run<CoarseBench>(s, in_front) == "- - - - 0");
}

TEST_CASE("coarse_raster: an update never raises what Hi-Z holds, and one of another pass changes nothing") {
  CoarseBench::Setup s{.triangles = {{0, kBegin}, {10, triangle(3)}},
                       .hiz = {{4, {0, 0, PassId(0), 0.5f}}, {5, {0, 0, PassId(0), 0.9f}}}};
  CHECK(tiles(s) == "2:903");
  s.hiz = {{4, {0, 0, PassId(1), 0.5f}}};
  CHECK(tiles(s) == "2:903 12:30");
}

TEST_CASE(
    "coarse_raster: Hi-Z is not trusted after a draw that may have raised depths, until the pass ends") {
  const HiZToken update{0, 0, PassId(0), 0.5f};
  CoarseBench::Setup s{.triangles = {{0, kBegin}, {10, triangle(4, 1)}, {20, triangle(3, 2)}},
                       .hiz = {{5, update}}};
  CHECK(tiles(s) == "2:903 12:40 22:30");  // both kept although they lie behind what Hi-Z was told
  // the draw that only tests with "greater": it is kept, but leaves the trust
  s.triangles[1].token.part = DrawId(3);
  CHECK(tiles(s) == "2:903 12:40");
  s.triangles = {{0, kBegin}, {10, triangle(4, 1)}, {15, kBegin}, {20, triangle(3, 2)}};
  s.hiz = {{17, update}};
  CHECK(tiles(s) == "2:903 12:40 17:903");
}

TEST_CASE("coarse_raster: a sync follows every eighth part of the triangle store") {
  CoarseBench::Setup s{
      .triangles = {{0, kBegin}, {0, triangle(1)}, {0, triangle(2)}, {0, triangle(3)}, {0, triangle(1)}},
      .store_slots = 16};
  const auto text = run<CoarseBench>(s, [](const CoarseBench& b) {
    std::string all = b.sink->text();
    for (const auto& t : b.sink->got) {
      if (t.token.kind == TokenKind::kSync) all += fmt::format(" before {}", t.token.triangle);
    }
    return all;
  });
  CHECK(text == "2:903 3:10 4:20 5:905 6:30 7:10 8:905 before 3 before 2");
}

TEST_CASE("coarse_raster: stops while tile_out is full but still takes Hi-Z updates") {
  const HiZToken update{0, 0, PassId(0), 0.6f};
  CoarseBench::Setup s{.triangles = {{0, kBegin}, {0, triangle(0)}, {0, triangle(3)}},
                       .hiz = {{20, update}},
                       .pace = {.from = 100},
                       .out = {.depth = 1}};
  const auto text = run<CoarseBench>(
      s, [](const CoarseBench& b) { return fmt::format("{} hidden {}", b.sink->text(), counter(b, 3)); });
  CHECK(text == "100:903 102:0 104:1 hidden 1");
}

TEST_CASE("coarse_raster: keeps the contract, one-deep links included") {
  CoarseBench::Setup s{.triangles = {{0, kBegin},
                                     {0, triangle(0)},
                                     {0, triangle(1)},
                                     {0, triangle(4, 1)},
                                     {0, triangle(2, 2)}},
                       .hiz = {{1, {0, 0, PassId(0), 0.5f}}, {9, {1, 0, PassId(0), 0.5f}}},
                       .rate = 1,
                       .pace = {.from = 0, .period = 3},
                       .use_hiz = false,
                       .store_slots = 16};
  CHECK(contract_text<CoarseBench>(s) == "");
}
