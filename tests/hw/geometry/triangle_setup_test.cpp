/// Triangle set-up: its rate, what is culled, and the bound of the triangle store.
#include "hw/geometry/triangle_setup.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

#include <bit>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct SetupBench final : Bench {
  struct Setup {
    std::vector<Timed<ClippedToken>> pieces;
    std::vector<Timed<ClippedToken>> second_front_end{};  ///< its pieces; empty: there is one
    std::vector<Timed<ReleaseToken>> sync_0{}, sync_1{};
    double drawn_per_clk = 1, culled_per_clk = 1, lines_per_clk = 0.5, points_per_clk = 1;
    models::PrimitiveState primitives{};
    std::size_t slots = 16;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  /// Piece 0 is kept, 1 faces away, 2 has no area, 3 lies outside the scissor, 4 between pixel centres;
  /// 5 is kept as a line or a point too.
  SetupBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), batches(1), pieces(6), triangles(s.slots) {
    DrawState draw;
    program.varyings.resize(1);
    draw.vertex.program = &program;
    draw.views[0].setup.cull = models::CullMode::kBack;
    draw.primitives = s.primitives;
    draw.views[0].setup.scissor = {0, 0, 64, 64};
    frame.draws = {draw};
    batches[0].outputs.resize(5);
    for (std::size_t lane = 0; lane < 3; ++lane)
      batches[0].outputs[4][lane] = std::bit_cast<std::uint32_t>(1.0f + static_cast<float>(lane * lane));
    piece(0, {0, 0}, {0, 16 * 256}, {16 * 256, 0});
    piece(1, {0, 0}, {16 * 256, 0}, {0, 16 * 256});
    piece(2, {0, 0}, {512, 512}, {1024, 1024});
    piece(3, {100 * 256, 0}, {100 * 256, 2560}, {110 * 256, 0});
    piece(4, {0, 0}, {0, 64}, {64, 0});
    piece(5, {8 * 256, 8 * 256}, {8 * 256, 24 * 256}, {24 * 256, 8 * 256});
    params.drawn_per_clk.set(s.drawn_per_clk);
    params.culled_per_clk.set(s.culled_per_clk);
    params.lines_per_clk.set(s.lines_per_clk);
    params.points_per_clk.set(s.points_per_clk);
    const int front_ends = s.second_front_end.empty() ? 1 : 2;
    unit = std::make_unique<TriangleSetupUnit>(
        "unit", context({.partitions = 2, .front_ends = front_ends}), params,
        TriangleSetupUnit::Stores{
            batches, std::vector<const Store<ClippedPiece>*>(static_cast<std::size_t>(front_ends), &pieces),
            triangles});
    add(*unit);
    feed(unit->clipped_in[0], s.pieces);
    if (front_ends == 2) {
      feed(unit->clipped_in[1], s.second_front_end);
      released_second =
          &drain<ReleaseToken>(*unit->release_out[1], [](const ReleaseToken& t) { return t.slot; });
    }
    feed(unit->sync_in[0], s.sync_0);
    feed(unit->sync_in[1], s.sync_1);
    kept = &drain<TriangleToken>(
        unit->triangle_out,
        [](const TriangleToken& t) {
          return t.kind == TokenKind::kWork ? t.triangle : 900u + static_cast<unsigned>(t.kind);
        },
        s.pace, s.out);
    released = &drain<ReleaseToken>(*unit->release_out[0], [](const ReleaseToken& t) { return t.slot; });
  }
  void piece(std::uint64_t slot, glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
    pieces[slot].vertices = {models::WindowVertex{a.x, a.y, 0.5f, 1}, models::WindowVertex{b.x, b.y, 0.5f, 1},
                             models::WindowVertex{c.x, c.y, 0.5f, 1}};
    pieces[slot].weights = models::whole_triangle_weights();
  }
  models::Program program;
  TriangleSetupUnit::Params params;
  Store<BatchSlot> batches;
  Store<ClippedPiece> pieces;
  TriangleStore triangles;
  std::unique_ptr<TriangleSetupUnit> unit;
  StubSink<TriangleToken>* kept = nullptr;
  StubSink<ReleaseToken>* released = nullptr;
  StubSink<ReleaseToken>* released_second = nullptr;
};

