/// Primitive assembly: a batch waits for its own shading, in draw order.
#include "hw/geometry/primitive_assembly.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct AssemblyBench final : Bench {
  struct Setup {
    std::vector<Timed<BatchToken>> batches;
    std::vector<Timed<VertexDoneToken>> done_0{}, done_1{};
    Pace pace{};
    LinkSpec out{.depth = 64};
    int triangles_per_clk = 1;
    std::uint32_t triangles = 0;  ///< of batch 0, instead of two
  };
  /// Batch 0 has triangles 0 and 1, batch 1 has triangle 10, batch 2 none; batch 3 shades nothing, its
  /// triangle 20 names vertices of batch 0.
  AssemblyBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v), store(4) {
    store[0].triangles = {{{{0, 0}, {0, 1}, {0, 2}}, 0}, {{{0, 2}, {0, 1}, {0, 3}}, 1}};
    if (s.triangles > 0) store[0].triangles.clear();
    for (std::uint32_t i = 0; i < s.triangles; ++i)
      store[0].triangles.push_back({{{0, 0}, {0, 1}, {0, 2}}, i});
    params.triangles_per_clk.set(s.triangles_per_clk);
    store[1].triangles = {{{{1, 0}, {1, 1}, {1, 2}}, 10}};
    store[0].lanes = 4;
    store[1].lanes = 3;
    store[2].lanes = 1;
    store[3].triangles = {{{{0, 0}, {0, 2}, {0, 3}}, 20}};
    unit = std::make_unique<PrimitiveAssembly>("unit", context({.cores = 2}), params, store);
    add(*unit);
    feed(unit->batch_in, s.batches);
    feed(unit->done_in[0], s.done_0);
    feed(unit->done_in[1], s.done_1);
    loads = &drain<ReleaseToken>(unit->load_out, [](const ReleaseToken& t) { return t.slot; });
    sink = &drain<PrimitiveToken>(
        unit->primitive_out,
        [](const PrimitiveToken& t) {
          return t.kind == TokenKind::kWork ? t.primitive : 900u + static_cast<unsigned>(t.kind);
        },
        s.pace, s.out);
  }
  PrimitiveAssembly::Params params;
  Store<BatchSlot> store;
  std::unique_ptr<PrimitiveAssembly> unit;
  StubSink<PrimitiveToken>* sink = nullptr;
  StubSink<ReleaseToken>* loads = nullptr;
};

BatchToken batch(std::uint32_t slot) { return {TokenKind::kWork, DrawId(0), slot}; }
std::string primitives(const AssemblyBench::Setup& s) {
  return run<AssemblyBench>(s, [](const AssemblyBench& b) { return b.sink->text(); });
}

}  // namespace

TEST_CASE(
    "primitive_assembly: a batch's triangles leave from the cycle its shading is reported, one a cycle, then "
    "its end") {
  CHECK(primitives({.batches = {{0, batch(0)}}, .done_0 = {{30, {0}}}}) == "32:0 33:1 34:901");
  CHECK(primitives({.batches = {{50, batch(0)}}, .done_0 = {{30, {0}}}}) == "52:0 53:1 54:901");
}

TEST_CASE(
    "primitive_assembly: n triangles take n over triangles_per_clk, and no less than the link's width "
    "allows") {
  for (const int rate : {1, 2, 4}) {
    for (const int width : {1, 8}) {
      const AssemblyBench::Setup s{.batches = {{0, batch(0)}},
                                   .done_0 = {{0, {0}}},
                                   .pace = {.period = 0},
                                   .out = {.depth = 64, .width = width},
                                   .triangles_per_clk = rate,
                                   .triangles = 1000};
      const auto last = std::stod(run<AssemblyBench>(
          s, [](const AssemblyBench& b) { return fmt::format("{}", b.sink->got.back().cycle); }));
      CHECK(last == Approx(1000.0 / std::min(rate, width)).epsilon(0.02));
    }
  }
}

