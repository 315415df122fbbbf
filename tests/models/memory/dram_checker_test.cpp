#include "tests/models/memory/dram_checker.h"

#include "tests/models/memory/dram_rules.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <set>

using namespace quadrille::models;

namespace {

using Kind = DramCommandKind;
using Trace = std::vector<DramCommand>;

/// A place in the toy channel below.
struct Place {
  std::uint8_t channel = 0, rank = 0;
  std::uint16_t group = 0, bank = 0;
};
constexpr Place kHere{};
constexpr Place kBeside{.bank = 1};  // another bank of the group
constexpr Place kGroup{.group = 1};  // another group of the rank
constexpr Place kGroupBeside{.group = 1, .bank = 1};
constexpr Place kRank{.rank = 1};
constexpr Place kChannel{.channel = 1};

DramCommand at(std::int64_t cycle, Kind kind, Place place = kHere, std::int32_t row = 0,
               std::int32_t column = 0) {
  return {cycle, kind, place.channel, place.rank, place.group, place.bank, row, column};
}

/// A channel in which nearly nothing has to wait, so that a rule shows alone when its number is raised: two
/// pseudo-channels, ranks, groups and banks a group; rows of eight bursts; data 4 cycles after the command
/// for 1 cycle.
DramNumbers toy() {
  DramNumbers n{.pseudo_channels = 2,
                .ranks = 2,
                .bank_groups = 2,
                .banks = 4,
                .rows = 16,
                .row_bytes = 256,
                .burst_bytes = 32};
  n.t_cas = n.t_cwl = 4;
  n.t_wtr_s = n.t_wtr_l = 0;
  n.t_wr = 0;
  n.t_refi = 1000;
  n.refresh = DramRefreshKind::kPerBank;
  return n;
}

DramChecker judge(const DramNumbers& numbers, const Trace& trace) {
  DramChecker checker(numbers);
  for (const DramCommand& command : trace) checker.check(command);
  return checker;
}

/// A trace whose last command is legal at its cycle and breaks `rule`, and no other, one cycle earlier.
struct ExactCase {
  std::string rule;
  std::function<void(DramNumbers&)> set;
  Trace trace;
};

/// The number raised to 20.
std::function<void(DramNumbers&)> twenty(int DramNumbers::*member) {
  return [member](DramNumbers& n) { n.*member = 20; };
}

using N = DramNumbers;

const std::vector<ExactCase>& bank_cases() {
  static const std::vector<ExactCase> cases{
      {"t_rcd: ACT to RD", twenty(&N::t_rcd), {at(0, Kind::kActivate), at(20, Kind::kRead)}},
      {"t_rcd: ACT to RD", twenty(&N::t_rcd), {at(0, Kind::kActivate), at(20, Kind::kReadPrecharge)}},
      {"t_rcd_wr: ACT to WR", twenty(&N::t_rcd_wr), {at(0, Kind::kActivate), at(20, Kind::kWrite)}},
      {"t_rcd_wr: ACT to WR", twenty(&N::t_rcd_wr), {at(0, Kind::kActivate), at(20, Kind::kWritePrecharge)}},
      {"t_ras: ACT to PRE", twenty(&N::t_ras), {at(0, Kind::kActivate), at(20, Kind::kPrecharge)}},
      {"t_rc: ACT to ACT",
       twenty(&N::t_rc),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(20, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(25, Kind::kActivate)}},
      {"t_rtp: RD to PRE",
       twenty(&N::t_rtp),
       {at(0, Kind::kActivate), at(3, Kind::kRead), at(23, Kind::kPrecharge)}},
      // The last data of the write end 5 cycles after it.
      {"t_wr: WR to PRE",
       twenty(&N::t_wr),
       {at(0, Kind::kActivate), at(3, Kind::kWrite), at(28, Kind::kPrecharge)}},
      // With a precharge of its own: the read's begins t_rtp after it, or t_ras after the activation, and
      // takes t_rp.
      {"t_rp: PRE to ACT",
       twenty(&N::t_rtp),
       {at(0, Kind::kActivate), at(3, Kind::kReadPrecharge), at(24, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_ras),
       {at(0, Kind::kActivate), at(3, Kind::kReadPrecharge), at(21, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate), at(3, Kind::kReadPrecharge), at(24, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_wr),
       {at(0, Kind::kActivate), at(3, Kind::kWritePrecharge), at(29, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_ras),
       {at(0, Kind::kActivate), at(3, Kind::kWritePrecharge), at(21, Kind::kActivate)}},
  };
  return cases;
}

const std::vector<ExactCase>& rank_cases() {
  static const std::vector<ExactCase> cases{
      {"t_rrd_l: ACT to ACT in the group",
       twenty(&N::t_rrd_l),
       {at(0, Kind::kActivate), at(20, Kind::kActivate, kBeside)}},
      {"t_rrd_s: ACT to ACT of another group",
       twenty(&N::t_rrd_s),
       {at(0, Kind::kActivate), at(20, Kind::kActivate, kGroup)}},
      {"t_faw",
       twenty(&N::t_faw),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kBeside), at(2, Kind::kActivate, kGroup),
        at(3, Kind::kActivate, kGroupBeside), at(4, Kind::kPrecharge), at(20, Kind::kActivate)}},
      {"t_ccd_l: RD to RD in the group",
       twenty(&N::t_ccd_l),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kBeside), at(5, Kind::kRead),
        at(25, Kind::kRead, kBeside)}},
      {"t_ccd_l: RD to RD in the group",
       twenty(&N::t_ccd_l),
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kRead)}},
      {"t_ccd_s: RD to RD of another group",
       twenty(&N::t_ccd_s),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup), at(5, Kind::kRead),
        at(25, Kind::kRead, kGroup)}},
      {"t_ccd_l: WR to WR in the group",
       twenty(&N::t_ccd_l),
       {at(0, Kind::kActivate), at(5, Kind::kWrite), at(25, Kind::kWrite)}},
      {"t_ccd_s: WR to WR of another group",
       twenty(&N::t_ccd_s),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup), at(5, Kind::kWrite),
        at(25, Kind::kWrite, kGroup)}},
      // Write data end 5 cycles after the command.
      {"t_wtr_l: WR to RD in the group",
       twenty(&N::t_wtr_l),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kBeside), at(5, Kind::kWrite),
        at(30, Kind::kRead, kBeside)}},
      {"t_wtr_s: WR to RD of another group",
       twenty(&N::t_wtr_s),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup), at(5, Kind::kWrite),
        at(30, Kind::kRead, kGroup)}},
  };
  return cases;
}

