/// Where a unit's cycles go, in closed form. Every outcome has passed the law busy + starved + blocked + idle
/// = cycles (contract.h).
#include "tests/hw/base/scenario.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::world;

namespace {

constexpr Tick kCycle = 1'000'000;

struct Charges {
  std::int64_t busy, starved, blocked, idle;
  friend bool operator==(const Charges&, const Charges&) = default;
};
std::ostream& operator<<(std::ostream& os, const Charges& c) {
  return os << "busy " << c.busy << " starved " << c.starved << " blocked " << c.blocked << " idle "
            << c.idle;
}
Charges charges(const contract::Outcome& o, const std::string& unit) {
  return {o.figures.at(unit + ".busy"), o.figures.at(unit + ".starved"), o.figures.at(unit + ".blocked"),
          o.figures.at(unit + ".idle")};
}

/// source -> stage -> sink with links that never limit, unless their specs do.
WorldSpec pipeline(UnitSpec source, UnitSpec stage, UnitSpec sink, WireSpec first = {.depth = 8},
                   WireSpec second = {.depth = 8}) {
  WorldSpec w;
  source.name = "source";
  source.role = Role::kSource;
  stage.name = "stage";
  sink.name = "sink";
  sink.role = Role::kSink;
  const int a = w.add(source), b = w.add(stage), c = w.add(sink);
  w.wire({a, 0}, {b, 0}, first);
  w.wire({b, 0}, {c, 0}, second);
  return w;
}

}  // namespace

TEST_CASE("attribution: a slow source starves the stage") {
  // Tokens leave at 0, 5, .., 45; the stage acts at 1, 6, .., 46, the sink at 2, 7, .., 47.
  const auto o = outcome_of(pipeline({.period = 5, .count = 10}, {}, {}));
  REQUIRE(o.failure == "");
  CHECK(o.end == 48 * kCycle);
  CHECK(charges(o, "source") == Charges{48, 0, 0, 0});  // its slot is taken to cycle 50; the frame ends at 48
  // 1 before the first token and 4 between tokens; idle after the last one
  CHECK(charges(o, "stage") == Charges{10, 37, 0, 1});
  CHECK(charges(o, "sink") == Charges{10, 38, 0, 0});
}

TEST_CASE("attribution: a slow sink blocks the stage, and the stage the source") {
  // Links one deep with round trip 2; the sink pops at 2, 12, 22, .., 92.
  const auto o = outcome_of(pipeline({.count = 10}, {}, {.period = 10}, {.depth = 1}, {.depth = 1}));
  REQUIRE(o.failure == "");
  CHECK(o.end == 93 * kCycle);
  // The stage pushes at 1, 3, 13, .., 83: starved before 1, then blocked until the sink's credit.
  CHECK(charges(o, "stage") == Charges{10, 1, 73, 9});
  // The source pushes at 0, 2, 4, 14, .., 74; then nothing can reach it any more.
  CHECK(charges(o, "source") == Charges{10, 0, 65, 18});
  CHECK(charges(o, "sink") == Charges{91, 2, 0, 0});
}

TEST_CASE("attribution: a wait for both sides that ends on both at once goes to the output") {
  // Depth 1, round trip 4 on both links: from the second token on, token and credit arrive in the same cycle.
  const WireSpec slow{.depth = 1, .latency = 2, .credit = 2};
  const auto o = outcome_of(pipeline({.count = 5}, {}, {}, slow, slow));
  REQUIRE(o.failure == "");
  // The stage acts at 2, 6, .., 18; the sink at 4, .., 20.
  CHECK(o.end == 21 * kCycle);
  CHECK(charges(o, "stage") == Charges{5, 2, 12, 2});
}

TEST_CASE("attribution: a unit's own work is busy, also while tokens wait") {
  const auto o = outcome_of(pipeline({.count = 10}, {.period = 4}, {}));
  REQUIRE(o.failure == "");
  CHECK(o.end == 39 * kCycle);  // the stage acts at 1, 5, .., 37; the sink at 38
  CHECK(charges(o, "stage") == Charges{38, 1, 0, 0});
}

TEST_CASE("attribution: what comes after the last token that can reach a unit is idle") {
  const auto o = outcome_of(pipeline({.count = 4}, {}, {}), 100 * kCycle);
  REQUIRE(o.failure == "");
  CHECK(charges(o, "source") == Charges{4, 0, 0, 96});
  CHECK(charges(o, "stage") == Charges{4, 1, 0, 95});
  CHECK(charges(o, "sink") == Charges{4, 2, 0, 94});
}

