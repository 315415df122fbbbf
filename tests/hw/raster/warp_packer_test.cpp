/// Warp packer: what shares a warp, what launches it, and the places of the reorder buffer.
#include "hw/raster/warp_packer.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct PackerBench final : Bench {
  struct Setup {
    std::vector<Timed<CoverageToken>> coverage;
    std::vector<Timed<WarpReleaseToken>> releases{};
    int rate = 4, slots = 16, patience = 64, launch = 1, samples = 1;
    bool by_sample = false;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  PackerBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), warps(static_cast<std::size_t>(s.slots)) {
    frame.draws.resize(16);
    for (DrawState& draw : frame.draws) {
      draw.views[0].setup.samples = quadrille::models::sample_grid(s.samples, 8);
      draw.by_sample = s.by_sample;
    }
    params.quads_per_clk.set(s.rate);
    params.patience_clk.set(s.patience);
    params.launch_clk.set(s.launch);
    unit = std::make_unique<WarpPacker>("unit", context({.partitions = 4}, 3), params, warps);
    add(*unit);
    feed(unit->coverage_in, s.coverage);
    feed(unit->release_in, s.releases);
    work = &drain<FragmentWarpToken>(
        unit->warp_out, [](const FragmentWarpToken& t) { return t.slot.index(); }, s.pace, s.out);
    order = &drain<OrderToken>(unit->order_out, [](const OrderToken& t) {
      return t.kind == TokenKind::kWork ? t.slot.index() : 900u + static_cast<unsigned>(t.kind);
    });
  }
  WarpPacker::Params params;
  WarpStore warps;
  std::unique_ptr<WarpPacker> unit;
  StubSink<FragmentWarpToken>* work = nullptr;
  StubSink<OrderToken>* order = nullptr;
};

/// The first `quads` quads of a tile, all four pixels of each.
CoverageToken tile(int quads, std::uint32_t draw = 0, std::uint64_t triangle = 0, int x = 0,
                   bool late = false) {
  const std::uint64_t mask = quads == 16 ? ~std::uint64_t{0} : (std::uint64_t{1} << (4 * quads)) - 1;
  return {TokenKind::kWork, late, static_cast<std::uint16_t>(x), 0, DrawId(draw), triangle, mask};
}
CoverageToken boundary(TokenKind kind, std::uint64_t triangle = 0) {
  return {kind, false, 0, 0, DrawId(0), triangle, 0};
}

std::uint64_t counter(const PackerBench& b, std::size_t i) { return b.unit->stats()->counters()[i]->value(); }
std::string warps(const PackerBench::Setup& setup) {
  return run<PackerBench>(setup, [](const PackerBench& b) { return b.work->text(); });
}

}  // namespace

TEST_CASE(
    "warp_packer: a full tile makes two warps of eight quads, at the rate and one cycle to launch each") {
  // Quads at 1..2, launch at 3, quads at 4..5, launch at 6: a sink sees a launch one cycle later.
  CHECK(warps({.coverage = {{0, tile(16)}}}) == "4:0 7:1");
  CHECK(warps({.coverage = {{0, tile(16)}}, .rate = 1}) == "10:0 19:1");
  CHECK(warps({.coverage = {{0, tile(16)}}, .rate = 16}) == "3:0 5:1");
}

TEST_CASE("warp_packer: launch_clk is the time between a full warp and the next one's quads") {
  CHECK(warps({.coverage = {{0, tile(16)}}, .launch = 3}) == "4:0 9:1");
  CHECK(warps({.coverage = {{0, tile(16)}}, .launch = 0}) == "4:0 6:1");
}

