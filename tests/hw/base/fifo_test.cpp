/// Rates of links in closed form, and what a link refuses.
#include "tests/hw/base/scenario.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::world;

namespace {

constexpr int kTokens = 600;
constexpr Tick kCycle = 1'000'000;  // fs at 1 GHz

/// Cycles from the first push to the last, when source and sink could do `width` tokens a cycle.
std::int64_t cycles_of_flow(int depth, int width, int latency, int credit) {
  WorldSpec w;
  const int source = w.add({.name = "source", .role = Role::kSource, .rate = width, .count = kTokens});
  const int sink = w.add({.name = "sink", .role = Role::kSink, .rate = width});
  w.wire({source, 0}, {sink, 0}, {.depth = depth, .width = width, .latency = latency, .credit = credit});
  const auto outcome = outcome_of(w);
  REQUIRE(outcome.failure == "");
  // The last token is popped `latency` cycles after its push, and the accounts end one cycle later.
  return outcome.end / kCycle - latency - 1;
}

}  // namespace

TEST_CASE("fifo: full rate exactly when depth >= width x (latency + credit latency)") {
  for (const int width : {1, 2, 3}) {
    for (const int latency : {1, 2, 5}) {
      for (const int credit : {1, 3}) {
        const int enough = width * (latency + credit);
        const int full_rate = (kTokens + width - 1) / width - 1;
        CHECK(cycles_of_flow(enough, width, latency, credit) == full_rate);
        CHECK(cycles_of_flow(enough + 5, width, latency, credit) == full_rate);
        CHECK(cycles_of_flow(enough - 1, width, latency, credit) > full_rate);
      }
    }
  }
}

TEST_CASE("fifo: a shallower one moves depth tokens a round trip") {
  for (const int depth : {1, 2, 3, 4}) {
    for (const int latency : {2, 3, 6}) {
      const int round_trip = latency + 2;
      if (depth >= round_trip) continue;
      // Token k leaves (k / depth) round trips after the first, and k % depth cycles more.
      const int expected = (kTokens - 1) / depth * round_trip + (kTokens - 1) % depth;
      CHECK(cycles_of_flow(depth, 1, latency, 2) == expected);
    }
  }
}

TEST_CASE("fifo: a crossing costs two cycles of the receiver each way, and says so") {
  const std::string text = contract::in_child([] {
    WorldSpec w;
    w.clocks_hz = {1'000'000'000, 500'000'000};
    const int source = w.add({.name = "source", .role = Role::kSource, .clock = 0, .count = 1});
    const int sink = w.add({.name = "sink", .role = Role::kSink, .clock = 1});
    w.wire({source, 0}, {sink, 0}, {.latency = 3, .credit = 1});
    Dispatcher driver("driver");
    World world(w, driver);
    driver.run({});
    const FifoBase& link = world.link(0);
    return fmt::format("{} {} {} {}", link.crosses_clocks(), link.spec().latency, link.spec().credit_latency,
                       world.trace()[1][0].at / kCycle);
  });
  CHECK(text == "true 5 3 10");  // pushed at 0, which is an edge of both: five periods of 2 ns later
}

TEST_CASE(
    "fifo: a second producer, an unbound port, a push without room and an illegal shape are named errors") {
  const auto shape = [](LinkSpec spec) {
    return contract::in_child([spec] {
      Dispatcher d("driver");
      Fifo<Token> f("thin", spec);
      return std::string();
    });
  };
  for (const LinkSpec& bad : {LinkSpec{0, 1, 1, 1}, LinkSpec{1, 0, 1, 1}, LinkSpec{1, 1, 0, 1},
                              LinkSpec{1, 1, 1, 0}, LinkSpec{-1, 1, 1, 1}}) {
    CHECK_THAT(shape(bad), Catch::Contains("link thin"));
  }
  const auto two_units =
      [](const std::function<void(SyntheticUnit&, SyntheticUnit&, SyntheticUnit&, Fifo<Token>&)>& misuse) {
        return contract::in_child([&] {
          Dispatcher driver("driver");
          UnitSpec s{.name = "a", .role = Role::kSource, .count = 9, .outputs = 1};
          UnitSpec t{.name = "b", .role = Role::kSource, .count = 9, .outputs = 1};
          UnitSpec u{.name = "c", .role = Role::kSink, .inputs = 1};
          const Clock clock;
          const auto a = make_unit(s, clock, {}), b = make_unit(t, clock, {}),
                     c = make_unit(u, clock, {LinkRole::kFlow});
          Fifo<Token> link("thin", {.depth = 1});
          for (Unit* unit : {a.get(), b.get(), c.get()}) driver.add(*unit);
          misuse(*a, *b, *c, link);
          driver.run({});
          return std::string("ran");
        });
      };
  CHECK_THAT(two_units([](auto& a, auto& b, auto& c, auto& link) {
               a.out(0).bind(link);
               b.out(0).bind(link);
               c.in(0).bind(link);
             }),
             Catch::Contains("link thin has two producers"));
  CHECK_THAT(two_units([](auto& a, auto&, auto& c, auto& link) {
               a.out(0).bind(link);
               c.in(0).bind(link);
             }),
             Catch::Contains("out0"));
  CHECK_THAT(contract::in_child([] {
               Dispatcher driver("driver");
               const WorldSpec w = [] {
                 WorldSpec x;
                 const int source = x.add({.name = "source", .role = Role::kSource, .count = 0});
                 x.wire({source, 0}, {x.add({.name = "sink", .role = Role::kSink}), 0}, {.depth = 1});
                 return x;
               }();
               World world(w, driver);
               driver.run({});
               world.link(0).push(0, {});
               world.link(0).push(0, {});
               return std::string();
             }),
             Catch::Contains("push into link_source_0 at 0 fs without room"));
}
