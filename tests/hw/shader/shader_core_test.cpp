/// Shader core: cycles of a clause, SIMDs in parallel, and what is kept for fragments.
#include "hw/shader/shader_core.h"
#include "tests/hw/bench_stub.h"
#include "tests/hw/raster/triangles.h"

#include <catch2/catch.hpp>

#include <sstream>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct CoreBench final : Bench {
  struct Setup {
    std::string code = "output out0, r0\noutput out1, r0\noutput out2, r0\noutput out3, r0\n";
    std::vector<Timed<VertexWarpToken>> vertex{};
    std::vector<Timed<FragmentWarpToken>> fragment{};
    std::vector<Timed<TextureToken>> texels{};
    int simds = 4, simd_lanes = 8, sfu_lanes = 2, warp_slots = 32, rows = 1024;
    int alu_clk = 4, sfu_clk = 0, interp_clk = 0, const_clk = 0, branch_clk = 0;
    const SimdSharingPolicy* scheduler = &kOldestSharing;
    bool textured = false;
    models::Format format = models::Format::kUndefined;  ///< of the colour attachment; none
    int export_bytes_per_clk = 128;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  CoreBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), slots(static_cast<std::size_t>(s.warp_slots)), batches(8), warps(8), triangles(1) {
    vertex_program = models::assemble(
        ".stage vertex\n" + (s.vertex.empty() ? std::string("output out0, r0\n") : s.code) + "end\n",
        "vertex");
    fragment_program =
        models::assemble(".stage fragment\n.texture set=0 binding=0\n" + s.code + "end\n", "fragment");
    DrawState draw;
    draw.vertex.program = &vertex_program;
    draw.fragment.program = &fragment_program;
    draw.fragment.constants.assign(fragment_program.constants.words, 0);
    if (s.format != models::Format::kUndefined) {
      draw.color_outputs = 0xf;
      draw.pass = PassId(0);
      frame.passes.emplace_back();
      frame.passes[0].color[0].surface =
          models::allocate_surface(device, 8, 8, 1, models::format_info(s.format).bytes);
    }
    frame.draws = {draw};
    triangles[0] = flat_triangle({glm::ivec2{0, 0}, {0, 40}, {40, 0}});
    triangles[0].varyings.assign(3, 0);
    for (std::uint32_t i = 0; i < 8; ++i) {
      batches[i].lanes = 5;
      batches[i].outputs.resize(4);
      warps[WarpSlotId(i)].quads = 2;
      warps[WarpSlotId(i)].covered = 0x7f;
    }
    params.simds.set(s.simds);
    params.simd_lanes.set(s.simd_lanes);
    params.sfu_lanes.set(s.sfu_lanes);
    params.alu_clk.set(s.alu_clk);
    params.sfu_clk.set(s.sfu_clk);
    params.interp_clk.set(s.interp_clk);
    params.const_clk.set(s.const_clk);
    params.branch_clk.set(s.branch_clk);
    params.scheduler.set(*s.scheduler);
    params.warp_slots.set(s.warp_slots);
    params.export_bytes_per_clk.set(s.export_bytes_per_clk);
    params.register_rows.set(s.rows);
    unit = std::make_unique<ShaderCore>("unit", context(), params,
                                        ShaderCore::Stores{slots, batches, {&warps}, {&triangles}},
                                        ShaderCore::Neighbours{s.textured, false});
    add(*unit);
    feed(unit->vertex_in, s.vertex);
    feed(unit->fragment_in, s.fragment);
    vertex_done = &drain<VertexDoneToken>(
        *unit->vertex_out[0], [](const VertexDoneToken& t) { return t.slot; }, s.pace, s.out);
    fragment_done = &drain<FragmentDoneToken>(
        *unit->fragment_out[0], [](const FragmentDoneToken& t) { return t.slot.index(); }, s.pace, s.out);
    if (!s.textured) return;
    requests = &drain<TextureToken>(*unit->texture_out, [](const TextureToken& t) { return t.slot; });
    feed(*unit->texture_in, s.texels);
  }
  models::Program vertex_program, fragment_program;
  ShaderCore::Params params;
  Store<CoreSlot> slots;
  Store<BatchSlot> batches;
  WarpStore warps;
  TriangleStore triangles;
  std::unique_ptr<ShaderCore> unit;
  StubSink<VertexDoneToken>* vertex_done = nullptr;
  StubSink<FragmentDoneToken>* fragment_done = nullptr;
  StubSink<TextureToken>* requests = nullptr;
};