TEST_CASE("warp_packer: quads of several triangles and tiles of a draw share a warp") {
  const auto text = run<PackerBench>(
      {.coverage = {{0, tile(3, 0, 7, 1)}, {0, tile(3, 0, 8, 2)}, {0, tile(2, 0, 9, 3)}}},
      [](const PackerBench& b) {
        std::string all = b.work->text();
        const WarpSlot& warp = b.warps[WarpSlotId(0)];
        for (int q = 0; q < warp.quads; ++q) {
          const auto& quad = warp.quad[static_cast<std::size_t>(q)];
          all += fmt::format(" {}@{},{}", quad.triangle, quad.x, quad.y);
        }
        return fmt::format("{} covered {:x} partition {} warps {} partial {}", all, warp.covered,
                           b.work->got[0].token.partition.index(), counter(b, 3), counter(b, 4));
      });
  CHECK(text ==
        "5:0 7@8,0 7@10,0 7@12,0 8@16,0 8@18,0 8@20,0 9@24,0 9@26,0 covered ffffffff partition 3 warps 1 "
        "partial 0");
}

TEST_CASE("warp_packer: the samples of a tile are gathered, and its pixels are packed once") {
  // Two quads of sample 0, another one of sample 2; then nothing of sample 3, which is the last token.
  const auto plane = [](std::uint8_t sample, std::uint64_t mask) {
    return CoverageToken{TokenKind::kWork, false, 0, 0, DrawId(0), 5, mask, sample, sample == 0, sample == 3};
  };
  const PackerBench::Setup s{.coverage = {{0, plane(0, 0xf1)}, {0, plane(2, 0xf01)}, {0, plane(3, 0)}},
                             .patience = 10,
                             .samples = 4};
  const auto text = run<PackerBench>(s, [](const PackerBench& b) {
    const WarpSlot& warp = b.warps[WarpSlotId(0)];
    return fmt::format("{} quads {} covered {:x} samples {} {} {} {} fragments {} samples {}", b.work->text(),
                       warp.quads, warp.covered, warp.samples[0], warp.samples[1], warp.samples[4],
                       warp.samples[8], counter(b, 1), counter(b, 6));
  });
  // Packed in cycle 1, when the last token is there; it leaves when its patience ends.
  CHECK(text == "12:0 quads 3 covered ff1 samples 5 0 1 4 fragments 9 samples 10");
}

TEST_CASE("warp_packer: of a draw by sample each sample has quads of its own, at the rate") {
  const auto plane = [](std::uint8_t sample, std::uint64_t mask) {
    return CoverageToken{TokenKind::kWork, false, 0, 0, DrawId(0), 5, mask, sample, sample == 0, sample == 3};
  };
  const PackerBench::Setup s{.coverage = {{0, plane(0, 0xf1)}, {0, plane(2, 0xf01)}, {0, plane(3, 0)}},
                             .rate = 1,
                             .patience = 10,
                             .samples = 4,
                             .by_sample = true};
  const auto text = run<PackerBench>(s, [](const PackerBench& b) {
    const WarpSlot& warp = b.warps[WarpSlotId(0)];
    std::string quads;
    for (std::size_t q = 0; q < 4; ++q)
      quads += fmt::format("{},{}:{} ", warp.quad[q].x, warp.quad[q].y, warp.quad[q].sample);
    return fmt::format("{} quads {} {}covered {:x} samples {} {} {} {} fragments {} samples {} tiles {}",
                       b.work->text(), warp.quads, quads, warp.covered, warp.samples[0], warp.samples[1],
                       warp.samples[4], warp.samples[8], counter(b, 1), counter(b, 6), counter(b, 0));
  });
  // Two quads of sample 0 in cycles 1 and 2, two of sample 2 in 3 and 4; in 5 it is known that there are no
  // more.
  CHECK(text ==
        "16:0 quads 4 0,0:0 2,0:0 0,0:2 4,0:2 covered f1f1 samples 1 0 1 4 fragments 10 samples 10 tiles 1");
}

