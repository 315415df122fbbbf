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
    // One bus and one bank group, rows in plain order, round times: a sector a cycle.
    for (const auto& [name, value] : {std::pair{"pseudo_channels", "1"},
                                      {"bank_groups", "1"},
                                      {"mapping", "row"},
                                      {"bank_hash", "false"},
                                      {"refresh", "none"},
                                      {"t_burst", "1"},
                                      {"t_ccd_s", "1"},
                                      {"t_ccd_l", "1"},
                                      {"t_rcd", "14"},
                                      {"t_rcd_wr", "14"},
                                      {"t_rp", "14"},
                                      {"t_ras", "32"},
                                      {"t_rc", "46"},
                                      {"t_cas", "14"},
                                      {"t_cwl", "10"},
                                      {"t_rtp", "4"},
                                      {"t_wtr_s", "4"},
                                      {"t_wtr_l", "4"},
                                      {"t_rrd_s", "4"},
                                      {"write_drain", "off"}})
      params.find(name)->parse(value);
    params.queue_depth.set(s.queue_depth);
    unit = std::make_unique<MemoryChannel>("unit", context(), params);
    add(*unit);
    feed(unit->request_in, s.requests);
    sink = &drain<MemoryResponse>(
        unit->response_out, [](const MemoryResponse& t) { return t.line; }, s.pace, s.out);
  }
  MemoryChannel::Params params;
  std::unique_ptr<MemoryChannel> unit;
  StubSink<MemoryResponse>* sink = nullptr;
};

// 16 lines a row, 16 banks, t_rcd = t_rp = t_cas = 14, a cycle a sector.
constexpr std::uint32_t kSameBank = 16 * 16;  ///< lines to the next row of a bank
MemoryRequest read(std::uint32_t line, std::uint8_t sectors = 0xf) {
  return {line, line, sectors, Kind::kRead};
}
std::string answers(const ChannelBench::Setup& s) {
  return run<ChannelBench>(s, [](const ChannelBench& b) { return b.sink->text(); });
}

}  // namespace

TEST_CASE(
    "memory_channel: a read of a closed row, of the open row and of another row of the bank, each alone") {
  // Taken one cycle after the push; seen by the sink one cycle after it leaves: 2 + (rcd) + cas + 4, with rp
  // for the conflict.
  const ChannelBench::Setup s{.requests = {{0, read(0)}, {200, read(1)}, {400, read(kSameBank)}}};
  const auto text = run<ChannelBench>(s, [](const ChannelBench& b) {
    b.unit->finish_stats(b.unit->clock().edge(1000));
    return fmt::format("{} hits {} conflicts {} bytes {} bus {}", b.sink->text(),
                       counter(*b.unit, "row_hits"), counter(*b.unit, "row_conflicts"),
                       counter(*b.unit, "read_bytes"), counter(*b.unit, "bus_busy"));
  });
  CHECK(text == "34:0 220:1 448:256 hits 1 conflicts 1 bytes 384 bus 12");
}

TEST_CASE("memory_channel: a read of fewer sectors is there sooner by their bus cycles") {
  CHECK(answers({.requests = {{0, read(0, 0x1)}}}) == "31:0");
  CHECK(answers({.requests = {{0, read(0, 0x5)}}}) == "32:0");
}

TEST_CASE("memory_channel: a stream of the open row keeps the bus busy: one line every four cycles") {
  ChannelBench::Setup s;
  std::string expected;
  for (std::uint32_t i = 0; i < 16; ++i) {
    s.requests.push_back({0, read(i)});
    expected += fmt::format("{}{}:{}", i == 0 ? "" : " ", 34 + 4 * i, i);
  }
  CHECK(answers(s) == expected);
}

TEST_CASE("memory_channel: banks overlap, so that rows of two banks cost one activation's time") {
  CHECK(answers({.requests = {{0, read(0)}, {0, read(16)}}}) == "34:0 38:16");
  // The same bank: the second row is opened once the first was open for t_ras (32) cycles: 33 + rp + rcd +
  // cas + 4, and 1.
  CHECK(answers({.requests = {{0, read(0)}, {0, read(kSameBank)}}}) == "34:0 80:256");
}

TEST_CASE("memory_channel: a write is not answered, and turns the bus round") {
  const ChannelBench::Setup s{.requests = {{0, {0, 0, 0xf, Kind::kWrite}}, {0, read(1)}}};
  const auto text = run<ChannelBench>(s, [](const ChannelBench& b) {
    return fmt::format("{} writes {} of {} bytes", b.sink->text(), counter(*b.unit, "writes"),
                       counter(*b.unit, "write_bytes"));
  });
  // The write's data end at 15 + cwl + 4 = 29; the read follows t_wtr later: 33 + 3 + cas + 1, and 1.
  CHECK(text == "52:1 writes 1 of 128 bytes");
}

TEST_CASE("memory_channel: a place in the queue is free once the last burst is commanded") {
  CHECK(answers({.requests = {{0, read(0)}, {0, read(1)}}, .queue_depth = 1}) ==
        "34:0 38:1");  // the second is taken when the first one's last burst was commanded
}

TEST_CASE(
    "memory_channel: every cycle of the data bus has a use, and every access an outcome and a latency") {
  const ChannelBench::Setup s{.requests = {{0, read(0)},
                                           {0, {16, 0, 0x3, Kind::kWrite, MemoryClient::kWriteBack}},
                                           {9, read(kSameBank)},
                                           {300, read(1)}}};
  const auto text = run<ChannelBench>(s, [](const ChannelBench& b) {
    b.unit->finish_stats(b.unit->clock().edge(1000));
    std::uint64_t sum = 0;
    for (const char* use : {"bus_read", "bus_write", "bus_refresh", "bus_turnaround", "bus_activation",
                            "bus_spacing", "bus_idle"})
      sum += counter(*b.unit, use);
    std::uint64_t noted = 0;
    for (const Histogram* h : b.unit->stats()->histograms()) noted += h->count();
    return fmt::format("{} read {} write {} rows {}+{}+{} latencies {} queue {}", sum,
                       counter(*b.unit, "bus_read"), counter(*b.unit, "bus_write"),
                       counter(*b.unit, "row_hits"), counter(*b.unit, "row_misses"),
                       counter(*b.unit, "row_conflicts"), noted, counter(*b.unit, "queue_occupancy") > 0);
  });
  CHECK(text == "1000 read 12 write 2 rows 0+2+2 latencies 4 queue true");
}

TEST_CASE("memory_channel: keeps the contract, one-deep links included") {
  const ChannelBench::Setup s{.requests = {{0, read(0)},
                                           {0, read(kSameBank, 0x3)},
                                           {1, {17, 0, 0x7, Kind::kWrite}},
                                           {1, read(17)},
                                           {9, read(2)},
                                           {9, read(3)}},
                              .queue_depth = 2,
                              .pace = {.from = 0, .period = 9},
                              .out = {.depth = 2}};
  CHECK(contract_text<ChannelBench>(s) == "");
}
