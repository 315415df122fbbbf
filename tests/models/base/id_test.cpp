/// Ids: of different kinds they do not mix, of one kind they compare by their numbers.
#include "models/base/id.h"

#include <catch2/catch.hpp>

#include <set>
#include <type_traits>
#include <unordered_set>

using namespace quadrille::models;

namespace {

template <class A, class B>
concept Comparable = requires(A a, B b) {
  a == b;
};
template <class A>
concept HasArithmetic = requires(A a) {
  a + a;
}
|| requires(A a) { ++a; }
|| requires(A a) { a + 1; };

}  // namespace

TEST_CASE("id: one kind is not taken for another, nor for a number") {
  STATIC_REQUIRE_FALSE(std::is_convertible_v<DrawId, PassId>);
  STATIC_REQUIRE_FALSE(std::is_constructible_v<DrawId, PassId>);
  STATIC_REQUIRE_FALSE(std::is_convertible_v<int, DrawId>);
  STATIC_REQUIRE_FALSE(std::is_convertible_v<DrawId, std::uint32_t>);
  STATIC_REQUIRE_FALSE(Comparable<DrawId, PassId>);
  STATIC_REQUIRE(Comparable<DrawId, DrawId>);
  STATIC_REQUIRE_FALSE(HasArithmetic<DrawId>);
  STATIC_REQUIRE(HasArithmetic<int>);
  STATIC_REQUIRE(sizeof(DrawId) == 4);
  STATIC_REQUIRE(std::is_trivially_copyable_v<DrawId>);
}

TEST_CASE("id: compares and hashes by its number") {
  CHECK(WarpSlotId(7).index() == 7);
  CHECK(WarpSlotId() == WarpSlotId(0));
  CHECK(WarpSlotId(1) < WarpSlotId(2));
  CHECK(std::set{PassId(3), PassId(1), PassId(3)}.begin()->index() == 1);
  const std::unordered_set<PartitionId> seen{PartitionId(4), PartitionId(9), PartitionId(4)};
  CHECK(seen.size() == 2);
  CHECK(seen.contains(PartitionId(9)));
}
