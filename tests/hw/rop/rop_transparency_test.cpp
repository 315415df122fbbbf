/// ROP: order-independent draws, whose fragments it keeps until their pass ends.
#include "tests/hw/rop/rop_bench.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

RopBench::Setup kept_pass(models::Transparency mode, int layers, int samples = 1) {
  RopBench::Setup s = whole_pass();
  s.transparency = {mode, static_cast<std::uint8_t>(layers)};
  s.samples = samples;
  if (samples > 1) s.store = models::StoreOp::kDiscard;
  s.late[0].cycle = 20'000;  // behind all warps, however small the cache
  return s;
}
constexpr auto kLists = models::Transparency::kAbuffer, kLayers = models::Transparency::kKbuffer;

std::string picture(const RopBench& b) { return fmt::format("{:x}", b.image()); }

std::string counts(const RopBench& b) {
  return fmt::format("nodes {} merged {} lost {} composed {} tiles {} blended {}", counter(*b.unit, "nodes"),
                     counter(*b.unit, "nodes_merged"), counter(*b.unit, "nodes_lost"),
                     counter(*b.unit, "nodes_composed"), counter(*b.unit, "composed_tiles"),
                     counter(*b.unit, "blended"));
}

/// Cycle at which the pass is over.
int end_of(const RopBench& b) {
  const std::string text = b.retired->text();
  return std::stoi(text.substr(text.rfind(' ') + 1));
}

}  // namespace

TEST_CASE("rop: warps go to lists at eight turns a quad, however many samples") {
  // Eight quads of eight turns at four a cycle.
  for (const int samples : {1, 2, 8}) {
    RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(2)}}, .done = {done(30, 0), done(30, 2)}};
    s.samples = samples;
    s.transparency = {kLists, 16};
    CHECK(run<RopBench>(s, released) == "32:0 48:2");
  }
}

TEST_CASE("rop: warps go to layers at eight turns a quad, layer and sample") {
  for (const auto& [layers, samples] : {std::pair{1, 1}, {2, 1}, {8, 1}, {1, 4}, {3, 2}}) {
    RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(2)}}, .done = {done(30, 0), done(30, 2)}};
    s.samples = samples;
    s.transparency = {kLayers, static_cast<std::uint8_t>(layers)};
    s.lines = 1024;
    s.ways = 64;
    CHECK(run<RopBench>(s, released) == fmt::format("32:0 {}:2", 32 + 16 * layers * samples));
  }
}

TEST_CASE("rop: what is kept is composed when the pass ends, and counted") {
  // A pixel of a tile meets two warps or none.
  CHECK(run<RopBench>(kept_pass(kLists, 16), counts) ==
        "nodes 128 merged 0 lost 0 composed 128 tiles 2 blended 0");
  CHECK(run<RopBench>(kept_pass(kLists, 1), counts) ==
        "nodes 128 merged 0 lost 64 composed 64 tiles 2 blended 0");
  CHECK(run<RopBench>(kept_pass(kLayers, 2, 4), counts) ==
        "nodes 512 merged 0 lost 0 composed 512 tiles 2 blended 0");
  CHECK(run<RopBench>(kept_pass(kLayers, 1), counts) ==
        "nodes 128 merged 64 lost 0 composed 64 tiles 2 blended 0");
}

TEST_CASE("rop: composing takes the turns of its nodes and colours") {
  // A tile has eight quads with nodes of one sample. Each takes two turns for its colours and four a level.
  const auto took = [](const RopBench::Setup& s) {
    return run<RopBench>(s, [](const RopBench& b) { return fmt::format("{}", end_of(b)); });
  };
  const int plain = std::stoi(took(kept_pass(models::Transparency::kNone, 0)));
  for (const int layers : {1, 2, 4}) {
    const int cycles = std::stoi(took(kept_pass(kLayers, layers))) - plain;
    CHECK(cycles == Approx(2 * 8 * (2 + 4 * layers) / 4).margin(3));
  }
  // Two tiles: their heads in a cycle each; two levels of thirty-two nodes a tile, eight a line, a line a
  // cycle; then two levels a quad. The first tile is composed while the second one is not walked.
  const int cycles = std::stoi(took(kept_pass(kLists, 16))) - plain;
  CHECK(cycles == Approx(2 * (1 + 2 * 4) + 2 * 8 * (2 + 4 * 2) / 4).margin(4));
}

TEST_CASE("rop: nothing of what is kept is left in caches or reaches memory where it fits the cache") {
  const auto traffic = [](const RopBench& b) {
    return fmt::format("reads {} writes {}", b.memory->count(MemoryRequest::Kind::kRead),
                       b.memory->count(MemoryRequest::Kind::kWrite));
  };
  CHECK(run<RopBench>(kept_pass(kLists, 16), traffic) == "reads 0 writes 4");
  CHECK(run<RopBench>(kept_pass(kLayers, 4), traffic) == "reads 0 writes 4");
}

TEST_CASE("rop: the smallest caches give the same pictures of kept fragments") {
  for (const models::Transparency mode : {kLists, kLayers}) {
    for (const int samples : {1, 4}) {
      RopBench::Setup s = kept_pass(mode, 2, samples);
      const std::string expected = run<RopBench>(s, picture);
      s.lines = s.ways = s.misses = 1;
      CHECK(run<RopBench>(s, picture) == expected);
      s.lines = 8;
      s.ways = 2;
      s.misses = 2;
      CHECK(run<RopBench>(s, picture) == expected);
    }
  }
}

TEST_CASE("rop: lists show what layers show that are enough") {
  CHECK(run<RopBench>(kept_pass(kLists, 16), picture) == run<RopBench>(kept_pass(kLayers, 2), picture));
}

TEST_CASE("rop: keeps the contract with kept fragments, one-deep links and a cache of one line included") {
  for (const models::Transparency mode : {kLists, kLayers}) {
    RopBench::Setup s = kept_pass(mode, 2);
    CHECK(contract_text<RopBench>(s) == "");
    s.lines = s.ways = s.misses = 1;
    CHECK(contract_text<RopBench>(s) == "");
  }
}
