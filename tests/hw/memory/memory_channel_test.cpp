/// Memory channel: the cycle of an answer for each state of the row, the bus, the queue.
#include "hw/memory/memory_channel.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

using Kind = MemoryRequest::Kind;

struct ChannelBench final : Bench {
  struct Setup {
    std::vector<Timed<MemoryRequest>> requests;
    int queue_depth = 32;
    Pace pace{};
    LinkSpec out{.depth = 64};
  };
  ChannelBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    params.queue_depth.set(s.queue_depth);
    unit = std::make_unique<MemoryChannel>("unit", params, clock, 1);
    add(*unit);
    feed(unit->request_in, s.requests);
    sink = &drain<MemoryResponse>(
        unit->response_out, [](const MemoryResponse& t) { return t.line; }, s.pace, s.out);
  }
  MemoryChannel::Params params;
  std::unique_ptr<MemoryChannel> unit;
  StubSink<MemoryResponse>* sink = nullptr;
};

// Defaults: 16 lines a row, 16 banks, t_rcd = t_rp = t_cas = 14, a cycle a sector, 60 cycles of path.
constexpr std::uint32_t kSameBank = 16 * 16;  ///< lines to the next row of a bank
MemoryRequest read(std::uint32_t line, std::uint8_t sectors = 0xf) { return {line, line, sectors, Kind::kRead}; }
std::string answers(const ChannelBench::Setup& s) {
  return run<ChannelBench>(s, [](const ChannelBench& b) { return b.sink->text(); });
}

}  // namespace

TEST_CASE("memory_channel: a read of a closed row, of the open row and of another row of the bank, each alone") {
  // Taken one cycle after the push; seen by the sink one cycle after it leaves: 2 + (rcd) + cas + 4 + 60, with rp for the conflict.
  const ChannelBench::Setup s{.requests = {{0, read(0)}, {200, read(1)}, {400, read(kSameBank)}}};
  const auto text = run<ChannelBench>(s, [](const ChannelBench& b) {
    return fmt::format("{} hits {} conflicts {} bytes {} bus {}", b.sink->text(), counter(*b.unit, "row_hits"),
                       counter(*b.unit, "row_conflicts"), counter(*b.unit, "read_bytes"), counter(*b.unit, "bus_busy"));
  });
  CHECK(text == "94:0 280:1 508:256 hits 1 conflicts 1 bytes 384 bus 12");
}

TEST_CASE("memory_channel: a read of fewer sectors is there sooner by their bus cycles") {
  CHECK(answers({.requests = {{0, read(0, 0x1)}}}) == "91:0");
  CHECK(answers({.requests = {{0, read(0, 0x5)}}}) == "92:0");
}

TEST_CASE("memory_channel: a stream of the open row keeps the bus busy: one line every four cycles") {
  ChannelBench::Setup s;
  std::string expected;
  for (std::uint32_t i = 0; i < 16; ++i) {
    s.requests.push_back({0, read(i)});
    expected += fmt::format("{}{}:{}", i == 0 ? "" : " ", 94 + 4 * i, i);
  }
  CHECK(answers(s) == expected);
}

TEST_CASE("memory_channel: banks overlap, so that rows of two banks cost one activation's time") {
  CHECK(answers({.requests = {{0, read(0)}, {0, read(16)}}}) == "94:0 98:16");
  // The same bank: the second row is opened once the first was open for t_ras (32) cycles: 33 + rp + rcd + cas + 4 + 60, and 1.
  CHECK(answers({.requests = {{0, read(0)}, {0, read(kSameBank)}}}) == "94:0 140:256");
}

TEST_CASE("memory_channel: a write is not answered, and turns the bus round") {
  const ChannelBench::Setup s{.requests = {{0, {0, 0, 0xf, Kind::kWrite}}, {0, read(1)}}};
  const auto text = run<ChannelBench>(s, [](const ChannelBench& b) {
    return fmt::format("{} writes {} of {} bytes", b.sink->text(), counter(*b.unit, "writes"), counter(*b.unit, "write_bytes"));
  });
  CHECK(text == "102:1 writes 1 of 128 bytes");  // four cycles of turn-around after the write's data
}

TEST_CASE("memory_channel: takes no more accesses than its queue holds") {
  CHECK(answers({.requests = {{0, read(0)}, {0, read(1)}}, .queue_depth = 1}) ==
        "94:0 172:1");  // the second is taken the cycle the first leaves
}

TEST_CASE("memory_channel: keeps the contract, one-deep links included") {
  const ChannelBench::Setup s{
      .requests = {{0, read(0)}, {0, read(kSameBank, 0x3)}, {1, {17, 0, 0x7, Kind::kWrite}}, {1, read(17)}, {9, read(2)}, {9, read(3)}},
      .queue_depth = 2,
      .pace = {.from = 0, .period = 9},
      .out = {.depth = 2}};
  CHECK(contract_text<ChannelBench>(s) == "");
}
