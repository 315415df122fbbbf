/// Depth unit: the time of early and late tests, when a tile must go late, Hi-Z updates, the flush.
#include "hw/rop/depth_unit.h"
#include "models/rop/tile_in_frame.h"
#include "tests/hw/bench_stub.h"
#include "tests/hw/cache_user.h"
#include "tests/hw/raster/triangles.h"

#include <catch2/catch.hpp>

#include <map>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct DepthBench final : Bench {
  struct Setup {
    std::vector<Timed<CoverageToken>> coverage;
    std::vector<Timed<LateToken>> late{};
    int lines = 256, ways = 8, misses = 32;
    std::uint32_t width = 16, height = 8;
    models::LoadOp load = models::LoadOp::kClear;
    models::StoreOp store = models::StoreOp::kStore;
    bool read_later = false;
    float stored = 0;      ///< what a loaded surface holds
    bool stencil = false;  ///< draws 0 and 1 count what passes, in a surface of 24 bits and stencil values
  };
  /// Draws: 0 tests and writes with "less" early, 1 the same late, 2 without depth, 3 writes with "greater".
  /// Triangle i lies at depth i / 8.
  DepthBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), triangles(8), warps(4) {
    PassState pass;
    pass.has_depth = true;
    if (s.stencil) pass.depth.format = models::Format::kD24UnormS8Uint;
    pass.depth.surface = models::allocate_surface(device, s.width, s.height);
    models::fill_surface(device, pass.depth.surface, {{std::bit_cast<std::uint32_t>(s.stored)}});
    pass.depth.clear = models::encode_depth(pass.depth.format, pass.clear_depth, 0);
    pass.depth.load = s.load;
    pass.depth.store = s.store;
    pass.depth.read_later = s.read_later;
    pass.draws = 4;
    frame.passes = {pass};
    frame.draws.resize(4);
    for (DrawState& draw : frame.draws) {
      draw.fragment.program = &program;
      draw.depth_stencil.depth_test = draw.depth_stencil.depth_write = true;
      draw.depth_stencil.stencil.test = s.stencil;
      draw.depth_stencil.stencil.front.pass = models::StencilOp::kIncrementClamp;
      draw.depth_stencil.stencil.back = draw.depth_stencil.stencil.front;
    }
    frame.draws[1].late_depth = true;
    frame.draws[2].depth_stencil.depth_test = false;
    frame.draws[3].depth_stencil.depth_compare = models::CompareOp::kGreater;
    for (std::uint32_t i = 0; i < 8; ++i) {
      triangles[i] = flat_triangle({glm::ivec2{0, 0}, {0, 40}, {40, 0}}, static_cast<float>(i) / 8);
      if (i < 4) fill(warps[WarpSlotId(i)], static_cast<float>(i + 1) / 8);
    }
    set_cache(params, s.lines, s.ways, s.misses);
    unit = std::make_unique<DepthUnit>("unit", context(), params, triangles, warps);
    add(*unit);
    feed(unit->coverage_in, s.coverage);
    feed(unit->late_in, s.late);
    out = &drain<CoverageToken>(unit->coverage_out, [](const CoverageToken& t) {
      return t.kind == TokenKind::kWork
                 ? 100u * static_cast<unsigned>(t.late) + static_cast<unsigned>(t.triangle)
                 : 900u + static_cast<unsigned>(t.kind);
    });
    late = &drain<LateToken>(unit->late_out, [](const LateToken& t) {
      return 100 * static_cast<unsigned>(t.kind) + t.slot.index();
    });
    hiz = &drain<HiZToken>(unit->hiz_out,
                           [](const HiZToken& t) { return static_cast<std::uint64_t>(1000 * t.max_depth); });
    memory = &serve(unit->memory_port(), 10);
  }
  /// The upper half of the left tile.
  static void fill(WarpSlot& warp, float depth) {
    warp.draw = DrawId(1);
    warp.quads = 8;
    warp.late = true;
    warp.covered = warp.alive = ~0u;
    warp.depth.fill(depth);
    for (std::uint16_t q = 0; q < 8; ++q)
      warp.quad[q] = {0, static_cast<std::uint16_t>(2 * (q % 4)), static_cast<std::uint16_t>(2 * (q / 4))};
  }
  [[nodiscard]] std::string depths() const {
    std::string all;
    for (const std::uint32_t word : models::detile(device, frame.passes[0].depth.surface))
      all += fmt::format("{:x} ", word);
    return all;
  }
  models::Program program;
  DepthUnit::Params params;
  TriangleStore triangles;
  WarpStore warps;
  std::unique_ptr<DepthUnit> unit;
  StubSink<CoverageToken>* out = nullptr;
  StubSink<LateToken>* late = nullptr;
  StubSink<HiZToken>* hiz = nullptr;
  StubMemory* memory = nullptr;
};

