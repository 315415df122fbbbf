#include "models/geometry/post_transform.h"

#include "tests/models/aborts.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <map>

using namespace quadrille::models;

TEST_CASE("post_transform: a batch gives each distinct vertex one lane in order of arrival") {
  RandomSource random(101);
  for (int round = 0; round < 300; ++round) {
    VertexReuse reuse;
    std::map<std::uint32_t, int> lanes;
    // Indices that meet in the hash table: the same bits, and far ones.
    const std::uint32_t base = random.bits(), step = round % 3 == 0 ? 1u << 25 : 1u;
    for (int i = 0; i < 500; ++i) {
      std::array<std::uint32_t, 3> triangle;
      for (std::uint32_t& v : triangle) v = base + step * static_cast<std::uint32_t>(random.integer(0, 60));
      int added = 0;
      std::map<std::uint32_t, int> after = lanes;
      for (const std::uint32_t v : triangle) {
        if (after.emplace(v, reuse.size() + added).second) ++added;
      }
      REQUIRE(reuse.fits(triangle) == (after.size() <= 32));
      if (!reuse.fits(triangle)) {
        reuse.reset();
        lanes.clear();
        CHECK(reuse.size() == 0);
        CHECK(reuse.find(triangle[0]) == -1);
        continue;
      }
      for (const std::uint32_t v : triangle) {
        const int lane = reuse.find_or_add(v);
        lanes.emplace(v, lane);
        REQUIRE(lane == after.at(v));
        REQUIRE(reuse.find(v) == lane);
        REQUIRE(reuse.index(lane) == v);
      }
      REQUIRE(static_cast<std::size_t>(reuse.size()) == lanes.size());
    }
  }
}

TEST_CASE("post_transform: a full batch refuses another vertex") {
  VertexReuse reuse;
  for (std::uint32_t i = 0; i < 32; ++i) CHECK(reuse.find_or_add(i * 7) == static_cast<int>(i));
  CHECK(reuse.fits({0, 7, 14}));
  CHECK_FALSE(reuse.fits({0, 7, 1}));
  CHECK(reuse.find(1) == -1);
  CHECK(aborts([&] { (void)reuse.find_or_add(1); }));
}
