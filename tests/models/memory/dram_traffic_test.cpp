/// The DRAM model's commands under the checker: none breaks a rule, and when the model goes by a wrong number
/// the checker says so.
#include "tests/models/memory/dram_traffic.h"

#include <catch2/catch.hpp>
#include <functional>

using namespace quadrille::models;

namespace {

/// A million commands of a standard: every pattern with every policy. tests/models/memory/dram_check.cpp runs
/// as many more as one likes.
void check_million(const std::string& standard) {
  const DramNumbers model = dram_data_file(standard);
  const DramNumbers rules = dram_numbers(standard);
  const auto runs = static_cast<std::int64_t>(dram_policies().size() * dram_patterns().size());
  std::int64_t commands = 0;
  std::uint32_t seed = 1;
  for (const DramPolicy& policy : dram_policies())
    for (const DramPattern pattern : dram_patterns()) {
      INFO(standard << ", " << policy.name << ", " << dram_pattern_name(pattern));
      const DramRun run = run_dram_traffic({model, rules, pattern, policy, 1'000'000 / runs + 1, seed++});
      INFO((run.violations.empty() ? "" : run.violations.front().text()));
      CHECK(run.violation_count == 0);
      CHECK(run.answers == run.requests);
      commands += run.commands;
    }
  CHECK(commands >= 1'000'000);
}

/// What the checker says first of a model that goes by `model` where `rules` hold; empty when it finds
/// nothing in any traffic.
std::string found(const DramNumbers& model, const DramNumbers& rules) {
  for (const DramPolicy& policy : dram_policies())
    for (const DramPattern pattern : dram_patterns()) {
      const DramRun run = run_dram_traffic({model, rules, pattern, policy, 20'000, 7, true});
      if (!run.violations.empty()) return run.violations.front().rule;
    }
  return {};
}

/// A number that another one of the table implies cannot be missed: it is raised in model and rules alike, so
/// that it counts, before the model's is lowered.
bool is_implied(const std::string& name, const DramNumbers& n) {
  if (name == "t_rc") return n.t_rc <= n.t_ras + n.t_rp;
  if (name == "t_ccd_s") return n.t_ccd_s <= n.t_burst;
  if (name == "t_rrd_l") return n.t_rrd_l <= n.t_rrd_s;
  if (name == "t_faw") return n.t_faw <= 4 * n.t_rrd_s;
  return name == "act_slots" || name == "column_slots";  // one slot cannot become none
}

bool is_used(const std::string& name, const DramNumbers& n) {
  if (name == "act_slots" || name == "column_slots") return true;
  // geometry and the refresh interval are broken otherwise, below
  if (name.rfind("t_", 0) != 0 || name == "t_refi") return false;
  if (name == "t_rtrs") return n.ranks > 1;
  if (name == "t_rfc_pb" || name == "t_rrefd") return n.refresh == DramRefreshKind::kPerBank;
  return true;
}

/// The rule that a lowered number breaks first, or the beginning of its name; empty where several may be
/// first.
std::string rule_of(const std::string& name) {
  if (name == "t_burst" || name == "t_cas" || name == "t_cwl") return "";
  if (name == "act_slots" || name == "column_slots") return "command bus";
  return name;
}

void check_lowered(const std::string& standard, const DramNumberName& number) {
  DramNumbers model = dram_data_file(standard);
  DramNumbers rules = dram_numbers(standard);
  const std::string name = number.name;
  if (!is_used(name, rules)) return;
  if (name == "t_rfc") model.refresh = rules.refresh = DramRefreshKind::kAllBank;
  if (is_implied(name, rules)) {
    model.*number.member += 40;
    rules.*number.member += 40;
  }
  --(model.*number.member);
  INFO(standard << ": " << name << " one less than " << rules.*number.member);
  const std::string rule = found(model, rules);
  CHECK_FALSE(rule.empty());
  CHECK(rule.rfind(rule_of(name), 0) == 0);
}

struct Breach {
  const char* what;
  std::function<bool(DramNumbers&)> breaks;  ///< false where the standard has nothing of the kind
  const char* rule;
};

const std::vector<Breach>& breaches() {
  static const std::vector<Breach> all{
      {"no refresh", [](DramNumbers& n) { return n.refresh = DramRefreshKind::kNone, true; },
       "refresh too late"},
      {"refresh every other interval", [](DramNumbers& n) { return n.t_refi *= 2, true; },
       "refresh too late"},
      {"thirteen refreshes put off", [](DramNumbers& n) { return n.refresh_postpone += 5, true; },
       "refresh too late"},
      {"a bank beyond the last", [](DramNumbers& n) { return n.banks *= 2, true; }, "address"},
      {"other bank groups", [](DramNumbers& n) { return n.bank_groups /= 2, true; }, "address"},
      {"a row beyond the last", [](DramNumbers& n) { return n.rows *= 2, true; }, "address"},
      {"a longer page", [](DramNumbers& n) { return n.row_bytes *= 2, true; }, "column beyond the page"},
      {"another rank", [](DramNumbers& n) { return n.ranks *= 2, true; }, "address"},
      {"another pseudo-channel", [](DramNumbers& n) { return n.pseudo_channels *= 2, true; }, "address"},
      {"a bus for rows and one for columns",
       [](DramNumbers& n) { return !n.separate_buses && (n.separate_buses = true); }, "command bus"},
      {"a command bus each", [](DramNumbers& n) { return n.shared_commands && !(n.shared_commands = false); },
       "command bus"},
  };
  return all;
}

void check_breaches(const std::string& standard) {
  for (const Breach& breach : breaches()) {
    DramNumbers model = dram_data_file(standard);
    if (!breach.breaks(model)) continue;
    INFO(standard << ": " << breach.what);
    CHECK(found(model, dram_numbers(standard)) == breach.rule);
  }
}

}  // namespace

TEST_CASE("dram traffic: a million commands of DDR4 break no rule", "[slow]") { check_million("ddr4"); }
TEST_CASE("dram traffic: a million commands of LPDDR5 break no rule", "[slow]") { check_million("lpddr5"); }
TEST_CASE("dram traffic: a million commands of GDDR6 break no rule", "[slow]") { check_million("gddr6"); }
TEST_CASE("dram traffic: a million commands of HBM2 break no rule", "[slow]") { check_million("hbm2"); }

TEST_CASE("dram traffic: a model with any of its times one cycle short is caught", "[slow]") {
  for (const std::string& standard : dram_standards())
    for (const DramNumberName& number : dram_number_names()) check_lowered(standard, number);
}

TEST_CASE("dram traffic: a model of another shape, or that does not refresh, is caught", "[slow]") {
  for (const std::string& standard : dram_standards()) check_breaches(standard);
}

TEST_CASE(
    "dram traffic: a refresh is not late where all requests wait for it and it for a row that is kept open") {
  const DramNumbers numbers = dram_numbers("ddr4");
  const DramPolicy policy{"in order, closed pages", &kInOrderScheduler, &kClosedPages,
                          &kWatermarkWriteDrain,    &kGroupMapping,     true};
  for (const DramPattern pattern : {DramPattern::kRandom, DramPattern::kWriteHeavy, DramPattern::kOneBank}) {
    INFO(dram_pattern_name(pattern));
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const DramRun run = run_dram_traffic({numbers, numbers, pattern, policy, 20'000, seed});
      CHECK(run.violation_count == 0);
      CHECK(run.answers == run.requests);
    }
  }
}
