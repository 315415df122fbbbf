/// A SIMD of a core by itself: what has issued by when.
#include "hw/shader/simd.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;

TEST_CASE("simd: issue cycles are used as time goes by, not when a clause comes") {
  Simd simd(kRoundRobinSharing);
  simd.add(0, 1, 1000, 1000);
  CHECK(simd.issued(0) == 0);
  CHECK(simd.issued(250) == Approx(250));
  simd.add(500, 2, 100, 400);  // a quarter of the SIMD is all that it can use
  CHECK(simd.issued(500) == Approx(500));
  CHECK(simd.issued(700) == Approx(700));
  std::uint32_t ended = 0;
  CHECK_FALSE(simd.take_ended(899, ended));
  REQUIRE(simd.take_ended(simd.next_end(), ended));
  CHECK(ended == 2);
  REQUIRE(simd.take_ended(simd.next_end(), ended));
  CHECK(simd.issued(5000) == Approx(1100));
}

TEST_CASE("simd: a clause alone that waits for its results uses its work's part of each cycle") {
  Simd simd(kOldestSharing);
  simd.add(10, 1, 100, 400);
  CHECK(simd.issued(210) == Approx(50));
  CHECK(simd.issued(410) == Approx(100));
  CHECK(simd.issued(900) == Approx(100));
}