constexpr std::uint64_t kAll = ~std::uint64_t{0}, kUpperHalf = 0xffffffffu;
const CoverageToken kBegin{TokenKind::kPassBegin, false, 0, 0, PassId(0), 0, 0};

CoverageToken tile(std::uint64_t triangle, std::uint32_t draw = 0, std::uint64_t mask = kAll,
                   std::uint16_t x = 0) {
  return {TokenKind::kWork, false, x, 0, DrawId(draw), triangle, mask};
}
std::string outputs(const DepthBench& b) { return b.out->text(); }

}  // namespace

TEST_CASE("depth_unit: a tile is tested two cycles after it is there, sixteen quads at four a cycle") {
  const DepthBench::Setup s{
      .coverage = {{0, kBegin}, {10, tile(4)}, {10, tile(3)}, {10, tile(2, 0, 0xf)}, {10, tile(1)}}};
  CHECK(run<DepthBench>(s, outputs) == "3:903 13:4 17:3 21:2 22:1");
}

TEST_CASE(
    "depth_unit: fragments that fail are killed, a tile without survivors goes no further but takes its "
    "time") {
  const DepthBench::Setup s{
      .coverage = {{0, kBegin}, {10, tile(4, 0, kUpperHalf)}, {10, tile(6, 0, kUpperHalf)}, {10, tile(6)}}};
  const auto text = run<DepthBench>(s, [](const DepthBench& b) {
    const Unit& u = *b.unit;
    return fmt::format("{} coverage {:x} in {} killed {} out {} reads {}", b.out->text(),
                       b.out->got[2].token.coverage, counter(u, "fragments_in"), counter(u, "early_killed"),
                       counter(u, "fragments_out"), b.memory->got.size());
  });
  // a cleared tile is not fetched
  CHECK(text == "3:903 13:4 17:6 coverage ffffffff00000000 in 128 killed 64 out 64 reads 0");
}

TEST_CASE("depth_unit: what is in front of all that is there does not read it, and is written all the same") {
  const auto requests = [](bool in_front) {
    CoverageToken token = tile(2, 0, kUpperHalf);
    token.in_front = in_front;
    const DepthBench::Setup s{.coverage = {{0, kBegin}, {10, token}},
                              .late = {{60, {TokenKind::kPassEnd, {}}}},
                              .load = models::LoadOp::kLoad,
                              .stored = 1};
    return run<DepthBench>(s, [](const DepthBench& b) {
      return fmt::format("{} out, {} unread: {}", counter(*b.unit, "fragments_out"),
                         counter(*b.unit, "tiles_unread"), requests_seen(*b.memory));
    });
  };
  CHECK(requests(false) == "32 out, 0 unread:  r0/f w0/f f0/0");
  CHECK(requests(true) == "32 out, 1 unread:  w0/f f0/0");
}

TEST_CASE("depth_unit: stencil values count what passes, early and late, at the rate of depth alone") {
  const auto seen = [](bool stencil) {
    const DepthBench::Setup s{.coverage = {{0, kBegin},
                                           {10, tile(4)},
                                           {10, tile(6)},
                                           {10, tile(2, 0, 0xf)},
                                           {10, tile(1, 1, kUpperHalf)}},
                              .late = {{60, {TokenKind::kWork, WarpSlotId(0)}}},
                              .stencil = stencil};
    return run<DepthBench>(s, [](const DepthBench& b) {
      std::map<std::uint32_t, int> pixels;
      for (const std::uint32_t word : models::detile(b.device, b.frame.passes[0].depth.surface))
        ++pixels[word >> 24];
      return fmt::format("{} late {}, {} written: {} {} {} {}", b.out->text(), b.late->text(),
                         counter(*b.unit, "stencil_written"), pixels[0], pixels[1], pixels[2], pixels[3]);
    });
  };
  const std::string with = seen(true), without = seen(false);
  // 64 pixels at 4/8, none at 6/8, 4 at 2/8, and the upper 32 at 1/8 after shading; the right tile stays.
  CHECK(with.substr(with.find(',')) == ", 100 written: 64 32 28 4");
  CHECK(with.substr(0, with.find(',')) == without.substr(0, without.find(',')));
}

