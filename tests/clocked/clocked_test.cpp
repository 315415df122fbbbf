/// The kernel against the clocked simulator: every action of every unit, femtosecond by femtosecond.
#include "tests/clocked/clocked_simulator.h"

#include "hw/base/dispatcher.h"
#include "hw/base/native_driver.h"
#include "tests/hw/base/worlds.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::world;

namespace {

/// Fast edges after the last action during which the clocked simulator must stay silent, too: more than any
/// latency or service time of a random world.
constexpr std::int64_t kSilence = 500'000'000;

std::string first_difference(const WorldSpec& spec, const Trace& kernel, const Trace& clocked) {
  for (std::size_t u = 0; u < kernel.size(); ++u) {
    for (std::size_t i = 0; i < std::max(kernel[u].size(), clocked[u].size()); ++i) {
      const auto text = [i](const std::vector<Event>& events) {
        return i < events.size()
                   ? fmt::format("{} {}{} {:x}", events[i].at, events[i].what, events[i].port, events[i].id)
                   : std::string("nothing");
      };
      if (text(kernel[u]) != text(clocked[u])) {
        return fmt::format("{}, action {}: kernel {}, clocked {}", spec.units[u].name, i, text(kernel[u]),
                           text(clocked[u]));
      }
    }
  }
  return {};
}

/// Runs the world with a driver in this process and compares every action with the clocked simulator's.
template <class DriverType>
std::string compare(const WorldSpec& spec, std::uint64_t order_seed) {
  DriverType driver("driver");
  const World world(spec, driver);
  if (order_seed != 0) driver.shuffle(order_seed);
  driver.run({});
  const clocked::Result truth = clocked::simulate(spec, std::max<Tick>(0, driver.last_action()) + kSilence);
  if (driver.actions() < 10) return fmt::format("only {} actions", driver.actions());
  std::string text = first_difference(spec, world.trace(), truth.trace);
  std::int64_t left = 0;
  for (const int n : truth.tokens_in_links) left += n;
  if (tokens_in_links(driver.units()) != left)
    text += fmt::format(" {} tokens left, clocked {}", tokens_in_links(driver.units()), left);
  return text;
}

}  // namespace

TEST_CASE("kernel: the dispatcher equals the clocked simulator on random worlds, in any host order") {
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const WorldSpec spec = random_world(seed);
    INFO("seed " << seed << ", " << spec.units.size() << " units");
    CHECK(contract::in_child([&] { return compare<Dispatcher>(spec, 0); }, 20) == "");
    CHECK(contract::in_child([&] { return compare<Dispatcher>(spec, seed); }, 20) == "");
  }
}

TEST_CASE("kernel: the native driver equals the clocked simulator on random worlds") {
  for (std::uint64_t seed = 201; seed <= 260; ++seed) {
    const WorldSpec spec = random_world(seed);
    INFO("seed " << seed << ", " << spec.units.size() << " units");
    CHECK(contract::in_child([&] { return compare<NativeDriver>(spec, seed % 3); }, 20) == "");
  }
}

TEST_CASE("kernel: both drivers equal the clocked simulator on the benchmark's machine of 50 units") {
  for (const WorldSpec& spec :
       {benchmark_world(40), benchmark_world(40, {.depth = 16, .latency = 4, .credit = 4})}) {
    REQUIRE(spec.units.size() == 50);
    CHECK(contract::in_child([&] { return compare<Dispatcher>(spec, 7); }) == "");
    CHECK(contract::in_child([&] { return compare<NativeDriver>(spec, 7); }) == "");
  }
}

TEST_CASE(
    "kernel: machines of more units than a word has marks equal the clocked simulator in any host order") {
  WorldSpec spec;
  const int merge = spec.add({.role = Role::kArbiter});
  for (int lane = 0; lane < 4; ++lane) {
    int last = spec.add({.role = Role::kSource, .jitter = 5, .count = 40});
    for (int i = 0; i < 40; ++i) {
      const int stage = spec.add({.role = i % 7 == 3 ? Role::kSerial : Role::kStage, .jitter = 1 + i % 3});
      spec.wire({last, 0}, {stage, 0}, {.depth = 1 + i % 4});
      last = stage;
    }
    spec.wire({last, 0}, {merge, lane}, {.depth = 2});
  }
  spec.wire({merge, 0}, {spec.add({.role = Role::kSink, .period = 2}), 0}, {.depth = 3});
  REQUIRE(spec.units.size() > 128);
  for (const std::uint64_t order : {0u, 1u, 2u, 3u})
    CHECK(contract::in_child([&] { return compare<Dispatcher>(spec, order); }) == "");
  CHECK(contract::in_child([&] { return compare<NativeDriver>(spec, 1); }) == "");
}