ClippedToken piece(std::uint32_t i) {
  return {TokenKind::kWork, DrawId(0), 0, 0, {{0, 0}, {0, 1}, {0, 2}}, i};
}
ClippedToken boundary(TokenKind kind) { return {kind, {}, 0, 0, {}, 0}; }
std::string kept(const SetupBench& b) { return b.kept->text(); }

}  // namespace

TEST_CASE("triangle_setup: a rate below one is several cycles a triangle, a boundary is a cycle at most") {
  for (const int clk : {1, 5}) {
    const SetupBench::Setup s{.pieces = {{0, piece(0)},
                                         {0, piece(2)},
                                         {0, piece(0)},
                                         {0, boundary(TokenKind::kDrawEnd)},
                                         {0, piece(0)}},
                              .drawn_per_clk = 1.0 / clk,
                              .culled_per_clk = 1.0 / clk};
    CHECK(run<SetupBench>(s, kept) ==
          fmt::format("2:0 {}:1 {}:902 {}:2", 2 + 2 * clk, 2 + 3 * clk, 3 + 3 * clk));
  }
}

/// Cycle in which the last of `count` pieces of a kind, and the boundary behind them, has left.
double last_of(std::uint32_t kind, int count, double drawn, double culled) {
  SetupBench::Setup s{.pieces = {},
                      .drawn_per_clk = drawn,
                      .culled_per_clk = culled,
                      .slots = 1024,
                      .pace = {.period = 0},
                      .out = {.depth = 64, .width = 8}};
  for (int i = 0; i < count; ++i) s.pieces.push_back({0, piece(kind)});
  s.pieces.push_back({0, boundary(TokenKind::kDrawEnd)});
  return std::stod(
      run<SetupBench>(s, [](const SetupBench& b) { return fmt::format("{}", b.kept->got.back().cycle); }));
}

TEST_CASE(
    "triangle_setup: n triangles take n over their rate, those that are drawn and those that are culled") {
  constexpr int kCount = 600;
  for (const double rate : {0.5, 1.0, 2.0, 3.0, 4.0}) {
    const double other = rate == 1.0 ? 0.25 : 1.0;  // the rate of the kind that does not come
    CHECK(last_of(0, kCount, rate, other) == Approx(kCount / rate).epsilon(0.02));
    for (const std::uint32_t kind : {1u, 2u, 3u, 4u})
      CHECK(last_of(kind, kCount, other, rate) == Approx(kCount / rate).epsilon(0.02));
  }
}

TEST_CASE("triangle_setup: of two front ends the ranges are taken in turn, whichever comes first") {
  // The second front end is ready at once, the first one late: what is kept still has the draw's order. The
  // draw's end passes the turn on too.
  const auto named = [](std::uint32_t primitive) {
    ClippedToken token = piece(0);
    token.primitive = primitive;
    return token;
  };
  const SetupBench::Setup s{
      .pieces = {{50, named(0)},
                 {51, boundary(TokenKind::kRangeEnd)},
                 {52, named(2)},
                 {53, boundary(TokenKind::kBatchEnd)},
                 {54, boundary(TokenKind::kDrawEnd)}},
      .second_front_end = {{0, named(1)}, {0, boundary(TokenKind::kRangeEnd)}, {0, named(3)}}};
  const auto text = run<SetupBench>(s, [](const SetupBench& b) {
    std::string order;
    for (const auto& [cycle, token] : b.kept->got)
      order +=
          token.kind == TokenKind::kWork ? fmt::format("{} ", b.triangles[token.triangle].primitive) : "end ";
    return fmt::format("{}released {} and {}", order, b.released->got.size(), b.released_second->got.size());
  });
  CHECK(text == "0 1 2 end 3 released 2 and 1");
}