std::vector<Timed<VertexWarpToken>> vertices(std::uint32_t first, int count) {
  std::vector<Timed<VertexWarpToken>> all;
  all.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all.push_back({0, {DrawId(0), first + static_cast<std::uint32_t>(i)}});
  return all;
}
Timed<FragmentWarpToken> warp(std::int64_t cycle, int slot) {
  return {cycle, {DrawId(0), WarpSlotId(slot), PartitionId(0)}};
}
std::vector<Timed<FragmentWarpToken>> fragments(int first, int count) {
  std::vector<Timed<FragmentWarpToken>> all;
  all.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all.push_back(warp(0, first + i));
  return all;
}
std::string vertex_text(const CoreBench& b) { return b.vertex_done->text(); }

}  // namespace

TEST_CASE(
    "shader_core: a clause takes its instructions times 32 / simd_lanes and a cycle for its end, and waits "
    "for its last result") {
  for (const int lanes : {1, 8, 12, 32}) {
    for (const int latency : {0, 4, 50}) {
      const CoreBench::Setup s{.vertex = vertices(0, 1), .simd_lanes = lanes, .alu_clk = latency};
      // Accepted at 1, ready at 2; a sink sees the end one cycle after it. The last of four exports issues
      // after three.
      const int issue = (32 + lanes - 1) / lanes;
      CHECK(run<CoreBench>(s, vertex_text) ==
            fmt::format("{}:0", 2 + std::max(4 * issue + 1, 3 * issue + latency) + 1));
    }
  }
}

namespace {

/// Cycles from the first acceptance until the last of `warps` warps that run `code` is seen by a sink.
int cycles_of(CoreBench::Setup s, const std::string& code, int warps) {
  s.code = code;
  s.fragment = fragments(0, warps);
  const std::string text = run<CoreBench>(s, [](const CoreBench& b) { return b.fragment_done->text(); });
  int last = 0;
  std::istringstream in(text);
  for (std::string item; in >> item;) last = std::max(last, std::stoi(item));
  return last;
}
std::string repeated(const std::string& line, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += line;
  return all;
}
const std::string kDependent = "fmad r0, r0, r1, r2\n";
/// Eight results in turn, none read.
std::string independent(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += fmt::format("fmad r{}, r8, r9, r10\n", i % 8);
  return all;
}

}  // namespace

TEST_CASE("shader_core: a chain of dependent instructions takes its length times the distance of its class") {
  struct Case {
    std::string line;
    int CoreBench::Setup::*latency;
    int issue;
  };
  const std::vector<Case> cases{{kDependent, &CoreBench::Setup::alu_clk, 4},
                                {"frcp r0, r0\n", &CoreBench::Setup::sfu_clk, 16}};
  for (const Case& c : cases) {
    for (const int latency : {0, 3, 8, 32}) {
      CoreBench::Setup s{.simds = 1, .alu_clk = 0};
      s.*c.latency = latency;
      INFO(c.line << " latency " << latency);
      CHECK(cycles_of(s, repeated(c.line, 96), 1) - cycles_of(s, repeated(c.line, 32), 1) ==
            64 * std::max(c.issue, latency));
    }
  }
}

TEST_CASE("shader_core: varyings and indexed constants are there after the latencies of their classes") {
  // A value, and one instruction that reads it; then the value again, which waits for nothing.
  const auto period = [](const CoreBench::Setup& s, const std::string& head, const std::string& lines) {
    return cycles_of(s, head + repeated(lines, 24), 1) - cycles_of(s, head + repeated(lines, 8), 1);
  };
  for (const int latency : {0, 12, 40}) {
    const int expected = 16 * (std::max(4, latency) + 4);
    CHECK(period({.simds = 1, .alu_clk = 0, .interp_clk = latency}, ".varying perspective\n",
                 "interp r0, vary0\nieq r1, r0, r2\n") == expected);
    CHECK(period({.simds = 1, .alu_clk = 0, .const_clk = latency}, ".literal c0 1 2 3\n",
                 "loadconst r0, c1, r8, 2\nieq r2, r0, r3\n") == expected);
  }
}

