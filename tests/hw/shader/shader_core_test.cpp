/// Shader core: cycles of a clause, SIMDs in parallel, and what is kept for fragments.
#include "hw/shader/shader_core.h"
#include "tests/hw/bench_stub.h"
#include "tests/hw/raster/triangles.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct CoreBench final : Bench {
  struct Setup {
    std::string code = "output out0, r0\noutput out1, r0\noutput out2, r0\noutput out3, r0\n";
    std::vector<Timed<WarpToken>> vertex{}, fragment{};
    std::vector<Timed<TextureToken>> texels{};
    int simds = 4, simd_lanes = 8, sfu_lanes = 2, alu_clk = 4, warp_slots = 32, rows = 1024;
    bool textured = false;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  CoreBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), slots(static_cast<std::size_t>(s.warp_slots)), batches(8), warps(8), triangles(1) {
    vertex_program =
        models::assemble(".stage vertex\n" + (s.vertex.empty() ? std::string("output out0, r0\n") : s.code) + "end\n", "vertex");
    fragment_program = models::assemble(".stage fragment\n.texture set=0 binding=0\n" + s.code + "end\n", "fragment");
    DrawState draw;
    draw.vertex_program = &vertex_program;
    draw.fragment_program = &fragment_program;
    frame.draws = {draw};
    triangles[0] = flat_triangle({glm::ivec2{0, 0}, {0, 40}, {40, 0}});
    for (std::uint32_t i = 0; i < 8; ++i) {
      batches[i].lanes = 5;
      batches[i].outputs.resize(4);
      warps[i].quads = 2;
      warps[i].covered = 0x7f;
    }
    params.simds.set(s.simds);
    params.simd_lanes.set(s.simd_lanes);
    params.sfu_lanes.set(s.sfu_lanes);
    params.alu_clk.set(s.alu_clk);
    params.warp_slots.set(s.warp_slots);
    params.register_rows.set(s.rows);
    unit = std::make_unique<ShaderCore>("unit", params, clock, frame, slots, batches, std::vector<Store<WarpSlot>*>{&warps}, triangles,
                                        s.textured);
    add(*unit);
    feed(unit->vertex_in, s.vertex);
    feed(unit->fragment_in, s.fragment);
    vertex_done = &drain<VertexDoneToken>(
        unit->vertex_out, [](const VertexDoneToken& t) { return t.slot; }, s.pace, s.out);
    fragment_done = &drain<FragmentDoneToken>(
        *unit->fragment_out[0], [](const FragmentDoneToken& t) { return t.slot; }, s.pace, s.out);
    if (!s.textured) return;
    requests = &drain<TextureToken>(*unit->texture_out, [](const TextureToken& t) { return t.slot; });
    feed(*unit->texture_in, s.texels);
  }
  models::Program vertex_program, fragment_program;
  Frame frame;
  ShaderCore::Params params;
  Store<CoreSlot> slots;
  Store<BatchSlot> batches;
  Store<WarpSlot> warps;
  TriangleStore triangles;
  std::unique_ptr<ShaderCore> unit;
  StubSink<VertexDoneToken>* vertex_done = nullptr;
  StubSink<FragmentDoneToken>* fragment_done = nullptr;
  StubSink<TextureToken>* requests = nullptr;
};

std::vector<Timed<WarpToken>> work(std::uint32_t first, int count) {
  std::vector<Timed<WarpToken>> all;
  for (int i = 0; i < count; ++i) all.push_back({0, {0, first + static_cast<std::uint32_t>(i), 0}});
  return all;
}
std::string vertex_text(const CoreBench& b) { return b.vertex_done->text(); }

}  // namespace

TEST_CASE("shader_core: a clause takes its instructions times 32 / simd_lanes and a cycle for its end, its results alu_clk more") {
  for (const int lanes : {1, 8, 12, 32}) {
    for (const int latency : {0, 4}) {
      const CoreBench::Setup s{.vertex = work(0, 1), .simd_lanes = lanes, .alu_clk = latency};
      // Accepted at 1, ready at 2; a sink sees the end one cycle after it.
      CHECK(run<CoreBench>(s, vertex_text) == fmt::format("{}:0", 2 + 4 * ((32 + lanes - 1) / lanes) + 1 + latency + 1));
    }
  }
}

