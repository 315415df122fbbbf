/// The contract harness on synthetic machines: it passes what is right and finds what is wrong.
#include "tests/hw/base/scenario.h"

#include "hw/base/native_driver.h"

#include <catch2/catch.hpp>

#include <unistd.h>

using namespace quadrille::hw;
using namespace quadrille::hw::world;

namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& l : lines) text += l + '\n';
  return text;
}

/// Two sources of different speed into one arbiter, whose order of service shows in the sink's trace.
WorldSpec arbitration(bool lie) {
  WorldSpec w;
  const int fast = w.add({.name = "fast", .role = Role::kSource, .period = 2, .jitter = 3, .count = 60});
  const int slow = w.add({.name = "slow", .role = Role::kSource, .period = 5, .jitter = 7, .count = 40});
  const int stage = w.add({.name = "stage", .role = Role::kSerial, .service = 3, .spread = 9});
  const int merge = w.add({.name = "merge", .role = Role::kArbiter, .declared_fixed = lie});
  const int sink = w.add({.name = "sink", .role = Role::kSink});
  w.wire({fast, 0}, {merge, 0}, {.depth = 16});
  w.wire({slow, 0}, {stage, 0}, {.depth = 4});
  w.wire({stage, 0}, {merge, 1}, {.depth = 4});
  w.wire({merge, 0}, {sink, 0}, {.depth = 64});
  return w;
}

}  // namespace

TEST_CASE(
    "contract: random worlds keep it, whatever the host order, the order of creation, the driver and the "
    "depths") {
  for (std::uint64_t seed = 401; seed <= 412; ++seed) {
    INFO("seed " << seed);
    CHECK(joined(contract::violations(builder_of(random_world(seed)),
                                      {.shuffles = 3, .creations = 2, .digest_at_depth_one = false})) == "");
  }
}

TEST_CASE(
    "contract: a machine whose result does not depend on timing keeps its digest with all links one deep") {
  class Sum final : public contract::Specimen {
   public:
    Sum(const WorldSpec& s, Driver& d, const contract::Variation& v) : world_(s, d, v) {}
    [[nodiscard]] std::uint64_t digest() const override {
      std::uint64_t sum = 0;
      for (const Event& e : world_.trace().back()) sum += e.id;
      return sum;
    }

   private:
    World world_;
  };
  CHECK(joined(contract::violations([](Driver& d, const contract::Variation& v) {
          return std::make_unique<Sum>(arbitration(false), d, v);
        })) == "");
}

TEST_CASE("contract: an arbiter declared fixed-order is caught") {
  CHECK(joined(contract::violations(builder_of(arbitration(false)), {.depth_one = false})) == "");
  const std::string text = joined(contract::violations(builder_of(arbitration(true)), {.depth_one = false}));
  INFO(text);
  CHECK_THAT(text, Catch::Contains("native driver") && Catch::Contains("digest"));
}

TEST_CASE("contract: a unit that looks at room and is declared fixed-order is caught") {
  WorldSpec w;
  const int source = w.add({.name = "source", .role = Role::kSource, .count = 200});
  const int spread = w.add({.name = "spread", .role = Role::kSpread, .declared_fixed = true});
  const int fast = w.add({.name = "fast", .role = Role::kSink, .period = 1, .jitter = 4});
  const int slow = w.add({.name = "slow", .role = Role::kSink, .period = 3, .jitter = 9});
  w.wire({source, 0}, {spread, 0}, {.depth = 8});
  w.wire({spread, 0}, {fast, 0}, {.depth = 3});
  w.wire({spread, 1}, {slow, 0}, {.depth = 2});
  CHECK_FALSE(contract::violations(builder_of(w), {.depth_one = false}).empty());
}

TEST_CASE("contract: a crash, an exception and an endless run of the machine are reported, not suffered") {
  using contract::in_child;
  CHECK_THAT(in_child([]() -> std::string {
               QUADRILLE_CHECK(false, "told {}", "so");
               return {};
             }),
             Catch::Contains("failed: signal") && Catch::Contains("told so"));
  CHECK_THAT(in_child([]() -> std::string { throw quadrille::user_error("no such {}", "thing"); }),
             Catch::Contains("failed: no such thing"));
  CHECK_THAT(in_child(
                 []() -> std::string {
                   for (;;) pause();
                 },
                 1),
             Catch::Contains("still running after 1 s"));
}

TEST_CASE("driver: a time limit stops both drivers after the same actions") {
  const auto actions = [](bool native, Tick limit) {
    return contract::in_child([=]() -> std::string {
      std::unique_ptr<Driver> driver;
      if (native) driver = std::make_unique<NativeDriver>("driver");
      else driver = std::make_unique<Dispatcher>("driver");
      const World world(arbitration(false), *driver);
      const RunEnd end = driver->run({.max_time = limit, .progress = {}});
      return fmt::format("{} {} {}", end == RunEnd::kTimeLimit ? "limit" : "quiescent", driver->actions(),
                         world.digest());
    });
  };
  for (const Tick limit : {Tick{0}, Tick{100'000'000}, Tick{100'500'000}, Tick{10'000'000'000}}) {
    CHECK(actions(false, limit) == actions(true, limit));
    CHECK_THAT(actions(false, limit), Catch::StartsWith(limit == 10'000'000'000 ? "quiescent" : "limit"));
  }
}

TEST_CASE("dispatcher: a window is bounded and every token still arrives") {
  const auto run = [](Tick window) {
    return contract::in_child([=] {
      Dispatcher driver("driver", window);
      const World world(arbitration(false), driver);
      driver.run({});
      return fmt::format("{} {}", world.trace().back().size(), tokens_in_links(driver.units()));
    });
  };
  CHECK(run(0) == "100 0");
  CHECK(run(50'000'000) == "100 0");
}
