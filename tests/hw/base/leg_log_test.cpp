/// What a log of legs finds: the last leg or take of a kind by a tick.
#include "hw/base/leg_log.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;

namespace {

/// Two pieces of work in a unit with ports 0 (in), 1 (asks), 2 (answers), 3 (out): the first asks once.
struct TwoWorks {
  LegLog log;
  TwoWorks() {
    const std::uint32_t first = log.take({10, 10, 0, true, DrawId(0)});
    log.end({first, 0, 14, 15, 2, 1, false, false});  // asks at 15
    const std::uint32_t second = log.take({11, 20, 0, true, DrawId(1)});
    const std::uint32_t answered = log.take({30, 30, 2, false, DrawId(0)});
    log.end({answered, 0, 33, 33, 1, 3, false, true});  // leaves at 33
    log.end({second, 0, 40, 41, 1, 3, true, true});
  }
};

}  // namespace

TEST_CASE("leg log: legs are found by the port that they end at") {
  const TwoWorks two;
  CHECK(two.log.ends_legs(1));
  CHECK(two.log.ends_legs(3));
  CHECK_FALSE(two.log.ends_legs(0));
  CHECK_FALSE(two.log.ends_legs(9));
  REQUIRE(two.log.ended_by(100, 1) != nullptr);
  CHECK(two.log.ended_by(100, 1)->sent == 15);
  CHECK(two.log.ended_by(40, 3)->sent == 33);
  CHECK(two.log.ended_by(41, 3)->sent == 41);
  CHECK(two.log.ended_by(32, 3) == nullptr);
  CHECK(two.log.take_of(*two.log.ended_by(40, 3)).port == 2);
  CHECK(two.log.first(two.log.ended_by(20, 1)));
}

TEST_CASE("leg log: only a leg that leaves makes room, and only one before another") {
  const TwoWorks two;
  CHECK(two.log.left_by(20, nullptr) == nullptr);
  CHECK(two.log.left_by(35, nullptr)->sent == 33);
  CHECK(two.log.left_by(41, two.log.ended_by(41, 3))->sent == 33);
}

TEST_CASE("leg log: takes are found by time, those that enter by themselves") {
  const TwoWorks two;
  CHECK(two.log.taken_by(9) == nullptr);
  CHECK(two.log.taken_by(30)->port == 2);
  CHECK(two.log.entered_by(30)->draw == DrawId(1));
  CHECK(two.log.entered_by(19)->draw == DrawId(0));
  CHECK(LegLog().taken_by(5) == nullptr);
  CHECK(LegLog().left_by(5, nullptr) == nullptr);
}

TEST_CASE("leg log: without one, a take has the number 0") {
  LegLog log;
  CHECK(noted(nullptr, {}) == 0);
  CHECK(noted(&log, {}) == 0);
  CHECK(noted(&log, {}) == 1);
}
