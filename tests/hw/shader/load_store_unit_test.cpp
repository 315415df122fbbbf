/// Load-store unit: latency of hits and misses, lines a cycle, stores that pass through, atomic operations
/// that follow each other, answers in order.
#include "hw/shader/load_store_unit.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr int kMemory = 50;
using models::Op;

/// Byte offsets 0, stride, 2 stride, ... by lane.
struct Access {
  Op op = Op::kLoadBuffer;
  std::uint32_t first = 0, stride = 4;
  models::LaneMask lanes = ~0u;
};

struct StorageBench final : Bench {
  struct Setup {
    std::vector<Timed<StorageToken>> requests;
    std::vector<Access> accesses;  ///< by core slot
    int groups = 32, queued = 32, lines_per_clk = 1, lines = 128, ways = 4, misses = 32, response_clk = 8;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  /// One buffer of 64 KiB at a multiple of a line; draws 0 and 1 are of passes 0 and 1.
  StorageBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), slots(s.accesses.size()) {
    DrawState draw;
    draw.fragment.buffers = {{device.allocate(1 << 16), 1 << 16, models::StorageView::kReadOnly}};
    frame.draws = {draw, draw};
    frame.draws[1].pass = PassId(1);
    frame.passes.resize(2);
    for (std::size_t i = 0; i < s.accesses.size(); ++i) {
      models::StorageRequest& request = slots[i].warp.accesses[0];
      slots[i].warp.access_count = 1;
      request.op = s.accesses[i].op;
      request.active = s.accesses[i].lanes;
      for (std::uint32_t lane = 0; lane < models::kWarpLanes; ++lane)
        request.offset[lane] = s.accesses[i].first + s.accesses[i].stride * lane;
    }
    params.groups_in_flight.set(s.groups);
    params.requests_queued.set(s.queued);
    params.lines_per_clk.set(s.lines_per_clk);
    params.response_clk.set(s.response_clk);
    set_cache(params, s.lines, s.ways, s.misses);
    unit = std::make_unique<LoadStoreUnit>("unit", context(), params, slots);
    add(*unit);
    feed(unit->request_in, s.requests);
    sink = &drain<StorageToken>(
        unit->response_out, [](const StorageToken& t) { return t.slot; }, s.pace, s.out);
    memory = &serve(unit->memory_port(), kMemory);
  }
  LoadStoreUnit::Params params;
  Store<CoreSlot> slots;
  std::unique_ptr<LoadStoreUnit> unit;
  StubSink<StorageToken>* sink = nullptr;
  StubMemory* memory = nullptr;
};

StorageToken slot(std::uint32_t i, std::uint32_t draw = 0) {
  return {i, DrawId(draw), models::ShaderStage::kFragment};
}
std::string answers(const StorageBench& b) { return b.sink->text(); }

}  // namespace

TEST_CASE(
    "load_store_unit: a load that misses takes the memory's time, a hit a line's cycle, both the answer's") {
  for (const int response : {0, 8, 20}) {
    const StorageBench::Setup s{
        .requests = {{0, slot(0)}, {200, slot(0)}}, .accesses = {{}}, .response_clk = response};
    const auto text = run<StorageBench>(s, [](const StorageBench& b) {
      return fmt::format("{} {} hits {} misses {} read {}", b.sink->text(), b.memory->text(),
                         counter(*b.unit, "cache_hits"), counter(*b.unit, "cache_misses"),
                         counter(*b.unit, "read_bytes"));
    });
    // Taken at 1, asked for at 2, there at 3 + memory. The sink sees it one cycle later.
    CHECK(text == fmt::format("{}:0 {}:0 2:r0/f hits 1 misses 1 read 128", 3 + kMemory + response + 1,
                              201 + 1 + response + 1));
  }
}

TEST_CASE("load_store_unit: lines go through at lines_per_clk") {
  for (const int rate : {1, 2, 4}) {
    const StorageBench::Setup s{.requests = {{0, slot(0)}, {200, slot(0)}, {200, slot(0)}, {200, slot(0)}},
                                .accesses = {{.stride = 128}},
                                .lines_per_clk = rate};
    const auto text = run<StorageBench>(s, answers);
    const int cycles = 32 / rate, first = 201 + cycles + 8 + 1;
    CHECK(text.substr(text.find(' ') + 1) ==
          fmt::format("{}:0 {}:0 {}:0", first, first + cycles, first + 2 * cycles));
  }
}