TEST_CASE("primitive_assembly: batches keep their order when the later one is shaded first") {
  const AssemblyBench::Setup s{
      .batches = {{0, batch(0)}, {0, batch(1)}}, .done_0 = {{30, {0}}}, .done_1 = {{10, {1}}}};
  CHECK(primitives(s) == "32:0 33:1 34:901 35:10 36:901");
}

TEST_CASE("primitive_assembly: a report counts for one use of a slot") {
  const AssemblyBench::Setup s{
      .batches = {{0, batch(1)}, {0, batch(1)}}, .done_0 = {{10, {1}}}, .done_1 = {{40, {1}}}};
  const auto text = run<AssemblyBench>(s, [](const AssemblyBench& b) {
    return fmt::format("{} batches {} vertices {} triangles {}", b.sink->text(), counter(*b.unit, "batches"),
                       counter(*b.unit, "vertices"), counter(*b.unit, "triangles"));
  });
  CHECK(text == "12:10 13:901 42:10 43:901 batches 2 vertices 6 triangles 2");
}

TEST_CASE(
    "primitive_assembly: tells which core has done a batch when the report arrives, not when the batch's "
    "turn comes") {
  const AssemblyBench::Setup s{
      .batches = {{60, batch(0)}, {60, batch(1)}}, .done_0 = {{30, {0}}}, .done_1 = {{10, {1}}}};
  CHECK(run<AssemblyBench>(s, [](const AssemblyBench& b) { return b.loads->text(); }) == "12:1 32:0");
}

TEST_CASE(
    "primitive_assembly: boundaries pass without waiting for a report, and a batch without triangles has "
    "only its end") {
  const AssemblyBench::Setup s{.batches = {{0, {TokenKind::kPassBegin, PassId(0), 0}},
                                           {0, batch(2)},
                                           {0, {TokenKind::kDrawEnd, DrawId(0), 0}}},
                               .done_0 = {{10, {2}}}};
  CHECK(primitives(s) == "2:903 12:901 13:902");
}

TEST_CASE(
    "primitive_assembly: a batch that shades nothing waits for none, and its triangles name the vertices of "
    "the batch that did") {
  const AssemblyBench::Setup s{.batches = {{0, batch(0)}, {0, batch(3)}}, .done_0 = {{30, {0}}}};
  CHECK(primitives(s) == "32:0 33:1 34:901 35:20 36:901");
  const auto corners = run<AssemblyBench>(s, [](const AssemblyBench& b) {
    const PrimitiveToken& t = b.sink->got[3].token;
    return fmt::format("{}.{} {}.{} {}.{}", t.corner[0].slot, t.corner[0].lane, t.corner[1].slot,
                       t.corner[1].lane, t.corner[2].slot, t.corner[2].lane);
  });
  CHECK(corners == "0.0 0.2 0.3");
}

TEST_CASE("primitive_assembly: takes reports while primitive_out is full") {
  const AssemblyBench::Setup s{.batches = {{0, batch(0)}, {0, batch(1)}},
                               .done_0 = {{1, {0}}},
                               .done_1 = {{20, {1}}},
                               .pace = {.from = 100, .period = 4},
                               .out = {.depth = 1}};
  CHECK(primitives(s) == "100:0 104:1 108:901 112:10 116:901");
}

TEST_CASE("primitive_assembly: keeps the contract, one-deep links included") {
  const AssemblyBench::Setup s{.batches = {{0, {TokenKind::kPassBegin, PassId(0), 0}},
                                           {0, batch(0)},
                                           {0, batch(2)},
                                           {0, batch(1)},
                                           {5, {TokenKind::kDrawEnd, DrawId(0), 0}}},
                               .done_0 = {{7, {1}}, {9, {0}}},
                               .done_1 = {{9, {2}}},
                               .pace = {.from = 0, .period = 3}};
  CHECK(contract_text<AssemblyBench>(s) == "");
}
