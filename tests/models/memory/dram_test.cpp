#include "models/memory/dram.h"

#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

using namespace quadrille::models;

namespace {

constexpr DramParams kParams{.banks = 4,
                             .row_bytes = 1024,
                             .burst_bytes = 32,
                             .t_rcd = 10,
                             .t_rp = 11,
                             .t_cas = 12,
                             .t_ras = 30,
                             .t_wr = 9,
                             .t_burst = 2,
                             .t_turnaround = 5};

}  // namespace

TEST_CASE("dram: a first access activates and a second to the row follows on the bus") {
  DramChannel channel(kParams);
  const DramAccess first = channel.access(0, 32, false, 100);
  CHECK_FALSE(first.row_hit);
  CHECK_FALSE(first.row_conflict);
  CHECK(first.command == 110);
  CHECK(first.start == 122);
  CHECK(first.done == 124);
  CHECK(channel.row_open(992));
  CHECK_FALSE(channel.row_open(1024));
  const DramAccess second = channel.access(32, 32, false, 100);
  CHECK(second.row_hit);
  CHECK(second.start == 124);
  CHECK(second.done == 126);
}

TEST_CASE("dram: a stream over one row moves a burst every t_burst cycles") {
  DramChannel channel(kParams);
  std::int64_t done = 0;
  int hits = 0;
  for (std::uint64_t a = 0; a < 1024; a += 32) {
    const DramAccess access = channel.access(a, 32, false, 0);
    done = access.done;
    hits += access.row_hit ? 1 : 0;
  }
  CHECK(hits == 31);
  CHECK(done == 10 + 12 + 32 * 2);
  CHECK(DramChannel(kParams).access(0, 1024, false, 0).done == done);  // one long access costs the same
}

TEST_CASE("dram: banks activate in parallel") {
  DramChannel channel(kParams);
  std::int64_t done = 0;
  for (std::uint64_t bank = 0; bank < 4; ++bank) done = channel.access(bank * 1024, 32, false, 0).done;
  CHECK(done == 10 + 12 + 4 * 2);
}

TEST_CASE("dram: a row conflict waits for t_ras then precharges and activates") {
  DramChannel channel(kParams);
  (void)channel.access(0, 32, false, 0);                        // activated at 0
  const DramAccess other = channel.access(4096, 32, false, 0);  // row 1 of bank 0
  CHECK(other.row_conflict);
  CHECK(other.command == 30 + 11 + 10);
  CHECK(other.start == 30 + 11 + 10 + 12);
  DramChannel relaxed(kParams);
  (void)relaxed.access(0, 32, false, 0);
  CHECK(relaxed.access(4096, 32, false, 1000).start == 1000 + 11 + 10 + 12);
}

TEST_CASE("dram: a write delays the precharge and turning the bus round costs") {
  DramChannel channel(kParams);
  const DramAccess write = channel.access(0, 512, true, 0);
  CHECK(write.done == 10 + 12 + 16 * 2);
  const DramAccess read = channel.access(512, 32, false, 0);
  CHECK(read.start == write.done + 5);
  DramChannel conflict(kParams);
  const DramAccess before = conflict.access(0, 512, true, 0);
  CHECK(conflict.access(4096, 32, true, 0).start == before.done + 9 + 11 + 10 + 12);
}

TEST_CASE("dram: data of any sequence never overlap and never precede the request") {
  RandomSource random(81);
  DramChannel channel(DramParams{});
  std::int64_t cycle = 0, bus = 0;
  for (int i = 0; i < 20000; ++i) {
    cycle += random.integer(0, 8);
    const std::uint64_t address = static_cast<std::uint64_t>(random.integer(0, 1 << 20)) * 32;
    const bool open = channel.row_open(address);
    const DramAccess a = channel.access(address, 32, random.integer(0, 1) != 0, cycle);
    if (a.start < bus || a.command < cycle || a.done != a.start + 2 || a.row_hit != open || (a.row_hit && a.row_conflict))
      FAIL("access " << i);
    bus = a.done;
  }
  CHECK(channel.bus_free() == bus);
}