TEST_CASE("warp_packer: a partial warp leaves exactly when its patience ends") {
  const auto read = [](const PackerBench& b) {
    return fmt::format("{} partial {} timeouts {}", b.work->text(), counter(b, 4), counter(b, 5));
  };
  for (const int patience : {1, 5, 64}) {
    const PackerBench::Setup s{.coverage = {{0, tile(3)}}, .patience = patience};
    CHECK(run<PackerBench>(s, read) == fmt::format("{}:0 partial 1 timeouts 1", 1 + patience + 1));
  }
  // A tile that comes in the very last cycle still joins, and starts the wait anew; one cycle later it opens
  // another warp.
  CHECK(run<PackerBench>({.coverage = {{0, tile(3)}, {10, tile(3)}}, .patience = 10}, read) ==
        "22:0 partial 1 timeouts 1");
  CHECK(run<PackerBench>({.coverage = {{0, tile(3)}, {11, tile(3)}}, .patience = 10}, read) ==
        "12:0 23:1 partial 2 timeouts 2");
}

TEST_CASE(
    "warp_packer: a boundary, another draw or another sort of depth test closes the open warp at once") {
  CHECK(run<PackerBench>({.coverage = {{0, tile(3)}, {0, boundary(TokenKind::kDrawEnd)}}},
                         [](const PackerBench& b) { return b.work->text() + " | " + b.order->text(); }) ==
        "3:0 | 3:0 4:902");
  CHECK(warps({.coverage = {{0, tile(3)}, {0, tile(3, 1)}}, .patience = 10}) == "3:0 14:1");
  CHECK(warps({.coverage = {{0, tile(3)}, {0, tile(3, 0, 0, 0, true)}}, .patience = 10}) == "3:0 14:1");
}

TEST_CASE("warp_packer: a sync travels with the open warp, alone when there is none") {
  const auto read = [](const PackerBench& b) {
    std::string all = b.order->text();
    for (const auto& t : b.order->got) all += fmt::format(" sync {}", t.token.sync);
    return all;
  };
  CHECK(run<PackerBench>({.coverage = {{0, tile(3)}, {0, boundary(TokenKind::kSync, 5)}, {0, tile(5)}}},
                         read) == "6:0 sync 5");
  CHECK(run<PackerBench>({.coverage = {{0, boundary(TokenKind::kSync, 5)}, {0, tile(8)}}}, read) ==
        "2:905 5:0 sync 5 sync 0");
}

TEST_CASE("warp_packer: opens no more warps than the reorder buffer has places") {
  // Four warps; the second place comes free at cycle 51 and the others at 61 and 71: the quads of the waiting
  // tile start then.
  const PackerBench::Setup s{
      .coverage = {{0, tile(16)}, {0, tile(16)}},
      .releases = {{50, {WarpSlotId(0)}}, {60, {WarpSlotId(1)}}, {70, {WarpSlotId(2)}}},
      .slots = 1};
  CHECK(warps(s) == "4:0 54:0 64:0 74:0");
  PackerBench::Setup wide = s;
  wide.slots = 3;
  CHECK(warps(wide) == "4:0 7:1 10:2 54:0");
}

TEST_CASE("warp_packer: stops while warp_out is full") {
  const PackerBench::Setup s{
      .coverage = {{0, tile(16)}, {0, tile(16)}}, .pace = {.from = 100, .period = 20}, .out = {.depth = 1}};
  CHECK(warps(s) == "100:0 120:1 140:2 160:3");
}

TEST_CASE("warp_packer: keeps the contract, one-deep links included") {
  PackerBench::Setup s{.coverage = {{0, tile(3)},
                                    {0, tile(16)},
                                    {0, boundary(TokenKind::kSync, 2)},
                                    {0, tile(5, 1)},
                                    {0, boundary(TokenKind::kDrawEnd)},
                                    {0, tile(9, 2)}},
                       .releases = {{40, {WarpSlotId(0)}},
                                    {60, {WarpSlotId(1)}},
                                    {70, {WarpSlotId(2)}},
                                    {80, {WarpSlotId(3)}},
                                    {90, {WarpSlotId(0)}}},
                       .slots = 2,
                       .patience = 7};
  CHECK(contract_text<PackerBench>(s) == "");
}
