/// The checker itself: each rule holds at its exact distance and breaks one cycle before.
#include "tests/models/memory/dram_checker.h"

#include "tests/models/memory/dram_checker_cases.h"
#include "tests/models/memory/dram_rules.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace quadrille::models;
using namespace quadrille::models::dram_cases;

namespace {

DramChecker judge(const DramNumbers& numbers, const Trace& trace) {
  DramChecker checker(numbers);
  for (const DramCommand& command : trace) checker.check(command);
  return checker;
}

std::set<std::string> rules_broken(const DramChecker& checker) {
  std::set<std::string> names;
  for (const DramViolation& violation : checker.violations()) names.insert(violation.rule);
  return names;
}

}  // namespace

TEST_CASE("dram_checker: every timing rule holds at its distance and breaks one cycle before") {
  for (const ExactCase& c : exact_cases()) {
    DramNumbers numbers = toy();
    c.set(numbers);
    Trace trace = c.trace;
    INFO(c.rule << ", " << trace.size() << " commands to cycle " << trace.back().cycle);
    const bool alone = c.rule != "t_rtw: RD to WR" &&
                       c.rule != "t_rtrs: RD to WR of another rank";  // one command may break both
    CHECK(judge(numbers, trace).violation_count() == 0);
    --trace.back().cycle;
    const DramChecker illegal = judge(numbers, trace);
    const std::set<std::string> broken = rules_broken(illegal);
    CHECK(broken.count(c.rule) == 1);
    if (alone) CHECK(illegal.violation_count() == 1);
    if (!illegal.violations().empty()) {
      CHECK(illegal.violations().front().distance == illegal.violations().front().required - 1);
      CHECK(illegal.violations().front().command.cycle == trace.back().cycle);
    }
  }
}

TEST_CASE("dram_checker: what a command may do depends on the state of its bank") {
  for (const StateCase& c : state_cases()) {
    INFO(c.rule);
    CHECK(judge(toy(), c.legal).violation_count() == 0);
    const DramChecker illegal = judge(toy(), c.illegal);
    CHECK(illegal.violation_count() == 1);
    CHECK(rules_broken(illegal) == std::set<std::string>{c.rule});
  }
}

TEST_CASE("dram_checker: a rule does not reach beyond its scope") {
  DramNumbers n = toy();
  n.t_rcd = n.t_ras = n.t_rc = n.t_rp = n.t_rtp = n.t_wr = n.t_rrd_s = n.t_rrd_l = n.t_faw = n.t_ccd_s =
      n.t_ccd_l = n.t_wtr_s = n.t_wtr_l = n.t_rfc = 50;
  SECTION("another rank activates, and refreshes, when it likes") {
    CHECK(judge(n, {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(51, Kind::kWrite),
                    at(57, Kind::kRead, kRank)})
              .violation_count() == 0);
    CHECK(judge(n, {at(0, Kind::kRefresh), at(1, Kind::kActivate, kRank)}).violation_count() == 0);
  }
  SECTION("another pseudo-channel shares nothing, not even the cycle") {
    CHECK(judge(n, {at(0, Kind::kActivate), at(0, Kind::kActivate, kChannel), at(50, Kind::kRead),
                    at(50, Kind::kWrite, kChannel)})
              .violation_count() == 0);
  }
  SECTION("with a shared command bus it shares the bus alone") {
    n.shared_commands = true;
    CHECK(judge(n, {at(0, Kind::kActivate), at(1, Kind::kActivate, kChannel), at(51, Kind::kRead),
                    at(52, Kind::kWrite, kChannel)})
              .violation_count() == 0);
  }
  SECTION("row and column commands meet on one bus but not on two") {
    const Trace trace{at(0, Kind::kActivate), at(50, Kind::kRead), at(50, Kind::kActivate, kGroup)};
    CHECK(rules_broken(judge(n, trace)) == std::set<std::string>{"command bus"});
    n.separate_buses = true;
    CHECK(judge(n, trace).violation_count() == 0);
  }
}

TEST_CASE("dram_checker: nine intervals of refresh are the most that may pass without one") {
  DramNumbers n = toy();
  SECTION("all banks: the ninth interval may end, not a cycle more") {
    CHECK(judge(n, {at(9000, Kind::kRefresh)}).violation_count() == 0);
    CHECK(rules_broken(judge(n, {at(9001, Kind::kRefresh)})) == std::set<std::string>{"refresh too late"});
    DramChecker silent(n);
    silent.finish(9000);
    CHECK(silent.violation_count() == 0);
    silent.finish(9001);
    CHECK(silent.violation_count() == 4);  // two ranks in each of two pseudo-channels
  }
  SECTION("one bank left out is found behind the others") {
    Trace trace;
    std::int64_t cycle = 0;
    for (const Place& place : {kHere, kBeside, kGroup, kGroupBeside})
      trace.push_back(at(cycle += 100, Kind::kRefreshBank, place));
    trace.push_back(at(10000, Kind::kRefreshBank));
    CHECK(judge(n, trace).violation_count() == 0);
    trace.erase(trace.begin() + 2);
    CHECK(rules_broken(judge(n, trace)) == std::set<std::string>{"refresh too late"});
  }
  SECTION("refreshes ahead of time count, but no more than eight") {
    Trace trace;
    for (int i = 0; i < 20; ++i) trace.push_back(at(i, Kind::kRefresh));
    trace.push_back(at(17000, Kind::kRefresh));
    CHECK(judge(n, trace).violation_count() == 0);
    ++trace.back().cycle;
    CHECK(rules_broken(judge(n, trace)) == std::set<std::string>{"refresh too late"});
  }
  SECTION("a standard without refresh of single banks has none") {
    n.refresh = DramRefreshKind::kAllBank;
    CHECK(rules_broken(judge(n, {at(0, Kind::kRefreshBank)})) ==
          std::set<std::string>{"refresh of a kind that there is not"});
    CHECK(judge(n, {at(0, Kind::kRefresh)}).violation_count() == 0);
  }
}

TEST_CASE("dram_checker: every rule of every standard has been broken above") {
  std::set<std::string> tested{"refresh too late", "refresh of a kind that there is not"};
  for (const ExactCase& c : exact_cases()) tested.insert(c.rule);
  for (const StateCase& c : state_cases()) tested.insert(c.rule);
  std::set<std::string> rules(DramChecker::other_rules().begin(), DramChecker::other_rules().end());
  for (const std::string& standard : dram_standards()) {
    const std::vector<DramPairRule> pairs = dram_pair_rules(dram_numbers(standard));
    for (const DramPairRule& rule : pairs) rules.insert(rule.name);
  }
  CHECK(std::includes(tested.begin(), tested.end(), rules.begin(), rules.end()));
}

TEST_CASE("dram_checker: a violation says the rule, both commands and the distance") {
  DramNumbers n = toy();
  n.t_rcd = 20;
  const DramChecker checker = judge(n, {at(0, Kind::kActivate, kHere, 3), at(12, Kind::kRead, kHere, 3, 1)});
  REQUIRE(checker.violations().size() == 1);
  CHECK(checker.violations().front().text() ==
        "t_rcd: ACT to RD: RD at 12 (pseudo-channel 0, rank 0, group 0, bank 0, row 3, column 1) after "
        "ACT at 0 (pseudo-channel 0, rank 0, group 0, bank 0, row 3, column 0); 12 seen, 20 required");
}
