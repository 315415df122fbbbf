/// The contract of units and FIFOs over the machine plan: whatever the plan lists is held to it, so a new
/// unit or link is covered the day it is declared.
#include "pipeline/machine/machine_config.h"
#include "pipeline/machine/planned_links.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"

#include <catch2/catch.hpp>

#include <fmt/ranges.h>

#include <set>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

/// The functional rendering's.
std::uint64_t expected() {
  static const std::uint64_t digest = functional_digest(plan_frame());
  return digest;
}

/// Classes of links, once each.
std::set<std::string_view> link_classes() {
  std::set<std::string_view> names;
  for (const PlannedLink& link : planned_links()) names.insert(link.name);
  return names;
}

Settings link_settings(std::string_view name, const char* depth, const char* width, const char* latency) {
  const std::string key = fmt::format("link.{}.", name);
  return {{key + "depth", depth}, {key + "width", width}, {key + "latency", latency}};
}

void check_kept(const PlanRun& run) {
  REQUIRE(run.failure == "");
  CHECK(run.digest == expected());
  CHECK(fmt::format("{}", fmt::join(run.broken, "\n")) == "");
}

}  // namespace

TEST_CASE("plan: every unit keeps the contract of a unit, and every one acts in the frame that tells") {
  const PlanRun run = run_plan({}, true);
  check_kept(run);
  for (const PlannedUnit& unit : planned_units()) {
    INFO(unit.kind);
    CHECK(run.acted.at(std::string(unit.kind)) > 0);
  }
  const PlanRun usual = run_plan({});
  check_kept(usual);
  CHECK(run.cycles == usual.cycles);
  CHECK(run.actions == usual.actions);
  CHECK(run.tokens == usual.tokens);
}

TEST_CASE("plan: every unit keeps its contract with all links one token deep and one wide") {
  Settings settings;
  for (const std::string_view name : link_classes())
    for (const auto& setting : link_settings(name, "1", "1", "3")) settings.push_back(setting);
  check_kept(run_plan(settings, true));
}

TEST_CASE(
    "plan: each link alone one token deep, one wide and 40 cycles long: the same pixels, and all laws") {
  const PlanRun usual = run_plan({});
  for (const std::string_view name : link_classes()) {
    INFO("link." << name);
    CHECK(usual.tokens.at(fmt::format("link.{}", name)) > 0);
    const PlanRun run = run_plan(link_settings(name, "1", "1", "40"));
    check_kept(run);
  }
}

TEST_CASE(
    "plan: the links of each kind of unit from one token deep to 64, and up to a thousand cycles long") {
  for (const PlannedUnit& unit : planned_units()) {
    for (const char* depth : {"1", "64"}) {
      for (const char* latency : {"1", "1000"}) {
        Settings settings;
        for (const PlannedLink& link : planned_links()) {
          if (link.from != unit.kind && link.to != unit.kind) continue;
          for (const auto& setting : link_settings(link.name, depth, "1", latency))
            settings.push_back(setting);
        }
        INFO(unit.kind << ": depth " << depth << ", latency " << latency);
        REQUIRE_FALSE(settings.empty());
        check_kept(run_plan(settings));
      }
    }
  }
}