const std::vector<ExactCase>& bus_cases() {
  const auto late_reads = [](DramNumbers& n) {
    n.t_cas = 23;
  };  // their data 20 cycles after the command's own place among writes
  static const std::vector<ExactCase> cases{
      // Read data of cycle 9, 20 idle ones, write data of 30.
      {"t_rtw: RD to WR",
       twenty(&N::t_rtw),
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(26, Kind::kWrite)}},
      {"t_rtw: RD to WR",
       twenty(&N::t_rtw),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kRead),
        at(26, Kind::kWrite, kRank)}},
      {"t_rtrs: RD to RD of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kRead),
        at(26, Kind::kRead, kRank)}},
      {"t_rtrs: WR to WR of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kWrite),
        at(26, Kind::kWrite, kRank)}},
      {"t_rtrs: RD to WR of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kRead),
        at(26, Kind::kWrite, kRank)}},
      {"t_rtrs: WR to RD of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kWrite),
        at(26, Kind::kRead, kRank)}},
      // The columns may follow each cycle, their data not.
      {"data bus", twenty(&N::t_burst), {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kRead)}},
      {"data bus", twenty(&N::t_burst), {at(0, Kind::kActivate), at(5, Kind::kWrite), at(25, Kind::kWrite)}},
      {"t_rtw: RD to WR", late_reads, {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kWrite)}},
      {"command bus", twenty(&N::act_slots), {at(0, Kind::kActivate), at(20, Kind::kActivate, kGroup)}},
      {"command bus",
       twenty(&N::column_slots),
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kPrecharge)}},
      {"command bus",
       [](DramNumbers& n) { n.t_rrd_s = 0; },
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup)}},
      {"command bus",
       [](DramNumbers& n) { n.shared_commands = true; },
       {at(0, Kind::kActivate), at(5, Kind::kActivate, kChannel), at(6, Kind::kPrecharge)}},
      {"command bus",
       [](DramNumbers& n) {
         n.shared_commands = n.separate_buses = true;
         n.column_slots = 20;
       },
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kChannel), at(5, Kind::kRead),
        at(25, Kind::kRead, kChannel)}},
      {"order",
       [](DramNumbers& n) { n.separate_buses = true; },
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(5, Kind::kActivate, kRank)}},
  };
  return cases;
}