TEST_CASE("depth_unit: a draw without depth test passes untouched") {
  const DepthBench::Setup s{.coverage = {{0, kBegin}, {10, tile(4)}, {10, tile(6, 2)}}};
  CHECK(run<DepthBench>(s, [](const DepthBench& b) {
          return fmt::format("{} untested {}", b.out->text(), counter(*b.unit, "untested"));
        }) == "3:903 13:4 17:6 untested 64");
}

TEST_CASE(
    "depth_unit: every fragment is counted where it went, also those of a late tile that are killed early") {
  const DepthBench::Setup s{
      .coverage = {{0, kBegin}, {10, tile(4, 0, kUpperHalf)}, {10, tile(6, 1)}, {10, tile(6, 2, 0xf)}}};
  const auto text = run<DepthBench>(s, [](const DepthBench& b) {
    const Unit& u = *b.unit;
    return fmt::format("in {} = tested {} + deferred {} + untested {}, killed {}", counter(u, "fragments_in"),
                       counter(u, "early_tested"), counter(u, "deferred"), counter(u, "untested"),
                       counter(u, "early_killed"));
  });
  CHECK(text == "in 100 = tested 64 + deferred 32 + untested 4, killed 32");
}

TEST_CASE(
    "depth_unit: an early draw goes late while late fragments of its tile are in flight, and is early again "
    "after them") {
  const DepthBench::Setup s{
      .coverage = {{0, kBegin},
                   {10, tile(4, 1, kUpperHalf)},
                   {20, tile(3, 0, kUpperHalf)},
                   {25, tile(3, 0, kUpperHalf, 1)},
                   {60, tile(1, 0, kUpperHalf)}},
      .late = {{40, {TokenKind::kWork, WarpSlotId(3)}}, {40, {TokenKind::kWork, WarpSlotId(2)}}}};
  const auto text = run<DepthBench>(s, [](const DepthBench& b) {
    return fmt::format("{} | {} deferred {} late {}", b.out->text(), b.late->text(),
                       counter(*b.unit, "deferred"), counter(*b.unit, "late_tested"));
  });
  // tile (1, 0) is not concerned
  CHECK(text == "3:903 13:104 23:103 28:3 63:1 | 42:3 44:2 deferred 64 late 64");
}

TEST_CASE("depth_unit: late tests kill in their order and leave the survivors in the warp") {
  const DepthBench::Setup s{
      .coverage = {{0, kBegin}, {10, tile(4, 1, kUpperHalf)}, {20, tile(3, 1, kUpperHalf)}},
      .late = {{40, {TokenKind::kWork, WarpSlotId(0)}}, {40, {TokenKind::kWork, WarpSlotId(2)}}}};
  const auto text = run<DepthBench>(s, [](const DepthBench& b) {
    return fmt::format("{:x} {:x} killed {}", b.warps[WarpSlotId(0)].alive, b.warps[WarpSlotId(2)].alive,
                       counter(*b.unit, "late_killed"));
  });
  CHECK(text == "ffffffff 0 killed 32");
}

TEST_CASE(
    "depth_unit: Hi-Z is told when the greatest depth of a tile falls, and not after a draw that may raise "
    "depths") {
  DepthBench::Setup s{.coverage = {{0, kBegin},
                                   {10, tile(4, 0, kUpperHalf)},
                                   {20, tile(4)},
                                   {30, tile(3, 0, kUpperHalf)},
                                   {40, tile(2)}}};
  const auto text = [](const DepthBench& b) { return b.hiz->text(); };
  CHECK(run<DepthBench>(s, text) == "23:500 43:250");  // the half that was clear kept the greatest depth at 1
  s.coverage[3].token = tile(7, 3, kUpperHalf);        // raises some: nothing may be told any more
  CHECK(run<DepthBench>(s, text) == "23:500");
}