TEST_CASE("shader_core: special functions go through their own lanes") {
  const CoreBench::Setup s{.code = "frcp r0, r1\nfadd r0, r0, r0\noutput out0, r0\n", .vertex = work(0, 1)};
  const auto text = run<CoreBench>(s, [](const CoreBench& b) {
    return fmt::format("{} sfu {} alu {} simd {}", b.vertex_done->text(), counter(*b.unit, "sfu_instructions"),
                       counter(*b.unit, "alu_instructions"), counter(*b.unit, "simd_busy"));
  });
  CHECK(text == "32:0 sfu 1 alu 2 simd 25");  // 2 + 16 + 2 * 4 + 1 + 4, and one
}

TEST_CASE("shader_core: as many clauses run at a time as there are SIMDs, one warp is accepted a cycle") {
  CHECK(run<CoreBench>({.vertex = work(0, 3)}, vertex_text) == "24:0 25:1 26:2");
  CHECK(run<CoreBench>({.vertex = work(0, 3), .simds = 1}, vertex_text) == "24:0 41:1 58:2");
  CHECK(run<CoreBench>({.vertex = work(0, 3), .simds = 2}, vertex_text) == "24:0 25:1 41:2");
}

TEST_CASE("shader_core: a slot for one fragment warp is never given to vertex warps") {
  CoreBench::Setup s{.vertex = work(0, 3), .fragment = {{5, {0, 7, 0}}}, .warp_slots = 2};
  const auto text = [](const CoreBench& b) { return fmt::format("{} | {}", b.vertex_done->text(), b.fragment_done->text()); };
  // The next vertex warp is accepted the cycle the fragment warp ends: only then it leaves a slot free.
  CHECK(run<CoreBench>(s, text) == "24:0 51:1 73:2 | 29:7");
}

TEST_CASE("shader_core: registers for one fragment warp are never given to vertex warps") {
  CoreBench::Setup s{.code = "output out0, r15\n", .vertex = work(0, 2), .fragment = {{5, {0, 7, 0}}}, .rows = 47};
  const auto text = [](const CoreBench& b) { return fmt::format("{} | {}", b.vertex_done->text(), b.fragment_done->text()); };
  CHECK(run<CoreBench>(s, text) == "12:0 27:1 | 17:7");  // 16 rows each: two vertex warps would leave 15
  s.rows = 48;
  CHECK(run<CoreBench>(s, text) == "12:0 13:1 | 17:7");
}

TEST_CASE("shader_core: helper lanes run but are not fragments, and killed ones are reported dead") {
  const CoreBench::Setup s{.code = "input r0, primitive_id\nieq r0, r0, r1\nkillif r0\noutput out0, r0\n", .fragment = work(3, 1)};
  const auto text = run<CoreBench>(s, [](const CoreBench& b) {
    return fmt::format("{} fragments {} helpers {} alive {:x}", b.fragment_done->text(), counter(*b.unit, "fragments"),
                       counter(*b.unit, "helper_lanes"), b.warps[3].alive);
  });
  CHECK(text == "21:3 fragments 7 helpers 1 alive 0");
}

TEST_CASE("shader_core: a warp that waits for texels does not hold its SIMD, and goes on when they are there") {
  // Slots are given out from 0. A clause of one request (four cycles) and one of an export and the end (five), with four of latency.
  const CoreBench::Setup s{.code = "tex r0, t0, r8, r9\noutput out0, r0\n",
                           .fragment = work(5, 2),
                           .texels = {{50, {1, 0, false}}, {100, {0, 0, false}}},
                           .simds = 1,
                           .textured = true};
  CHECK(run<CoreBench>(s, [](const CoreBench& b) { return b.requests->text() + " | " + b.fragment_done->text(); }) ==
        "11:0 15:1 | 61:6 111:5");
}

TEST_CASE("shader_core: waits while vertex_out is full") {
  CHECK(run<CoreBench>({.vertex = work(0, 3), .pace = {.from = 100, .period = 10}, .out = {.depth = 1}}, vertex_text) ==
        "100:0 110:1 120:2");
}

TEST_CASE("shader_core: keeps the contract, one-deep links included") {
  const CoreBench::Setup s{.vertex = work(0, 4), .fragment = work(0, 6), .simds = 2, .warp_slots = 3, .pace = {.from = 0, .period = 9}};
  CHECK(contract_text<CoreBench>(s, false) == "");
}
