/// Scan-out: every line of the surface once, in order, as many under way as allowed.
#include "hw/display/scan_out.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct ScanBench final : Bench {
  struct Setup {
    std::vector<Timed<ScanToken>> scans;
    int lines_in_flight = 128, latency = 10;
    bool dirty = false;    ///< a colour cache still holds a line
    bool encoded = false;  ///< the second line lies in one sector
  };
  ScanBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    PassState pass;
    (void)device.allocate(256);
    pass.color[0].surface = models::allocate_surface(device, 16, 8);  // two tiles: four lines, from line 2 on
    frame.passes = {pass};
    if (s.dirty) device.mark_dirty(pass.color[0].surface.base / models::kLineBytes + 3, 1);
    params.lines_in_flight.set(s.lines_in_flight);
    if (s.encoded)
      device.stored_lines().set_encoded(
          static_cast<std::uint32_t>(pass.color[0].surface.base / models::kLineBytes) + 1, 1);
    unit = std::make_unique<ScanOut>("unit", context(), params);
    add(*unit);
    feed(unit->scan_in, s.scans);
    done = &drain<ReleaseToken>(unit->done_out, [](const ReleaseToken& t) { return t.slot; });
    stub = &serve(unit->memory_port(), s.latency);
  }
  ScanOut::Params params;
  std::unique_ptr<ScanOut> unit;
  StubSink<ReleaseToken>* done = nullptr;
  StubMemory* stub = nullptr;
};

std::string report(const ScanBench& b) {
  return fmt::format("{} done {} lines {}", b.stub->text(), b.done->text(), counter(*b.unit, "lines"));
}

}  // namespace

TEST_CASE("scan_out: asks for one line a cycle and is done the cycle the last answer arrives") {
  CHECK(run<ScanBench>({.scans = {{0, {PassId(0)}}}}, report) ==
        "3:r2/f 4:r3/f 5:r4/f 6:r5/f done 18:0 lines 4");
}

TEST_CASE("scan_out: keeps no more lines under way than allowed") {
  CHECK(run<ScanBench>({.scans = {{0, {PassId(0)}}}, .lines_in_flight = 1}, report) ==
        "3:r2/f 15:r3/f 27:r4/f 39:r5/f done 51:0 lines 4");
  CHECK(run<ScanBench>({.scans = {{0, {PassId(0)}}}, .lines_in_flight = 2}, report) ==
        "3:r2/f 4:r3/f 15:r4/f 16:r5/f done 28:0 lines 4");
}

TEST_CASE("scan_out: a line that a cache still holds dirty is noticed") {
  CHECK_THAT(run<ScanBench>({.scans = {{0, {PassId(0)}}}, .dirty = true}, report),
             Catch::StartsWith("failed: signal"));
}

TEST_CASE("scan_out: reads an encoded line by its encoding") {
  CHECK(run<ScanBench>({.scans = {{0, {PassId(0)}}}, .encoded = true}, [](const ScanBench& b) {
          return fmt::format("{} encoded {} in {} bytes", report(b), counter(*b.unit, "encoded_reads"),
                             counter(*b.unit, "encoded_read_bytes"));
        }) == "3:r2/f 4:r3/1 5:r4/f 6:r5/f done 18:0 lines 4 encoded 1 in 32 bytes");
}

TEST_CASE("scan_out: keeps the contract, one-deep links included") {
  CHECK(contract_text<ScanBench>(
            {.scans = {{0, {PassId(0)}}, {5, {PassId(0)}}}, .lines_in_flight = 3, .latency = 7}) == "");
}
