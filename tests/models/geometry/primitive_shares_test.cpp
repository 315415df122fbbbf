/// Sharing draws between geometry front ends: every primitive is somebody's, once, and turns follow each
/// other.
#include "models/geometry/primitive_shares.h"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace quadrille::models;

namespace {

struct Draw {
  std::uint32_t instances, primitives;
  bool numbered = true;
};

/// All front ends of a machine, which are told the same draws.
struct Machine {
  Machine(std::uint32_t front_ends, std::uint32_t length) {
    for (std::uint32_t f = 0; f < front_ends; ++f) shares.emplace_back(f, front_ends, length);
  }
  /// Walks the draw as set-up takes it, from whoever has the turn; "instance:first-end" of each range with
  /// its front end before it.
  std::string walk(const Draw& draw) {
    std::string text;
    for (PrimitiveShares& s : shares) s.start_draw(draw.instances, draw.primitives, draw.numbered);
    for (bool more = true; more; turn = (turn + 1) % shares.size()) {
      PrimitiveShares& s = shares[turn];
      more = s.hands_on();
      for (bool first = true; !s.done() && (first || !draw.numbered || shares.size() == 1); first = false) {
        const std::uint32_t end = std::min(s.end(), draw.primitives);
        text += std::to_string(turn) + "=" + std::to_string(s.instance()) + ":" + std::to_string(s.first()) +
                "-" + std::to_string(end) + " ";
        covered += end - s.first();
        s.advance();
      }
      if (!more) CHECK(s.ends_draw());
    }
    for (std::size_t f = 0; f < shares.size(); ++f) {
      CHECK(shares[f].done());
      CHECK(shares[f].has_turn() == (f == turn));
    }
    return text;
  }
  std::vector<PrimitiveShares> shares;
  std::size_t turn = 0;
  std::uint64_t covered = 0;
};

}  // namespace

TEST_CASE("primitive_shares: one front end takes instance after instance") {
  Machine one(1, 4);
  CHECK(one.walk({2, 9}) == "0=0:0-9 0=1:0-9 ");
  CHECK(one.walk({1, 3, false}) == "0=0:0-3 ");
}

TEST_CASE("primitive_shares: ranges go round, from draw to draw, and end with their instance") {
  Machine two(2, 4);
  CHECK(two.walk({1, 9}) == "0=0:0-4 1=0:4-8 0=0:8-9 ");
  CHECK(two.walk({2, 5}) == "1=0:0-4 0=0:4-5 1=1:0-4 0=1:4-5 ");
  CHECK(two.walk({1, 4}) == "1=0:0-4 ");
}

TEST_CASE("primitive_shares: a draw that restarts, or has nothing, takes one turn") {
  Machine three(3, 2);
  CHECK(three.walk({2, 5, false}) == "0=0:0-5 0=1:0-5 ");
  CHECK(three.walk({0, 5}) == "");
  CHECK(three.walk({4, 0}) == "");
  CHECK(three.walk({1, 1}) == "0=0:0-1 ");
}

TEST_CASE("primitive_shares: each primitive of any draw is in one range, for any number of front ends") {
  for (std::uint32_t front_ends = 1; front_ends <= 5; ++front_ends) {
    for (const std::uint32_t length : {1u, 2u, 7u, 32u}) {
      Machine machine(front_ends, length);
      std::uint64_t all = 0;
      for (std::uint32_t i = 0; i < 200; ++i) {
        const Draw draw{i % 4, i * 7 % 41, i % 5 != 0};
        all += std::uint64_t{draw.instances} * draw.primitives;
        machine.walk(draw);
        CHECK(machine.covered == all);
      }
    }
  }
}

TEST_CASE("primitive_shares: the longest ranges of the largest draws do not overflow") {
  PrimitiveShares share(1, 2, 1u << 20);
  share.start_draw(0xffffffffu, 0xffffffffu, true);
  CHECK(share.first() == 1u << 20);
  CHECK(share.end() == 2u << 20);
  PrimitiveShares last(1, 2, 0xffffffffu);
  last.start_draw(2, 0xffffffffu, true);
  CHECK(last.instance() == 1);
  CHECK(last.end() == 0xffffffffu);
}
