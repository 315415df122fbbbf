/// ROP: retirement in order, the time of a warp, the late test's detour, the flush.
#include "tests/hw/rop/rop_bench.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

TEST_CASE("rop: warps retire in order although the later one is shaded first") {
  const RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(1)}},
                          .done = {done(10, 1), done(30, 0)}};
  CHECK(run<RopBench>(s, released) == "32:0 34:1");  // eight quads at four a cycle
}

TEST_CASE(
    "rop: a warp takes its live quads divided by the rate, blending with the old colour takes twice that") {
  RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(2)}, {0, warp(0)}},
                    .done = {done(30, 0), done(30, 2)}};
  s.order.pop_back();
  s.order.push_back({0, kDrawEnd});
  const auto text = [](const RopBench& b) {
    return fmt::format("{} draw {}", b.released->text(), b.retired->text());
  };
  CHECK(run<RopBench>(s, text) == "32:0 34:2 draw 36:200");
  s.blend = true;
  CHECK(run<RopBench>(s, text) == "32:0 36:2 draw 40:200");
  s.alive = 0xff;
  CHECK(run<RopBench>(s, text) == "32:0 33:2 draw 34:200");
}

TEST_CASE("rop: blending floats takes the longer of the blender's turns and the path's") {
  using models::Format;
  struct Case {
    Format format;
    bool blend;
    int half_turns, float_turns, turns;
  };
  for (const Case& c : {Case{Format::kR16G16B16A16Float, true, 1, 9, 4},
                        {Format::kR16G16B16A16Float, true, 5, 1, 5},
                        {Format::kR16G16B16A16Float, false, 5, 1, 2},
                        {Format::kR16G16Float, true, 5, 1, 5},
                        {Format::kB10G11R11Ufloat, true, 5, 1, 5},
                        {Format::kR32G32Float, true, 9, 3, 6},
                        {Format::kR32G32B32A32Float, true, 1, 3, 12},
                        {Format::kR8G8B8A8Unorm, true, 5, 5, 2}}) {
    INFO(models::format_info(c.format).name);
    RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}, {0, warp(2)}}, .done = {done(60, 0), done(60, 2)}};
    s.format = c.format;
    s.blend = c.blend;
    s.half_blend_turns = c.half_turns;
    s.float_blend_turns = c.float_turns;
    CHECK(run<RopBench>(s, released) ==
          fmt::format("62:0 {}:2", 62 + 2 * c.turns));  // eight quads, four a turn
  }
}

TEST_CASE("rop: fragments that were discarded are counted and not written") {
  RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}}, .done = {done(10, 0)}, .alive = 0x0000ff01};
  const auto text = run<RopBench>(s, [](const RopBench& b) {
    int changed = 0;
    for (const std::uint32_t pixel : models::detile(b.device, b.frame.passes[0].color[0].surface))
      changed += static_cast<int>(pixel != 0x80402010);
    return fmt::format("in {} with {} bytes discarded {}, late {}, written {} pixels {}",
                       counter(*b.unit, "fragments_in"), counter(*b.unit, "bytes_in"),
                       counter(*b.unit, "discarded"), counter(*b.unit, "late_discarded"),
                       counter(*b.unit, "written"), changed);
  });
  CHECK(text == "in 32 with 36 bytes discarded 23, late 0, written 9 pixels 9");
}

TEST_CASE("rop: what a program discards of a warp that is tested late is counted by itself") {
  const RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0)}},
                          .done = {done(10, 0)},
                          .late = {{50, {TokenKind::kWork, WarpSlotId(0)}}},
                          .late_warps = true,
                          .alive = 0x0000ff01};
  CHECK(run<RopBench>(s, [](const RopBench& b) {
          return fmt::format("discarded {}, late {}", counter(*b.unit, "discarded"),
                             counter(*b.unit, "late_discarded"));
        }) == "discarded 23, late 23");
}