TEST_CASE(
    "attribution: a unit behind a filter is starved as long as a token upstream could still come to it") {
  // The router sends every token to one of two sinks; the other one stays starved until the last token has
  // passed the router.
  WorldSpec w;
  const int source = w.add({.name = "source", .role = Role::kSource, .period = 3, .count = 20});
  const int route = w.add({.name = "route", .role = Role::kRoute});
  const int sinks[] = {w.add({.name = "sink0", .role = Role::kSink}),
                       w.add({.name = "sink1", .role = Role::kSink})};
  w.wire({source, 0}, {route, 0}, {.depth = 8});
  for (const int i : {0, 1}) w.wire({route, i}, {sinks[i], 0}, {.depth = 8});
  const auto o = outcome_of(w, 200 * kCycle);
  REQUIRE(o.failure == "");
  // The last token leaves the source at 57 and the router at 58. One sink gets it at 59, the other can expect
  // one until 58.
  const Charges a = charges(o, "sink0"), b = charges(o, "sink1");
  CHECK(a.busy + b.busy == 20);
  CHECK(std::min(a.idle, b.idle) == 140);
  CHECK(std::max(a.idle, b.idle) == 142);
}

TEST_CASE("attribution: cycles are those of the unit's own clock") {
  auto w = pipeline({.clock = 0, .period = 10, .count = 10}, {.clock = 1}, {.clock = 2});
  w.clocks_hz = {1'000'000'000, 500'000'000, 618'033'989};
  const auto o = outcome_of(w, 1000 * kCycle);
  REQUIRE(o.failure == "");
  CHECK(o.figures.at("source.cycles") == 1000);
  CHECK(o.figures.at("stage.cycles") == 500);
  CHECK(o.figures.at("sink.cycles") == 619);  // edges in [0, 1 us): the one at 0 and 618 more
  CHECK(o.figures.at("stage.busy") == 10);
  CHECK(o.figures.at("sink.busy") == 10);
}

TEST_CASE(
    "attribution: intervals in which no draw is in flight are idle for every unit, also inside a wait") {
  const std::string text = contract::in_child([] {
    const WorldSpec w = pipeline({.period = 50, .count = 2}, {}, {});
    QuietLog quiet;
    quiet.add(10 * kCycle, 30 * kCycle);
    quiet.add(40 * kCycle + 1, 45 * kCycle + 1);  // off the edges: cycles 41 to 45
    Dispatcher driver("driver");
    World world(w, driver);
    for (int i = 0; i < 3; ++i) world.unit(i).set_quiet_log(quiet);
    driver.run({});
    close_accounts(driver.units(), 60 * kCycle);
    std::string all;
    for (int i = 0; i < 3; ++i) {
      const Unit& u = world.unit(i);
      all += fmt::format("{} {} {} {};", u.busy_cycles(), u.starved_cycles(), u.blocked_cycles(),
                         u.idle_cycles());
    }
    return all;
  });
  // Stage: acts at 1 and 51; waits of 1 and 49 cycles, 25 of them quiet; idle from 52 on. The source's own
  // slot is busy whatever the log says.
  CHECK(text == "60 0 0 0;2 25 0 33;2 26 0 32;");
}

TEST_CASE("attribution: a frame that ends thousands of charges ago keeps the sum of its cycles") {
  const std::string text = contract::in_child([] {
    // Every token is a charge for the stage's work and one for its wait.
    const WorldSpec w = pipeline({.period = 20, .count = 2000}, {}, {});
    Dispatcher driver("driver");
    World world(w, driver);
    driver.run({});
    close_accounts(driver.units(), 60 * kCycle);
    const Unit& stage = world.unit(1);
    std::int64_t waited = 0;
    for (const PortBase* port : stage.ports()) waited += port->waited();
    return fmt::format(
        "{} cycles, ports waited {} of {}",
        stage.busy_cycles() + stage.starved_cycles() + stage.blocked_cycles() + stage.idle_cycles(), waited,
        stage.starved_cycles() + stage.blocked_cycles());
  });
  CHECK(text == "60 cycles, ports waited 60 of 60");
}

TEST_CASE(
    "attribution: the four charges sum to the cycles in every unit of random worlds, wherever the frame is "
    "cut") {
  for (std::uint64_t seed = 301; seed <= 330; ++seed) {
    const WorldSpec spec = random_world(seed);
    INFO("seed " << seed);
    const auto whole = outcome_of(spec);
    CHECK(whole.failure == "");
    CHECK(outcome_of(spec, whole.end + 12'345'678).failure == "");
  }
}