TEST_CASE("shader_core: the colours of a warp leave after those of the one before, by their bytes") {
  // Seven fragments a warp. Without the way out, warps end a cycle apart: one is accepted a cycle.
  struct Case {
    models::Format format;
    int width, cycles;  ///< a warp
  };
  for (const Case& c : {Case{models::Format::kUndefined, 1, 1},
                        {models::Format::kR8G8B8A8Unorm, 28, 1},
                        {models::Format::kR8G8B8A8Unorm, 8, 4},
                        {models::Format::kR32G32B32A32Float, 8, 14},
                        {models::Format::kR8Unorm, 4, 2}}) {
    const CoreBench::Setup s{
        .fragment = fragments(0, 3), .format = c.format, .export_bytes_per_clk = c.width};
    const auto text = run<CoreBench>(s, [](const CoreBench& b) {
      return fmt::format("{} bytes {}", b.fragment_done->text(), counter(*b.unit, "exported_bytes"));
    });
    CHECK(text == fmt::format("20:0 {}:1 {}:2 bytes {}", 20 + c.cycles, 20 + 2 * c.cycles,
                              3 * 7 * models::format_info(c.format).bytes));
  }
}

TEST_CASE("shader_core: waiting for operands is counted apart from issuing") {
  CoreBench::Setup s{
      .code = repeated(kDependent, 10), .fragment = fragments(0, 1), .simds = 1, .alu_clk = 20};
  const auto text = run<CoreBench>(s, [](const CoreBench& b) {
    return fmt::format("{} {}", counter(*b.unit, "simd_busy"), counter(*b.unit, "operand_waits"));
  });
  CHECK(text == "41 144");  // ten of four cycles and the end; nine times sixteen
}

TEST_CASE("shader_core: independent instructions are bound by their issue, whatever the latency") {
  for (const int latency : {0, 8, 32}) {
    const CoreBench::Setup s{.simds = 1, .alu_clk = latency};
    CHECK(cycles_of(s, independent(96), 1) - cycles_of(s, independent(32), 1) == 64 * 4);
  }
}

TEST_CASE(
    "shader_core: other warps of a SIMD hide the latency of a chain up to its issue bound and no further") {
  constexpr int kLength = 64, kIssue = 4, kLatency = 17;
  for (const SimdSharingPolicy* scheduler : {&kOldestSharing, &kRoundRobinSharing}) {
    const CoreBench::Setup s{.simds = 1, .alu_clk = kLatency, .scheduler = scheduler};
    const int alone = cycles_of(s, repeated(kDependent, kLength), 1);
    for (const int warps : {1, 2, 3, 4, 8}) {
      // The oldest first: four fill the SIMD, and what comes after them begins when they end.
      const int rounds = scheduler == &kOldestSharing ? (warps + 3) / 4 : 1;
      const int expected = scheduler == &kOldestSharing
                               ? rounds * kLength * kLatency
                               : std::max(kLength * kLatency, warps * kLength * kIssue);
      INFO(warps << " warps, policy " << scheduler->name);
      CHECK(cycles_of(s, repeated(kDependent, kLength), warps) ==
            Approx(static_cast<double>(alone + expected - kLength * kLatency))
                .epsilon(warps <= 4 ? 0.02 : 0.05));  // what four leave of the SIMD goes to the fifth
    }
  }
}

TEST_CASE("shader_core: registers bound how many warps hide each other's latency") {
  constexpr int kLength = 64, kLatency = 17;
  // Sixteen registers a warp: rows for one, two and four of them; eight warps in all.
  const std::string code = repeated(kDependent, kLength) + "output out0, r15\n";
  const auto cycles = [&](int rows) {
    return cycles_of({.simds = 1, .rows = rows, .alu_clk = kLatency}, code, 8);
  };
  const int one = kLength * kLatency;
  CHECK(cycles(16) == Approx(static_cast<double>(8 * one)).epsilon(0.03));
  CHECK(cycles(32) == Approx(static_cast<double>(4 * one)).epsilon(0.03));
  CHECK(cycles(47) == cycles(32));
  CHECK(cycles(64) == Approx(static_cast<double>(2 * one)).epsilon(0.03));
  // four fill the SIMD: more registers gain nothing
  CHECK(cycles(128) == Approx(static_cast<double>(2 * one)).epsilon(0.03));
}

TEST_CASE("shader_core: a branch waits for its condition, and the next instruction for the branch") {
  const std::string before = "ine r3, r0, r1\n";
  const auto code = [&](int count) { return repeated(before + "if r3\nendif\n", count); };
  for (const int branch : {0, 7}) {
    const CoreBench::Setup s{.simds = 1, .alu_clk = 20, .branch_clk = branch};
    CHECK(cycles_of(s, code(24), 1) - cycles_of(s, code(8), 1) == 16 * (20 + std::max(1, branch) * 2));
  }
}

