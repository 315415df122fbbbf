/// L2 slice: latency of hits and misses, merged misses, turns of clients, write-backs.
#include "hw/memory/l2_slice.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

using Kind = MemoryRequest::Kind;
constexpr int kMemory = 50;  ///< cycles between a request's arrival at the stub and its answer

struct L2Bench final : Bench {
  struct Setup {
    std::vector<Timed<MemoryRequest>> client_0, client_1{};
    int lines = 64, ways = 4, misses = 8, hit_clk = 20;
    Pace pace{};
    LinkSpec out{.depth = 64};
    const char* write_back = "victim";
  };
  L2Bench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    set_cache(params, s.lines, s.ways, s.misses);
    params.hit_clk.set(s.hit_clk);
    params.write_back.parse(s.write_back);
    params.write_back_lines.set(8);
    unit = std::make_unique<L2Slice>("unit", context(), params,
                                     std::vector<L2Slice::Client>{{"one", MemoryClient::kVertexFetch},
                                                                  {"many_7", MemoryClient::kTexture}});
    add(*unit);
    feed(unit->request_in[0], s.client_0);
    feed(unit->request_in[1], s.client_1);
    for (auto& out : unit->response_out)
      sinks.push_back(&drain<MemoryResponse>(
          *out, [](const MemoryResponse& t) { return t.tag; }, s.pace, s.out));
    memory = &serve(unit->memory_out, unit->fill_in, kMemory);
  }
  L2Slice::Params params;
  std::unique_ptr<L2Slice> unit;
  std::vector<StubSink<MemoryResponse>*> sinks;
  StubMemory* memory = nullptr;
};

MemoryRequest read(std::uint32_t line, std::uint32_t tag, std::uint8_t sectors = 0xf) {
  return {line, tag, sectors, Kind::kRead};
}
MemoryRequest write(std::uint32_t line, std::uint8_t sectors = 0xf) {
  return {line, 0, sectors, Kind::kWrite};
}
MemoryRequest write_part(std::uint32_t line, std::uint8_t sectors) {
  return {line, 0, sectors, Kind::kWritePart};
}
MemoryRequest atomic(std::uint32_t line, std::uint32_t tag, std::uint8_t sectors = 0x1) {
  return {line, tag, sectors, Kind::kAtomic};
}
MemoryRequest fence(std::uint32_t tag) { return {0, tag, 0, Kind::kFence}; }
std::string both(const L2Bench& b) { return b.sinks[0]->text() + " | " + b.sinks[1]->text(); }

}  // namespace

TEST_CASE(
    "l2_slice: a hit takes exactly hit_clk and its two links, a miss hit_clk, the memory's time and its "
    "links") {
  for (const int hit : {1, 20, 77}) {
    const L2Bench::Setup s{.client_0 = {{0, read(7, 1)}, {200, read(7, 2)}}, .hit_clk = hit};
    const auto text = run<L2Bench>(s, [](const L2Bench& b) {
      return fmt::format("{} memory {}", b.sinks[0]->text(), b.memory->text());
    });
    CHECK(text == fmt::format("{}:1 {}:2 memory {}:r7/f", 1 + hit + 1 + kMemory + 1 + 1, 200 + 1 + hit + 1,
                              1 + hit + 1));
  }
}

TEST_CASE("l2_slice: ports are named for their clients, with a number last") {
  const auto names = [](const L2Bench& b) {
    std::string text;
    for (std::size_t c = 0; c < 2; ++c) {
      const PortBase &in = b.unit->request_in[c], &out = *b.unit->response_out[c];
      text += fmt::format("{} {} ", in.name(), out.name());
    }
    return text;
  };
  CHECK(run<L2Bench>(L2Bench::Setup{}, names) == "one_in one_out many_in_7 many_out_7 ");
}

TEST_CASE("l2_slice: a line under way serves all who ask for it") {
  const L2Bench::Setup s{.client_0 = {{0, read(7, 1)}, {0, read(7, 2)}}, .client_1 = {{0, read(7, 3)}}};
  const auto text = run<L2Bench>(s, [](const L2Bench& b) {
    return fmt::format("{} memory {} merged {} misses {}", both(b), b.memory->text(),
                       counter(*b.unit, "merged"), counter(*b.unit, "misses"));
  });
  CHECK(text == "74:1 75:2 | 74:3 memory 22:r7/f merged 2 misses 1");
}

TEST_CASE("l2_slice: only sectors that are not there are asked for") {
  const L2Bench::Setup s{.client_0 = {{0, read(7, 1, 0x3)}, {200, read(7, 2, 0x6)}}};
  const auto text = run<L2Bench>(s, [](const L2Bench& b) {
    return fmt::format("{} fill {} read {}", b.memory->text(), counter(*b.unit, "fill_bytes"),
                       counter(*b.unit, "read_bytes"));
  });
  CHECK(text == "22:r7/3 222:r7/4 fill 96 read 128");
}

TEST_CASE(
    "l2_slice: a sector written in part is completed from memory where it is not there, and leaves as a "
    "whole") {
  // One line: the reads of others evict it.
  const L2Bench::Setup s{.client_0 = {{0, write_part(3, 0x5)},
                                      {200, read(4, 1)},
                                      {400, write(4, 0x1)},
                                      {401, write_part(4, 0x1)},
                                      {600, read(5, 2)}},
                         .lines = 1,
                         .ways = 1};
  const auto text = run<L2Bench>(s, [](const L2Bench& b) {
    return fmt::format("{} written {} fill {} back {} hits {} misses {}", b.memory->text(),
                       counter(*b.unit, "write_bytes"), counter(*b.unit, "fill_bytes"),
                       counter(*b.unit, "writeback_bytes"), counter(*b.unit, "hits"),
                       counter(*b.unit, "misses"));
  });
  CHECK(text == "22:r3/5 222:w3/5 223:r4/f 622:w4/1 623:r5/f written 128 fill 320 back 96 hits 2 misses 3");
}

