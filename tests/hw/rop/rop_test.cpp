/// ROP: retirement in order, the time of a warp, the late test's detour, the flush.
#include "hw/rop/rop.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct RopBench final : Bench {
  struct Setup {
    std::vector<Timed<OrderToken>> order;
    std::vector<Timed<FragmentDoneToken>> done;
    std::vector<Timed<LateToken>> late{};
    bool blend = false, late_warps = false;
    models::LaneMask alive = ~0u;
    int lines = 256, ways = 8, misses = 32, memory_latency = 10;
    std::size_t colors = 1;
    int samples = 1;
    unsigned mask = ~0u;  ///< samples that the program has left
    models::LoadOp load = models::LoadOp::kClear;
    models::StoreOp store = models::StoreOp::kStore;
    models::Format format = models::Format::kR8G8B8A8Srgb;
    int half_blend_turns = 1, float_blend_turns = 1;
  };
  /// The target has two tiles; even warps write the upper half of the left one, odd warps two quads of each
  /// row of the right one.
  RopBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v), warps(4) {
    PassState pass;
    DrawState draw;
    for (std::size_t i = 0; i < s.colors; ++i) {
      pass.color[i].surface = models::allocate_surface(device, 16, 8, static_cast<std::uint32_t>(s.samples),
                                                       models::format_info(s.format).bytes);
      pass.color[i].format = s.format;
      if (s.samples > 1) {
        pass.resolve[i].surface = models::allocate_surface(device, 16, 8);
        pass.resolve[i].load = models::LoadOp::kLoad;
        pass.resolved |= 1u << i;
      }
      pass.color[i].clear = {{0x80402010}};
      pass.color[i].load = s.load;
      pass.color[i].store = s.store;
      draw.color_outputs |= 0xfu << 4 * i;
      draw.blend[i].enable = s.blend;
      draw.blend[i].dst_color = models::BlendFactor::kOneMinusSrcAlpha;
    }
    pass.colors = s.colors;
    pass.samples = s.samples;
    draw.setup.samples = models::sample_grid(s.samples, 8);
    frame.passes = {pass};
    frame.draws = {draw};
    for (std::uint32_t i = 0; i < 4; ++i) fill(warps[WarpSlotId(i)], i, s);
    set_cache(params, s.lines, s.ways, s.misses);
    params.half_blend_turns.set(s.half_blend_turns);
    params.float_blend_turns.set(s.float_blend_turns);
    unit = std::make_unique<Rop>("unit", context(), params, warps);
    add(*unit);
    feed(unit->order_in, s.order);
    feed(unit->done_in[0], s.done);
    feed(unit->late_in, s.late);
    late = &drain<LateToken>(unit->late_out, [](const LateToken& t) {
      return 100 * static_cast<unsigned>(t.kind) + t.slot.index();
    });
    released =
        &drain<WarpReleaseToken>(unit->release_out, [](const WarpReleaseToken& t) { return t.slot.index(); });
    drain<ReleaseToken>(unit->load_out, [](const ReleaseToken& t) { return t.slot; });
    synced = &drain<ReleaseToken>(unit->sync_out, [](const ReleaseToken& t) { return t.sequence; });
    retired = &drain<RetireToken>(unit->retire_out, [](const RetireToken& t) {
      return 100 * static_cast<unsigned>(t.kind) +
             (t.kind == TokenKind::kPassEnd ? t.part.pass().index() : t.part.draw().index());
    });
    memory = &serve(unit->memory_port(), s.memory_latency);
  }
  static void fill(WarpSlot& warp, std::uint32_t number, const Setup& s) {
    warp.quads = 8;
    warp.covered = ~0u;
    warp.alive = s.alive;
    warp.late = s.late_warps;
    warp.packed_samples = std::uint64_t{32} * static_cast<std::uint64_t>(s.samples);
    warp.samples.fill(static_cast<std::uint8_t>(((1u << s.samples) - 1) & s.mask));
    for (std::size_t q = 0; q < 8; ++q) {
      const auto i = static_cast<std::uint16_t>(q);
      if (number % 2 == 0)
        warp.quad[q] = {0, static_cast<std::uint16_t>(2 * (i % 4)), static_cast<std::uint16_t>(2 * (i / 4))};
      else
        warp.quad[q] = {0, static_cast<std::uint16_t>(8 + 4 * (i % 2)),
                        static_cast<std::uint16_t>(2 * (i / 2))};
    }
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t lane = 0; lane < 32; ++lane)
        for (std::size_t color = 0; color < s.colors; ++color)
          warp.color[color][c][lane] = static_cast<float>((7 * number + 3 * c + lane + color) % 16) / 16.0f;
    }
  }
  [[nodiscard]] std::uint64_t image() const {
    std::string bytes;
    if (frame.passes[0].colors == 0) return 0;
    for (const std::uint8_t byte : models::detile_rgba8(device, frame.passes[0].picture().surface))
      bytes += static_cast<char>(byte);
    return std::hash<std::string>{}(bytes);
  }
  [[nodiscard]] std::uint64_t digest() const override { return Bench::digest() ^ image(); }
  Rop::Params params;
  WarpStore warps;
  std::unique_ptr<Rop> unit;
  StubSink<LateToken>* late = nullptr;
  StubSink<WarpReleaseToken>* released = nullptr;
  StubSink<ReleaseToken>* synced = nullptr;
  StubSink<RetireToken>* retired = nullptr;
  StubMemory* memory = nullptr;
};

OrderToken warp(std::uint32_t slot, std::uint64_t sync = 0) {
  return {TokenKind::kWork, DrawId(0), WarpSlotId(slot), sync};
}
const OrderToken kBegin{TokenKind::kPassBegin, PassId(0), {}, 0},
    kDrawEnd{TokenKind::kDrawEnd, DrawId(0), {}, 0}, kPassEnd{TokenKind::kPassEnd, PassId(0), {}, 0};
/// The warp in this slot is shaded.
Timed<FragmentDoneToken> done(std::int64_t cycle, std::uint32_t slot) { return {cycle, {WarpSlotId(slot)}}; }
std::string released(const RopBench& b) { return b.released->text(); }

/// Four warps, all shaded by cycle 20, and the depth unit's answer to the flush at cycle 300.
RopBench::Setup whole_pass() {
  return {
      .order =
          {{0, kBegin}, {0, warp(0)}, {0, warp(1)}, {0, warp(2)}, {0, warp(3)}, {0, kDrawEnd}, {0, kPassEnd}},
      .done = {done(20, 2), done(20, 0), done(20, 3), done(20, 1)},
      .late = {{300, {TokenKind::kPassEnd, {}}}}};
}

}  // namespace

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
    return fmt::format("in {} discarded {}, late {}, written {} pixels {}", counter(*b.unit, "fragments_in"),
                       counter(*b.unit, "discarded"), counter(*b.unit, "late_discarded"),
                       counter(*b.unit, "written"), changed);
  });
  CHECK(text == "in 32 discarded 23, late 0, written 9 pixels 9");
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
