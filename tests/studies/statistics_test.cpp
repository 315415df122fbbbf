#include "studies/statistics.h"

#include <catch2/catch.hpp>

#include <algorithm>

namespace quadrille::studies {
namespace {

TEST_CASE("quartiles lie between neighbours in proportion") {
  const Spread odd = spread_of({5, 1, 4, 2, 3});
  CHECK(odd.median == 3);
  CHECK(odd.lower_quartile == 2);
  CHECK(odd.upper_quartile == 4);
  CHECK((odd.least == 1 && odd.most == 5));
  const Spread even = spread_of({40, 10, 30, 20});
  CHECK(even.median == 25);
  CHECK(even.lower_quartile == Approx(17.5));
  CHECK(even.upper_quartile == Approx(32.5));
  const Spread one = spread_of({7});
  CHECK((one.median == 7 && one.lower_quartile == 7 && one.upper_quartile == 7 && one.least == 7 &&
         one.most == 7));
}

TEST_CASE("one slow run moves the most and not the median") {
  const Spread s = spread_of({1.0, 1.1, 0.9, 1.0, 50.0});
  CHECK(s.median == 1.0);
  CHECK(s.upper_quartile == Approx(1.1));
  CHECK(s.most == 50);
}

TEST_CASE("every round runs each setting once") {
  for (const std::size_t rounds : {1u, 2u, 5u, 9u, 20u}) {
    for (std::size_t round = 0; round < rounds; ++round) {
      std::vector<std::size_t> order = round_order(9, round, rounds);
      std::ranges::sort(order);
      CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 8});
    }
  }
}

TEST_CASE(
    "over as many rounds as settings each setting takes each turn once, over fewer it takes turns far "
    "apart") {
  std::vector<std::vector<bool>> taken(6, std::vector<bool>(6, false));
  for (std::size_t round = 0; round < 6; ++round) {
    const auto order = round_order(6, round, 6);
    for (std::size_t turn = 0; turn < 6; ++turn) taken[order[turn]][turn] = true;
  }
  for (const auto& turns : taken) CHECK(std::ranges::all_of(turns, [](bool b) { return b; }));
  CHECK(round_order(9, 0, 3)[0] == 0);
  CHECK(round_order(9, 1, 3)[0] == 3);
  CHECK(round_order(9, 2, 3)[0] == 6);
}

}  // namespace
}  // namespace quadrille::studies