TEST_CASE("l2_slice: a read of a sector that is being completed waits for it") {
  const L2Bench::Setup s{.client_0 = {{0, write_part(3, 0x1)}, {1, read(3, 1, 0x1)}}};
  CHECK(run<L2Bench>(s, [](const L2Bench& b) { return b.sinks[0]->text() + " " + b.memory->text(); }) ==
        "74:1 22:r3/1");
}

TEST_CASE("l2_slice: atomic requests are answered as reads are, one a cycle, and leave the sector dirty") {
  // One line: the read of another evicts it.
  const L2Bench::Setup s{.client_0 = {{0, atomic(3, 1)},
                                      {200, atomic(3, 2)},
                                      {200, atomic(3, 3)},
                                      {200, atomic(3, 4)},
                                      {400, read(5, 5)}},
                         .lines = 1,
                         .ways = 1};
  const auto text = run<L2Bench>(s, [](const L2Bench& b) {
    return fmt::format("{} | {} read {} written {} back {}", b.sinks[0]->text(), b.memory->text(),
                       counter(*b.unit, "read_bytes"), counter(*b.unit, "write_bytes"),
                       counter(*b.unit, "writeback_bytes"));
  });
  CHECK(text == "74:1 222:2 223:3 224:4 475:5 | 22:r3/1 422:w3/1 423:r5/f read 256 written 128 back 32");
}

TEST_CASE("l2_slice: clients take turns, one look-up a cycle") {
  const L2Bench::Setup s{.client_0 = {{0, fence(1)}, {0, fence(2)}, {0, fence(3)}},
                         .client_1 = {{0, fence(4)}}};
  CHECK(run<L2Bench>(s, both) == "22:1 24:2 25:3 | 23:4");
}

TEST_CASE("l2_slice: a hit overtakes an older miss") {
  const L2Bench::Setup s{.client_0 = {{0, read(7, 1)}, {100, read(8, 2)}, {101, read(7, 3)}}};
  CHECK(run<L2Bench>(s, [](const L2Bench& b) { return b.sinks[0]->text(); }) == "74:1 123:3 174:2");
}

TEST_CASE("l2_slice: a write asks for nothing, and a dirty line is written back when its place is taken") {
  const L2Bench::Setup s{
      .client_0 = {{0, write(0, 0x5)}, {10, write(1)}, {20, read(0, 9)}}, .lines = 1, .ways = 1};
  const auto text = run<L2Bench>(s, [](const L2Bench& b) {
    return fmt::format("{} memory {} written back {} of {}", b.sinks[0]->text(), b.memory->text(),
                       counter(*b.unit, "writeback_bytes"), counter(*b.unit, "write_bytes"));
  });
  CHECK(text == "95:9 memory 32:w0/5 42:w1/f 43:r0/f written back 192 of 192");
}

TEST_CASE(
    "l2_slice: with row-ordered write-back the dirty lines of a victim's block leave with it, in order of "
    "address") {
  const auto memory = [](const char* how) {
    L2Bench::Setup s{
        .client_0 = {{0, write(5)}, {1, write(9)}, {2, write(4)}, {3, write(6, 0x3)}, {40, read(1000, 1)}},
        .lines = 4,
        .ways = 4,
        .write_back = how};
    return run<L2Bench>(s, [](const L2Bench& b) {
      return fmt::format("{} early {}", b.memory->text(), counter(*b.unit, "early_write_backs"));
    });
  };
  CHECK(memory("victim") == "62:w5/f 63:r1000/f early 0");
  CHECK(memory("row") == "62:w5/f 63:w4/f 64:w6/3 65:r1000/f early 2");
}

TEST_CASE("l2_slice: a cache of one line and one miss answers everything, one line at a time") {
  L2Bench::Setup s{.client_0 = {}, .lines = 1, .ways = 1, .misses = 1};
  for (std::uint32_t i = 0; i < 4; ++i) s.client_0.push_back({0, read(i, i)});
  // The next line is looked up the cycle the last one's fill arrives: 20 + 1 + 50 + 1 cycles after the
  // look-up before.
  CHECK(run<L2Bench>(s, [](const L2Bench& b) { return b.sinks[0]->text(); }) == "74:0 146:1 218:2 290:3");
}

TEST_CASE("l2_slice: an answer that has no room holds back no other client") {
  L2Bench::Setup s{.client_0 = {{0, fence(1)}, {0, fence(2)}, {0, fence(3)}},
                   .client_1 = {{0, fence(4)}, {0, fence(5)}},
                   .pace = {.from = 100, .period = 10},
                   .out = {.depth = 1}};
  CHECK(run<L2Bench>(s, both) == "100:1 110:2 120:3 | 100:4 110:5");
}

TEST_CASE("l2_slice: keeps the contract, one-deep links included") {
  L2Bench::Setup s{
      .client_0 = {{0, read(0, 1)}, {0, write(1)}, {0, read(2, 2, 0x3)}, {0, fence(7)}, {60, read(1, 3)}},
      .client_1 = {{0, read(0, 4)}, {0, read(1, 5)}, {0, write(3, 0x1)}, {70, read(3, 6)}},
      .lines = 2,
      .ways = 1,
      .misses = 2};
  CHECK(contract_text<L2Bench>(s, false) == "");
}
