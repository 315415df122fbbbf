#include "hw/base/clock.h"

#include "tests/clocked/clocked_simulator.h"

#include <catch2/catch.hpp>

#include <random>

using namespace quadrille::hw;

TEST_CASE("clock: edge k is the exact floor of k periods, for any frequency and any k") {
  std::mt19937_64 random(1);
  for (const std::int64_t hz :
       {std::int64_t{1'000'000'000}, std::int64_t{1'755'000'000}, std::int64_t{999'999'900},
        std::int64_t{618'033'989}, std::int64_t{3}, std::int64_t{7'000'000'001},
        std::int64_t{1'000'000'000'000'000}, std::int64_t{999'999'999'999'989}}) {
    const Clock clock(hz);
    for (int i = 0; i < 2000; ++i) {
      const auto k = static_cast<std::int64_t>(random() >> (1 + random() % 63)) % (hz * 9000);
      REQUIRE(clock.edge(k) == quadrille::clocked::edge_time(hz, k));
    }
  }
}

TEST_CASE("clock: edges_before counts edges, align finds the next, after and cycles agree with them") {
  std::mt19937_64 random(2);
  for (const std::int64_t hz : {std::int64_t{1'000'000'000}, std::int64_t{1'755'000'000},
                                std::int64_t{999'999'900}, std::int64_t{2'414'213'562}}) {
    const Clock clock(hz);
    CHECK(clock.edges_before(0) == 0);
    CHECK(clock.edges_before(1) == 1);
    for (int i = 0; i < 2000; ++i) {
      const auto k = 1 + static_cast<std::int64_t>(random() % 1'000'000'000'000);
      const Tick t = clock.edge(k);
      REQUIRE(clock.edges_before(t) == k);
      REQUIRE(clock.edges_before(t + 1) == k + 1);
      REQUIRE(clock.edges_before(t - 1) == k);
      REQUIRE(clock.align(t) == t);
      REQUIRE(clock.align(t - 1) == t);
      REQUIRE(clock.after(t, 7) == clock.edge(k + 7));
      REQUIRE(clock.cycles(t, clock.edge(k + 12)) == 12);
    }
  }
}

TEST_CASE("clock: a second of a clock has as many edges as its frequency says, so nothing drifts") {
  for (const std::int64_t hz : {std::int64_t{1'000'000'007}, std::int64_t{618'033'989}}) {
    CHECK(Clock(hz).edges_before(1'000'000'000'000'000) == hz);
    CHECK(Clock(hz).edges_before(9'000'000'000'000'000'000) == 9000 * hz);
  }
}

TEST_CASE("clock: a faster clock has equal cycles, of its domain and of no other") {
  const Clock clock(1'755'000'000);
  const Clock same = clock.faster(1), faster = clock.faster(1.1);
  CHECK(same.period() == 569'801);  // of 569,800.57 fs
  CHECK(faster.period() == 518'001);
  CHECK(faster.uniform());
  CHECK_FALSE(faster.spans_are_cycles());
  CHECK_FALSE(same.spans_are_cycles());
  CHECK_FALSE(clock.spans_are_cycles());
  CHECK(Clock(1'000'000'000).spans_are_cycles());
  CHECK(faster.same_domain(clock));
  CHECK_FALSE(faster.same_domain(Clock(1'000'000'000)));
  CHECK(faster.after(1234, 3) == 1234 + 3 * 518'001);  // wherever it begins
  CHECK(Clock(1'000'000'000).faster(100).period() == 10'000);
}

TEST_CASE("clock: never stays never") { CHECK(Clock(1'755'000'000).align(kNever) == kNever); }