TEST_CASE("triangle_setup: n lines or points take n over their rate, and are counted") {
  constexpr int kCount = 600;
  for (const auto kind : {models::PieceKind::kLine, models::PieceKind::kPoint}) {
    for (const double rate : {0.25, 0.5, 1.0, 2.0}) {
      const bool lines = kind == models::PieceKind::kLine;
      SetupBench::Setup s{.pieces = {},
                          .lines_per_clk = lines ? rate : 0.125,
                          .points_per_clk = lines ? 0.125 : rate,
                          .primitives = {.assembled = kind},
                          .slots = 1024,
                          .pace = {.period = 0},
                          .out = {.depth = 64, .width = 8}};
      for (int i = 0; i < kCount; ++i) s.pieces.push_back({0, piece(5)});
      s.pieces.push_back({0, boundary(TokenKind::kDrawEnd)});
      const auto text = run<SetupBench>(s, [](const SetupBench& b) {
        return fmt::format("{} {} {}", b.kept->got.back().cycle, counter(*b.unit, "lines"),
                           counter(*b.unit, "points"));
      });
      CHECK(std::stod(text) == Approx(kCount / rate).epsilon(0.02));
      CHECK(text.ends_with(lines ? " 600 0" : " 0 600"));
    }
  }
}

TEST_CASE("triangle_setup: culled triangles go at their rate between drawn ones") {
  // Half of 400 are drawn at two cycles each, half culled at one, as GPUs did up to 2008.
  SetupBench::Setup s{.pieces = {}, .drawn_per_clk = 0.5, .slots = 1024};
  for (std::uint32_t i = 0; i < 400; ++i) s.pieces.push_back({0, piece(i % 2)});
  s.pieces.push_back({0, boundary(TokenKind::kDrawEnd)});
  const double last = std::stod(
      run<SetupBench>(s, [](const SetupBench& b) { return fmt::format("{}", b.kept->got.back().cycle); }));
  CHECK(last == Approx(200 * 2 + 200).epsilon(0.02));
}

TEST_CASE("triangle_setup: every triangle is counted once by what became of it") {
  const SetupBench::Setup s{
      .pieces = {{0, piece(0)}, {0, piece(1)}, {0, piece(2)}, {0, piece(3)}, {0, piece(4)}, {0, piece(1)}}};
  const auto text = run<SetupBench>(s, [](const SetupBench& b) {
    const Unit& u = *b.unit;
    return fmt::format("{}: kept {} culled {} zero {} offscreen {} no sample {}", counter(u, "triangles"),
                       counter(u, "kept"), counter(u, "culled"), counter(u, "zero_area"),
                       counter(u, "offscreen"), counter(u, "no_sample"));
  });
  CHECK(text == "6: kept 1 culled 2 zero 1 offscreen 1 no sample 1");
}

TEST_CASE("triangle_setup: varyings are the first corner's and the differences to it") {
  const auto text = run<SetupBench>({.pieces = {{0, piece(0)}}}, [](const SetupBench& b) {
    return fmt::format("{} {} {}", b.triangles[0].varyings[0], b.triangles[0].varyings[1],
                       b.triangles[0].varyings[2]);
  });
  CHECK(text == "1 1 4");
}

TEST_CASE("triangle_setup: a batch's end releases its slot in its turn") {
  const SetupBench::Setup s{.pieces = {{0, piece(0)}, {0, boundary(TokenKind::kBatchEnd)}, {0, piece(0)}}};
  CHECK(run<SetupBench>(s, [](const SetupBench& b) { return b.kept->text() + " | " + b.released->text(); }) ==
        "2:0 4:1 | 3:0");
}

TEST_CASE(
    "triangle_setup: waits while the triangle store is full, until every partition has retired its oldest") {
  const SetupBench::Setup s{.pieces = {{0, piece(0)}, {0, piece(0)}, {0, piece(0)}},
                            .sync_0 = {{30, {0, 1}}},
                            .sync_1 = {{70, {0, 2}}},
                            .slots = 2};
  CHECK(run<SetupBench>(s, kept) == "2:0 3:1 72:2");
}

TEST_CASE("triangle_setup: keeps the contract, one-deep links included") {
  const SetupBench::Setup s{.pieces = {{0, piece(0)},
                                       {0, piece(1)},
                                       {0, boundary(TokenKind::kBatchEnd)},
                                       {0, piece(0)},
                                       {0, piece(0)},
                                       {0, boundary(TokenKind::kPassEnd)}},
                            .sync_0 = {{30, {0, 1}}, {90, {0, 2}}},
                            .sync_1 = {{50, {0, 2}}},
                            .drawn_per_clk = 1.0 / 3,
                            .culled_per_clk = 2,
                            .slots = 2,
                            .pace = {.from = 0, .period = 5}};
  CHECK(contract_text<SetupBench>(s) == "");
}