TEST_CASE("depth_unit: Hi-Z is told of a tile that the frame cuts, whose other pixels keep the clear depth") {
  const DepthBench::Setup s{.coverage = {{0, kBegin},
                                         {10, tile(4, 0, models::pixels_within(8, 5))},
                                         {20, tile(4, 0, models::pixels_within(3, 5), 1)}},
                            .width = 11,
                            .height = 5};
  CHECK(run<DepthBench>(s, [](const DepthBench& b) { return b.hiz->text(); }) == "13:500 23:500");
}

TEST_CASE("depth_unit: the flush writes dirty lines, no cleared tiles, and answers after its fence") {
  const DepthBench::Setup s{.coverage = {{0, kBegin}, {10, tile(4)}},
                            .late = {{100, {TokenKind::kPassEnd, {}}}}};
  const auto text = run<DepthBench>(s, [](const DepthBench& b) {
    return fmt::format("{} writes {} dirty {}", b.late->text(), b.memory->count(MemoryRequest::Kind::kWrite),
                       b.device.dirty_lines());
  });
  CHECK(text == "116:400 writes 2 dirty 0");
}

TEST_CASE(
    "depth_unit: the flush writes what a later pass reads, and nothing of a surface that is discarded") {
  DepthBench::Setup s{.coverage = {{0, kBegin}, {10, tile(4)}}, .late = {{100, {TokenKind::kPassEnd, {}}}}};
  const auto text = [](const DepthBench& b) {
    return fmt::format("writes {} cleared {} dirty {}", b.memory->count(MemoryRequest::Kind::kWrite),
                       counter(*b.unit, "clear_writes"), b.device.dirty_lines());
  };
  s.read_later = true;  // two tiles of two lines: one was drawn to, the other is still marked
  CHECK(run<DepthBench>(s, text) == "writes 4 cleared 1 dirty 0");
  s.store = models::StoreOp::kDiscard;
  CHECK(run<DepthBench>(s, text) == "writes 0 cleared 0 dirty 0");
}

TEST_CASE("depth_unit: a surface that is loaded has no cleared tiles and is read") {
  const DepthBench::Setup s{
      .coverage = {{0, kBegin}, {10, tile(4)}}, .late = {}, .load = models::LoadOp::kLoad};
  const auto text = run<DepthBench>(s, [](const DepthBench& b) {
    return fmt::format("cleared {} reads {} killed {}", counter(*b.unit, "fast_cleared_tiles"),
                       b.memory->count(MemoryRequest::Kind::kRead), counter(*b.unit, "early_killed"));
  });
  // Memory holds zeros, and nothing is nearer than that.
  CHECK(text == "cleared 0 reads 2 killed 64");
}

TEST_CASE("depth_unit: a cache of one line gets through, and to the same depths") {
  DepthBench::Setup s{.coverage = {{0, kBegin}}, .late = {{400, {TokenKind::kPassEnd, {}}}}};
  for (std::uint64_t i = 7; i > 0; --i) {
    s.coverage.push_back({0, tile(i, 0, kUpperHalf, static_cast<std::uint16_t>(i % 2))});
    s.coverage.push_back(
        {0, tile(i, 0, i % 2 == 0 ? kAll : 0xff00ff0000ff00ff, static_cast<std::uint16_t>(i / 2 % 2))});
  }
  const auto text = [](const DepthBench& b) {
    return fmt::format("{} out {} dirty {}", counter(*b.unit, "fragments_out"), b.device.dirty_lines(),
                       b.depths());
  };
  const auto expected = run<DepthBench>(s, text);
  CHECK_THAT(expected, !Catch::StartsWith("failed") && Catch::Contains(" out 0 dirty"));
  s.lines = s.ways = s.misses = 1;
  CHECK(run<DepthBench>(s, text) == expected);
}

TEST_CASE("depth_unit: keeps the contract, one-deep links included") {
  DepthBench::Setup s{.coverage = {{0, kBegin},
                                   {0, tile(7)},
                                   {0, tile(6, 1, kUpperHalf)},
                                   {0, tile(5, 2)},
                                   {9, tile(5, 0, kUpperHalf, 1)},
                                   {80, tile(3)}},
                      .late = {{60, {TokenKind::kWork, WarpSlotId(2)}}, {300, {TokenKind::kPassEnd, {}}}}};
  CHECK(contract_text<DepthBench>(s) == "");
  // slower: whether a tile meets late fragments in flight depends on the links
  s.lines = s.ways = s.misses = 1;
  CHECK(contract_text<DepthBench>(s, false) == "");
}
