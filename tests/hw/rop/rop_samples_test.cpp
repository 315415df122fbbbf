/// ROP: passes of several samples a pixel, and what they are resolved to.
#include "tests/hw/rop/rop_bench.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

TEST_CASE("rop: a warp takes its quads once for each of their samples") {
  for (const auto& [samples, cycles] : {std::pair{1, 2}, {2, 4}, {4, 8}, {8, 16}}) {
    RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(2)}}, .done = {done(30, 0), done(30, 2)}};
    s.samples = samples;
    CHECK(run<RopBench>(s, released) == fmt::format("32:0 {}:2", 32 + cycles));
  }
}

TEST_CASE("rop: a pass of several samples is resolved from its cache, and only means reach memory") {
  RopBench::Setup s = whole_pass();
  s.samples = 4;
  s.store = models::StoreOp::kDiscard;
  const auto text = run<RopBench>(s, [](const RopBench& b) {
    return fmt::format("{} reads {} writes {} fences {} tiles {}", b.retired->text(),
                       b.memory->count(MemoryRequest::Kind::kRead),
                       b.memory->count(MemoryRequest::Kind::kWrite),
                       b.memory->count(MemoryRequest::Kind::kFence), counter(*b.unit, "resolved_tiles"));
  });
  // Depth is flushed at 300; a tile takes sixteen quads of four samples and of their mean at four a cycle, 20
  // cycles, two of them 40; then four lines leave, a fence, and its answer ten cycles later.
  CHECK(text.ends_with("reads 0 writes 4 fences 1 tiles 2"));
  const std::string plain = run<RopBench>(whole_pass(), [](const RopBench& b) { return b.retired->text(); });
  const auto end_of = [](const std::string& all) {
    const std::size_t end = all.find(':', all.rfind(' ', all.find("reads") - 2) + 1);
    return std::stoi(all.substr(all.rfind(' ', end) + 1));
  };
  CHECK(end_of(text) - end_of(plain) == Approx(41).margin(1));
}

TEST_CASE("rop: what nothing was drawn to is resolved without a look at its samples") {
  RopBench::Setup s{
      .order = {{0, kBegin}, {0, kPassEnd}}, .done = {}, .late = {{20, {TokenKind::kPassEnd, {}}}}};
  s.samples = 4;
  s.store = models::StoreOp::kDiscard;
  CHECK(run<RopBench>(s, [](const RopBench& b) {
          return fmt::format("reads {} writes {} clear {} pixel {:x}",
                             b.memory->count(MemoryRequest::Kind::kRead),
                             b.memory->count(MemoryRequest::Kind::kWrite), counter(*b.unit, "resolved_clear"),
                             models::detile(b.device, b.frame.passes[0].picture().surface)[0]);
        }) == "reads 0 writes 4 clear 2 pixel 80402010");
}

TEST_CASE("rop: a tile that nothing was drawn to moves nothing, also while others wait for their samples") {
  // The left tile is drawn by warps 0 and 2, the right one by none.
  RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(2)}, {0, kPassEnd}},
                    .done = {done(10, 0), done(10, 2)},
                    .late = {{100, {TokenKind::kPassEnd, {}}}}};
  s.samples = 4;
  s.store = models::StoreOp::kDiscard;
  s.lines = s.ways = 8;  // all of the left tile and no more: what is resolved drives samples out
  CHECK(run<RopBench>(s, [](const RopBench& b) {
          return fmt::format("tiles {} clear {} clears met {}", counter(*b.unit, "resolved_tiles"),
                             counter(*b.unit, "resolved_clear"), counter(*b.unit, "clear_hits"));
        }) == "tiles 2 clear 1 clears met 4");
}

TEST_CASE("rop: a cache of one line resolves to the same picture") {
  RopBench::Setup s = whole_pass();
  s.samples = 4;
  s.store = models::StoreOp::kDiscard;
  const auto picture = [](const RopBench& b) { return fmt::format("{:x}", b.image()); };
  const std::string expected = run<RopBench>(s, picture);
  s.lines = s.ways = s.misses = 1;
  CHECK(run<RopBench>(s, picture) == expected);
}