TEST_CASE("load_store_unit: stores pass through, whole sectors and parts apart, and are not waited for") {
  const StorageBench::Setup s{.requests = {{0, slot(0)}, {100, slot(1)}},
                              .accesses = {{.op = Op::kStoreBuffer, .first = 16, .lanes = 0xffff},
                                           {.op = Op::kStoreBuffer, .stride = 4, .lanes = 0xff}}};
  const auto text = run<StorageBench>(s, [](const StorageBench& b) {
    return fmt::format("{} {} written {} stores {}", b.sink->text(), b.memory->text(),
                       counter(*b.unit, "write_bytes"), counter(*b.unit, "stores"));
  });
  CHECK(text == "11:0 111:1 2:w0/2 3:p0/5 102:w0/1 written 128 stores 24");
}

TEST_CASE("load_store_unit: atomic operations on one word are as many requests, on neighbours one") {
  const StorageBench::Setup s{.requests = {{0, slot(0)}, {300, slot(1)}},
                              .accesses = {{.op = Op::kAtomicAdd, .stride = 0}, {.op = Op::kAtomicAdd}},
                              .queued = 64};
  const auto text = run<StorageBench>(s, [](const StorageBench& b) {
    return fmt::format("{} requests {} bytes {} {}", b.sink->text(),
                       b.memory->count(MemoryRequest::Kind::kAtomic), counter(*b.unit, "read_bytes"),
                       counter(*b.unit, "write_bytes"));
  });
  // The memory takes one a cycle: the last of 32 at 33, answered 50 later, seen one cycle later.
  CHECK(text == fmt::format("{}:0 {}:1 requests 33 bytes {} {}", 33 + kMemory + 1 + 8 + 1,
                            302 + kMemory + 1 + 8 + 1, 32 * 32 + 128, 32 * 32 + 128));
}

TEST_CASE("load_store_unit: a group behind a miss is moved at once and answered in order") {
  const StorageBench::Setup s{.requests = {{0, slot(0)}, {100, slot(1)}, {100, slot(0)}, {100, slot(2)}},
                              .accesses = {{}, {.first = 4096}, {.op = Op::kStoreBuffer, .first = 8192}}};
  const auto text = run<StorageBench>(
      s, [](const StorageBench& b) { return fmt::format("{} | {}", b.sink->text(), b.memory->text()); });
  CHECK(text == "62:0 162:1 163:0 164:2 | 2:r0/f 102:r32/f 104:w64/f");
}

TEST_CASE("load_store_unit: a new pass reads what the cache held again") {
  const StorageBench::Setup s{.requests = {{0, slot(0)}, {100, slot(0)}, {200, slot(0, 1)}},
                              .accesses = {{}}};
  CHECK(run<StorageBench>(s, [](const StorageBench& b) { return b.memory->text(); }) == "2:r0/f 202:r0/f");
}

TEST_CASE("load_store_unit: no more groups are under way, and no more requests queued, than allowed") {
  const StorageBench::Setup one{
      .requests = {{0, slot(0)}, {0, slot(1)}}, .accesses = {{}, {.first = 4096}}, .groups = 1};
  CHECK(run<StorageBench>(one, answers) == "62:0 122:1");
  const StorageBench::Setup queue{
      .requests = {{0, slot(0)}}, .accesses = {{.op = Op::kStoreBuffer, .stride = 128}}, .queued = 1};
  CHECK(run<StorageBench>(queue, [](const StorageBench& b) {
          return fmt::format("{} lines {}", b.memory->got.size(), counter(*b.unit, "lines"));
        }) == "32 lines 32");
}

TEST_CASE("load_store_unit: keeps the contract, one-deep links and a cache of one line included") {
  StorageBench::Setup s{.requests = {{0, slot(0)}, {0, slot(1)}, {0, slot(2)}, {9, slot(3)}, {100, slot(0)}},
                        .accesses = {{},
                                     {.stride = 256},
                                     {.op = Op::kStoreBuffer, .first = 20},
                                     {.op = Op::kAtomicIMax, .stride = 8}},
                        .groups = 2,
                        .queued = 4,
                        .pace = {.from = 0, .period = 7}};
  CHECK(contract_text<StorageBench>(s) == "");
  s.lines = s.ways = s.misses = 1;
  CHECK(contract_text<StorageBench>(s) == "");
}