TEST_CASE("rop: samples that a program takes from its fragments are counted and not written") {
  const auto text = [](const RopBench& b) {
    return fmt::format("{} discarded {}, late {}, samples discarded {} written {}", b.released->text(),
                       counter(*b.unit, "discarded"), counter(*b.unit, "late_discarded"),
                       counter(*b.unit, "samples_discarded"), counter(*b.unit, "samples_written"));
  };
  RopBench::Setup s{
      .order = {{0, kBegin}, {0, warp(0)}, {0, warp(1)}, {0, kDrawEnd}},
      .done = {done(10, 0), done(10, 1)},
      .late = {{50, {TokenKind::kWork, WarpSlotId(0)}}, {50, {TokenKind::kWork, WarpSlotId(1)}}},
      .samples = 4,
      .mask = 0x5};
  s.late.clear();
  CHECK(run<RopBench>(s, text) == "12:0 16:1 discarded 0, late 0, samples discarded 128 written 128");
  s.late = {{50, {TokenKind::kWork, WarpSlotId(0)}}, {50, {TokenKind::kWork, WarpSlotId(1)}}};
  s.late_warps = true;
  s.alive = 0x0000ffff;
  CHECK(run<RopBench>(s, text) == "52:0 54:1 discarded 32, late 192, samples discarded 192 written 64");
}

TEST_CASE("rop: a late-tested warp is sent when it is shaded and retires when its answer is there") {
  const RopBench::Setup s{
      .order = {{0, kBegin}, {0, warp(0)}, {0, warp(1)}},
      .done = {done(10, 1), done(20, 0)},
      .late = {{50, {TokenKind::kWork, WarpSlotId(0)}}, {80, {TokenKind::kWork, WarpSlotId(1)}}},
      .late_warps = true};
  const auto text = run<RopBench>(
      s, [](const RopBench& b) { return fmt::format("{} | {}", b.late->text(), b.released->text()); });
  CHECK(text == "22:0 23:1 | 52:0 82:1");
}

TEST_CASE("rop: a sync is reported when its warp retires, a lone one in its turn") {
  const RopBench::Setup s{.order = {{0, kBegin}, {0, warp(0, 5)}, {0, {TokenKind::kSync, DrawId(0), {}, 9}}},
                          .done = {done(30, 0)}};
  CHECK(run<RopBench>(s, [](const RopBench& b) { return b.synced->text(); }) == "32:5 34:9");
}

TEST_CASE("rop: a pass ends when depth is flushed, every line is written and the fence is answered") {
  const auto text = run<RopBench>(whole_pass(), [](const RopBench& b) {
    return fmt::format("{} writes {} reads {} fences {} dirty {}", b.retired->text(),
                       b.memory->count(MemoryRequest::Kind::kWrite),
                       b.memory->count(MemoryRequest::Kind::kRead),
                       b.memory->count(MemoryRequest::Kind::kFence), b.device.dirty_lines());
  });
  // The answer is seen at 301, four writes and the fence arrive at 302..306, the fence's answer at 317; a
  // sink sees the rest one later.
  CHECK(text == "30:200 318:400 writes 4 reads 0 fences 1 dirty 0");
}

TEST_CASE("rop: a tile that was only cleared is written by the flush") {
  const RopBench::Setup s{
      .order = {{0, kBegin}, {0, kPassEnd}}, .done = {}, .late = {{50, {TokenKind::kPassEnd, {}}}}};
  const auto text = run<RopBench>(s, [](const RopBench& b) {
    return fmt::format("{} cleared {} written {} requests {}", b.retired->text(),
                       counter(*b.unit, "fast_cleared_tiles"), counter(*b.unit, "clear_writes"),
                       b.memory->count(MemoryRequest::Kind::kWrite));
  });
  CHECK(text == "68:400 cleared 2 written 2 requests 4");
}

TEST_CASE("rop: a warp that covers a sector in part reads nothing, unless it blends") {
  auto s = whole_pass();
  s.alive = 0x7fffffff;
  s.lines = s.ways = 2;  // of four: lines are evicted and come back, after the first time not as cleared ones
  const auto reads = [](const RopBench& b) {
    return fmt::format("{}", b.memory->count(MemoryRequest::Kind::kRead));
  };
  CHECK(run<RopBench>(s, reads) == "0");
  s.blend = true;
  CHECK(run<RopBench>(s, reads) == "3");
}