TEST_CASE("shader_core: special functions go through their own lanes") {
  const CoreBench::Setup s{.code = "frcp r0, r1\nfadd r0, r0, r0\noutput out0, r0\n",
                           .vertex = vertices(0, 1)};
  const auto text = run<CoreBench>(s, [](const CoreBench& b) {
    return fmt::format("{} sfu {} alu {} simd {}", b.vertex_done->text(),
                       counter(*b.unit, "sfu_instructions"), counter(*b.unit, "alu_instructions"),
                       counter(*b.unit, "simd_busy"));
  });
  CHECK(text == "28:0 sfu 1 alu 2 simd 25");  // 2 + 16 + 2 * 4 + 1, and one
}

TEST_CASE("shader_core: as many clauses run at a time as there are SIMDs, one warp is accepted a cycle") {
  CHECK(run<CoreBench>({.vertex = vertices(0, 3)}, vertex_text) == "20:0 21:1 22:2");
  CHECK(run<CoreBench>({.vertex = vertices(0, 3), .simds = 1}, vertex_text) == "20:0 37:1 54:2");
  CHECK(run<CoreBench>({.vertex = vertices(0, 3), .simds = 2}, vertex_text) == "20:0 21:1 37:2");
}

TEST_CASE("shader_core: a slot for one fragment warp is never given to vertex warps") {
  CoreBench::Setup s{.vertex = vertices(0, 3), .fragment = {warp(5, 7)}, .warp_slots = 2};
  const auto text = [](const CoreBench& b) {
    return fmt::format("{} | {}", b.vertex_done->text(), b.fragment_done->text());
  };
  // The next vertex warp is accepted the cycle the fragment warp ends: only then it leaves a slot free.
  CHECK(run<CoreBench>(s, text) == "20:0 43:1 61:2 | 25:7");
}

TEST_CASE("shader_core: registers for one fragment warp are never given to vertex warps") {
  CoreBench::Setup s{
      .code = "output out0, r15\n", .vertex = vertices(0, 2), .fragment = {warp(5, 7)}, .rows = 47};
  const auto text = [](const CoreBench& b) {
    return fmt::format("{} | {}", b.vertex_done->text(), b.fragment_done->text());
  };
  CHECK(run<CoreBench>(s, text) == "8:0 19:1 | 13:7");  // 16 rows each: two vertex warps would leave 15
  s.rows = 48;
  CHECK(run<CoreBench>(s, text) == "8:0 9:1 | 13:7");
}

TEST_CASE("shader_core: helper lanes run but are not fragments, and killed ones are reported dead") {
  const CoreBench::Setup s{.code = "input r0, primitive_id\nieq r0, r0, r1\nkillif r0\noutput out0, r0\n",
                           .fragment = fragments(3, 1)};
  const auto text = run<CoreBench>(s, [](const CoreBench& b) {
    return fmt::format("{} fragments {} helpers {} alive {:x}", b.fragment_done->text(),
                       counter(*b.unit, "fragments"), counter(*b.unit, "helper_lanes"),
                       b.warps[WarpSlotId(3)].alive);
  });
  CHECK(text == "17:3 fragments 7 helpers 1 alive 0");
}

TEST_CASE(
    "shader_core: a warp that waits for texels does not hold its SIMD, and goes on when they are there") {
  // Slots are given out from 0. A clause of one request (four cycles) and one of an export and the end
  // (five).
  const CoreBench::Setup s{.code = "tex r0, t0, r8, r9\noutput out0, r0\n",
                           .fragment = fragments(5, 2),
                           .texels = {{50, {1, DrawId(0)}}, {100, {0, DrawId(0)}}},
                           .simds = 1,
                           .textured = true};
  CHECK(run<CoreBench>(s, [](const CoreBench& b) {
          return b.requests->text() + " | " + b.fragment_done->text();
        }) == "7:0 11:1 | 57:6 107:5");
}

TEST_CASE("shader_core: waits while vertex_out is full") {
  CHECK(run<CoreBench>({.vertex = vertices(0, 3), .pace = {.from = 100, .period = 10}, .out = {.depth = 1}},
                       vertex_text) == "100:0 110:1 120:2");
}

TEST_CASE("shader_core: keeps the contract, one-deep links included") {
  const CoreBench::Setup s{.vertex = vertices(0, 4),
                           .fragment = fragments(0, 6),
                           .simds = 2,
                           .warp_slots = 3,
                           .pace = {.from = 0, .period = 9}};
  CHECK(contract_text<CoreBench>(s, false) == "");
}
