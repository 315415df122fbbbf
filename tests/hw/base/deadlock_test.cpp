/// Machines that cannot progress, and what the report says of them.
#include "tests/hw/base/scenario.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::world;

namespace {

std::string report_of(const WorldSpec& spec) {
  return contract::in_child([&] {
    Dispatcher driver("driver");
    const World world(spec, driver);
    if (driver.run({}) != RunEnd::kQuiescent || tokens_in_links(driver.units()) == 0)
      return std::string("no deadlock");
    return deadlock_report(driver.units(), driver.last_action());
  });
}

}  // namespace

TEST_CASE(
    "deadlock: a ring that feeds itself until every link is full is reported with its units, its cycle and "
    "its thinnest link") {
  WorldSpec w;
  const int source = w.add({.name = "source", .role = Role::kSource, .count = 100});
  const int merge = w.add({.name = "merge", .role = Role::kArbiter});
  const int grow = w.add({.name = "grow", .role = Role::kFork});
  const int sink = w.add({.name = "sink", .role = Role::kSink, .period = 1});
  w.wire({source, 0}, {merge, 0}, {.depth = 2});
  w.wire({merge, 0}, {grow, 0}, {.depth = 3});
  w.wire({grow, 0}, {merge, 1}, {.depth = 2});
  w.wire({grow, 1}, {sink, 0}, {.depth = 4});
  const std::string text = report_of(w);
  INFO(text);
  CHECK_THAT(text,
             Catch::Contains("merge (cycle ") &&
                 Catch::Contains("waits for room in link_merge_0 (port out0, 3 of 3 slots taken, to grow)"));
  CHECK_THAT(text, Catch::Contains("cycle of waiting: merge -out0-> grow -out0-> merge") ||
                       Catch::Contains("cycle of waiting: grow -out0-> merge -out0-> grow"));
  CHECK_THAT(text, Catch::Contains("to blame: link link_grow_0 is full; raise its depth (2 now)"));
}

TEST_CASE("deadlock: a join behind a shallow branch waits for the fork that waits for the join") {
  WorldSpec w;
  const int source = w.add({.name = "source", .role = Role::kSource, .count = 100});
  const int fork = w.add({.name = "fork", .role = Role::kFork});
  const int pack = w.add({.name = "pack", .role = Role::kPack, .count = 4});
  const int join = w.add({.name = "join", .role = Role::kJoin});
  const int sink = w.add({.name = "sink", .role = Role::kSink});
  w.wire({source, 0}, {fork, 0});
  w.wire({fork, 0}, {join, 0}, {.depth = 2});  // four tokens would have to wait here for one of the pack's
  w.wire({fork, 1}, {pack, 0}, {.depth = 8});
  w.wire({pack, 0}, {join, 1});
  w.wire({join, 0}, {sink, 0});
  const std::string text = report_of(w);
  INFO(text);
  CHECK_THAT(text, Catch::Contains("join (cycle ") &&
                       Catch::Contains(
                           "waits for a token in link_pack_0 (port in1, 0 of 4 slots taken, from pack)"));
  CHECK_THAT(text, Catch::Contains("to blame: link link_fork_0 is full; raise its depth (2 now)"));
}

TEST_CASE("deadlock: tokens that nobody takes because a partner ran out are named when there is no cycle") {
  WorldSpec w;
  const int many = w.add({.name = "many", .role = Role::kSource, .count = 9});
  const int few = w.add({.name = "few", .role = Role::kSource, .count = 2});
  const int join = w.add({.name = "join", .role = Role::kJoin});
  const int sink = w.add({.name = "sink", .role = Role::kSink});
  w.wire({many, 0}, {join, 0});
  w.wire({few, 0}, {join, 1});
  w.wire({join, 0}, {sink, 0});
  const std::string text = report_of(w);
  INFO(text);
  CHECK_THAT(text, Catch::Contains("to blame: link link_many_0 holds 4 tokens that join does not take; it "
                                   "waits for in1 of link link_few_0 by few"));
}

TEST_CASE("deadlock: the contract harness reports it as a violation when a machine says it did not finish") {
  class Unfinished final : public contract::Specimen {
   public:
    Unfinished(const WorldSpec& s, Driver& d, const contract::Variation& v) : world_(s, d, v) {}
    [[nodiscard]] std::uint64_t digest() const override { return 0; }
    [[nodiscard]] bool finished() const override { return false; }

   private:
    World world_;
  };
  WorldSpec w;
  w.wire({w.add({.role = Role::kSource, .count = 3}), 0}, {w.add({.role = Role::kSink}), 0});
  const auto outcome = contract::run_forked(
      [&](Driver& d, const contract::Variation& v) { return std::make_unique<Unfinished>(w, d, v); }, {});
  CHECK_THAT(outcome.failure, Catch::Contains("did not finish") && Catch::Contains("nothing can act"));
}