TEST_CASE("rop: a colour cache of one line gets through, and to the same image") {
  for (const bool blend : {false, true}) {
    auto s = whole_pass();
    s.blend = blend;
    s.alive = 0x7fffffff;  // the last sector is completed from memory
    const auto text = [](const RopBench& b) {
      return fmt::format("{} warps {} dirty {:x}", counter(*b.unit, "warps"), b.device.dirty_lines(),
                         b.image());
    };
    const auto expected = run<RopBench>(s, text);
    CHECK_THAT(expected, Catch::StartsWith("4 warps 0 dirty "));
    s.lines = s.ways = s.misses = 1;
    CHECK(run<RopBench>(s, text) == expected);
  }
}

TEST_CASE("rop: each colour attachment that the program writes takes its own cycles, lines and flush") {
  auto s = whole_pass();
  s.colors = 3;
  const auto text = [](const RopBench& b) {
    return fmt::format("{} pixels {} fragments {} cleared {} writes {}", b.released->text(),
                       counter(*b.unit, "pixels_written"), counter(*b.unit, "written"),
                       counter(*b.unit, "fast_cleared_tiles"), b.memory->count(MemoryRequest::Kind::kWrite));
  };
  // Eight quads of three attachments at four a cycle: six cycles a warp. Three times the four lines.
  CHECK(run<RopBench>(s, text) == "22:0 28:1 34:2 40:3 pixels 384 fragments 128 cleared 6 writes 12");
}

TEST_CASE("rop: a surface that is loaded is read where it is blended, and has no cleared tiles") {
  auto s = whole_pass();
  s.load = models::LoadOp::kLoad;
  const auto text = [](const RopBench& b) {
    return fmt::format("cleared {} reads {} writes {} parts {}", counter(*b.unit, "fast_cleared_tiles"),
                       b.memory->count(MemoryRequest::Kind::kRead),
                       b.memory->count(MemoryRequest::Kind::kWrite),
                       b.memory->count(MemoryRequest::Kind::kWritePart));
  };
  // Warps 0 and 2 cover one line whole, 1 and 3 half of each sector of two lines.
  CHECK(run<RopBench>(s, text) == "cleared 0 reads 0 writes 1 parts 2");
  s.blend = true;
  CHECK(run<RopBench>(s, text) == "cleared 0 reads 3 writes 3 parts 0");
}

TEST_CASE("rop: a surface that is discarded writes nothing back, and leaves no dirty line") {
  auto s = whole_pass();
  s.store = models::StoreOp::kDiscard;
  const auto text = run<RopBench>(s, [](const RopBench& b) {
    return fmt::format("writes {} fences {} dirty {}", b.memory->count(MemoryRequest::Kind::kWrite),
                       b.memory->count(MemoryRequest::Kind::kFence), b.device.dirty_lines());
  });
  CHECK(text == "writes 0 fences 1 dirty 0");
}

TEST_CASE("rop: a pass without colours retires its warps and writes nothing") {
  auto s = whole_pass();
  s.colors = 0;
  const auto text = run<RopBench>(s, [](const RopBench& b) {
    return fmt::format("{} written {} pixels {} writes {}", b.released->text(), counter(*b.unit, "written"),
                       counter(*b.unit, "pixels_written"), b.memory->count(MemoryRequest::Kind::kWrite));
  });
  CHECK(text == "22:0 23:1 24:2 25:3 written 128 pixels 0 writes 0");
}

TEST_CASE("rop: keeps the contract, one-deep links and a cache of one line included") {
  auto s = whole_pass();
  s.blend = true;
  CHECK(contract_text<RopBench>(s) == "");
  s.lines = s.ways = s.misses = 1;
  CHECK(contract_text<RopBench>(s) == "");
  s.colors = 2;
  s.load = models::LoadOp::kLoad;
  CHECK(contract_text<RopBench>(s) == "");
}