const std::vector<ExactCase>& refresh_cases() {
  static const std::vector<ExactCase> cases{
      {"t_rc: ACT to REF",
       twenty(&N::t_rc),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(20, Kind::kRefresh)}},
      {"t_rp: PRE to REF",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate, kGroup), at(5, Kind::kPrecharge, kGroup), at(25, Kind::kRefresh)}},
      {"t_rp: PRE to REF",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate, kGroup), at(5, Kind::kReadPrecharge, kGroup), at(26, Kind::kRefresh)}},
      {"t_rfc: REF to ACT", twenty(&N::t_rfc), {at(0, Kind::kRefresh), at(20, Kind::kActivate, kGroup)}},
      {"t_rfc: REF to REF", twenty(&N::t_rfc), {at(0, Kind::kRefresh), at(20, Kind::kRefresh)}},
      {"t_rfc: REF to REFpb", twenty(&N::t_rfc), {at(0, Kind::kRefresh), at(20, Kind::kRefreshBank, kGroup)}},
      {"t_rc: ACT to REFpb",
       twenty(&N::t_rc),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(20, Kind::kRefreshBank)}},
      {"t_rp: PRE to REFpb",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(25, Kind::kRefreshBank)}},
      {"t_rfc_pb: REFpb to ACT", twenty(&N::t_rfc_pb), {at(0, Kind::kRefreshBank), at(20, Kind::kActivate)}},
      {"t_rfc_pb: REFpb to REFpb",
       twenty(&N::t_rfc_pb),
       {at(0, Kind::kRefreshBank), at(20, Kind::kRefreshBank)}},
      {"t_rfc_pb: REFpb to REF",
       twenty(&N::t_rfc_pb),
       {at(0, Kind::kRefreshBank, kGroup), at(20, Kind::kRefresh)}},
      {"t_rrefd: REFpb to ACT of another bank",
       twenty(&N::t_rrefd),
       {at(0, Kind::kRefreshBank), at(20, Kind::kActivate, kBeside)}},
      {"REFpb to REFpb of another bank",
       twenty(&N::t_refb_refb),
       {at(0, Kind::kRefreshBank), at(20, Kind::kRefreshBank, kGroup)}},
      {"t_rrd_l: ACT to REFpb in the group",
       twenty(&N::t_rrd_l),
       {at(0, Kind::kActivate), at(20, Kind::kRefreshBank, kBeside)}},
      {"t_rrd_s: ACT to REFpb of another group",
       twenty(&N::t_rrd_s),
       {at(0, Kind::kActivate), at(20, Kind::kRefreshBank, kGroup)}},
  };
  return cases;
}

/// A trace that breaks `rule` and no other, and one beside it that is legal.
struct StateCase {
  std::string rule;
  Trace illegal, legal;
};

const std::vector<StateCase>& state_cases() {
  static const std::vector<StateCase> cases{
      {"ACT to an open bank",
       {at(0, Kind::kActivate), at(9, Kind::kActivate, kHere, 1)},
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(9, Kind::kActivate, kHere, 1)}},
      {"column of a closed bank", {at(0, Kind::kRead)}, {at(0, Kind::kActivate), at(9, Kind::kRead)}},
      {"column of a closed bank",
       {at(0, Kind::kActivate), at(9, Kind::kWrite, kBeside)},
       {at(0, Kind::kActivate), at(9, Kind::kWrite)}},
      {"column of a closed bank",
       {at(0, Kind::kActivate), at(5, Kind::kReadPrecharge), at(9, Kind::kRead)},
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(9, Kind::kReadPrecharge)}},
      {"column of another row",
       {at(0, Kind::kActivate, kHere, 3), at(9, Kind::kRead, kHere, 2)},
       {at(0, Kind::kActivate, kHere, 3), at(9, Kind::kRead, kHere, 3)}},
      {"column beyond the page",
       {at(0, Kind::kActivate), at(9, Kind::kRead, kHere, 0, 8)},
       {at(0, Kind::kActivate), at(9, Kind::kRead, kHere, 0, 7)}},
      {"column beyond the page",
       {at(0, Kind::kActivate), at(9, Kind::kWrite, kHere, 0, -1)},
       {at(0, Kind::kActivate), at(9, Kind::kWrite)}},
      {"address", {at(0, Kind::kActivate, kHere, 16)}, {at(0, Kind::kActivate, kHere, 15)}},
      {"address", {at(0, Kind::kActivate, {.bank = 2})}, {at(0, Kind::kActivate, {.bank = 1})}},
      {"address", {at(0, Kind::kActivate, {.group = 2})}, {at(0, Kind::kActivate, {.group = 1})}},
      {"address", {at(0, Kind::kActivate, {.rank = 2})}, {at(0, Kind::kActivate, {.rank = 1})}},
      {"address", {at(0, Kind::kActivate, {.channel = 2})}, {at(0, Kind::kActivate, {.channel = 1})}},
      {"refresh of an open bank",
       {at(0, Kind::kActivate, kGroup), at(9, Kind::kRefresh)},
       {at(0, Kind::kActivate, kRank), at(9, Kind::kRefresh)}},
      {"refresh of an open bank",
       {at(0, Kind::kActivate), at(9, Kind::kRefreshBank)},
       {at(0, Kind::kActivate), at(9, Kind::kRefreshBank, kGroup)}},
  };
  return cases;
}

std::vector<ExactCase> exact_cases() {
  std::vector<ExactCase> all;
  for (const auto* cases : {&bank_cases(), &rank_cases(), &bus_cases(), &refresh_cases()})
    all.insert(all.end(), cases->begin(), cases->end());
  return all;
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
