#include "studies/stability/stability.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <set>
#include <sstream>

#include "models/base/error.h"
#include "studies/stability/measures.h"
#include "studies/stability/report.h"
#include "studies/stability/stream_builder.h"

namespace quadrille::studies::stability {
namespace {

using Catch::Matchers::Contains;

constexpr std::uint32_t kSide = 32;

traces::CommandStream small_stream() {
  StreamBuilder stream("small", kSide, kSide, true);
  stream.area({0, 0, kSide, kSide}, {4, 4, 24, 24}).state({.depth = {true, true, traces::CompareOp::kLess}});
  return stream.draw(quad({-0.5F, -0.5F}, {0.9F, 0.9F}, 0.5F, {1, 0.5F, 0.25F, 1})).finish();
}

/// Runs in a child, since the machine elaborates once a process; says which findings of `check_always` do not
/// hold after `spoil` changed what was observed.
std::set<std::string> broken_after(const std::function<void(Observed&)>& spoil) {
  const ChildRun run = run_in_child([&] {
    Observed o = observe(small_stream(), std::make_unique<pipeline::MachineConfig>());
    spoil(o);
    Findings findings;
    check_always(o, findings);
    std::string text;
    for (const Finding& f : findings.all()) text += f.holds ? "" : f.what + "\n";
    return text;
  });
  REQUIRE(run.end == ChildEnd::kDone);
  std::set<std::string> broken;
  std::istringstream lines(run.output);
  for (std::string line; std::getline(lines, line);) broken.insert(line);
  return broken;
}

Case case_of(std::function<void(const Observed&, Findings&)> check) {
  return {.name = "test",
          .group = "numbers",
          .purpose = "p",
          .must = "m",
          .build = small_stream,
          .check = std::move(check)};
}

CaseResult run_one(const Case& one) {
  const Case* const only = &one;
  return run_cases({&only, 1}, 1, [](const CaseResult&) {}).front();
}

TEST_CASE("stability: a sound frame holds to what every case must hold to") {
  CHECK(broken_after([](Observed&) {}).empty());
}

TEST_CASE("stability: each check that every case gets can fail") {
  CHECK(broken_after([](Observed& o) { o.exact.image.color[500] ^= 1; }) ==
        std::set<std::string>{"pixels unlike the functional image"});
  CHECK(broken_after([](Observed& o) { o.exact.image.depth[500] = -0.0F; }) ==
        std::set<std::string>{"depths unlike the functional ones"});
  CHECK(broken_after([](Observed& o) { ++o.exact.figures.checks[3].left; }) ==
        std::set<std::string>{"laws that hold"});
  CHECK(broken_after([](Observed& o) { ++o.exact.figures.units[2].idle; }) ==
        std::set<std::string>{"units whose cycles do not add up"});
  CHECK(broken_after([](Observed& o) {
          auto& unit = o.exact.figures.units[2];
          unit.starved += unit.idle + 1;
          unit.idle = -1;
        }) == std::set<std::string>{"units whose cycles do not add up"});
  CHECK(broken_after([](Observed& o) {
          o.exact.image.color[kSide + 1] = 7;
          o.functional.image.color[kSide + 1] = 7;
        }) == std::set<std::string>{"pixels touched outside the scissor"});
  CHECK(broken_after([](Observed& o) { o.exact.figures.links[0].use = 1.5; }) ==
        std::set<std::string>{"greatest use of a unit or link"});
}

TEST_CASE("stability: a case's own check, a refusal and a crash each fail the case") {
  const Case right = case_of([](const Observed&, Findings& f) { f.equal("sum", 4, 4); });
  const Case wrong = case_of([](const Observed&, Findings& f) { f.at_most("error", 3, 2, "px"); });
  const Case refusing = case_of([](const Observed&, Findings&) { throw user_error("no such thing"); });
  CHECK(run_one(right).holds());
  const CaseResult failed = run_one(wrong);
  CHECK_FALSE(failed.holds());
  CHECK_THAT(case_text(failed, false),
             Contains("error") && Contains("3 px") && Contains("<= 2 px") && Contains("does not hold"));
  const CaseResult refused = run_one(refusing);
  CHECK_FALSE(refused.holds());
  CHECK_THAT(case_text(refused, false), Contains("refused") && Contains("no such thing"));
  const std::vector<CaseResult> both{failed, refused};
  CHECK_THAT(verdict_text(both), Contains("0 of 2 cases hold"));
  CHECK_THAT(results_json(both), Contains("\"end\": \"refused\""));
  CHECK_THAT(results_markdown(both, "there/"), Contains("does not hold") && Contains("](there/test.png)"));
}

TEST_CASE("stability: a case that takes more memory than it may does not hold") {
  Case one = case_of([](const Observed&, Findings&) {});
  one.memory_mib = 1;
  CHECK_FALSE(run_one(one).holds());
}

TEST_CASE("stability: a bound that is not a number holds nothing") {
  Findings f;
  f.at_most("a", std::nan(""), 1);
  f.at_least("b", std::nan(""), 1);
  CHECK_FALSE(f.all()[0].holds);
  CHECK_FALSE(f.all()[1].holds);
}

TEST_CASE("stability: coverage is counted within the scissor") {
  Observed o;
  StreamBuilder stream("count", 8, 8);
  o.stream = stream.area({0, 0, 8, 8}, {2, 2, 4, 4})
                 .state({.paint = Paint::kCount})
                 .draw(quad({-1, -1}, {1, 1}, 0, glm::vec4(1)))
                 .finish();
  o.exact.image = {8, 8, std::vector<std::uint32_t>(64, 1), {}, {}};
  CHECK(not_once(o) == 0);
  o.exact.image.color[3 * 8 + 3] = 2;
  o.exact.image.color[5 * 8 + 5] = 0;
  o.exact.image.color[0] = 9;  // outside
  CHECK(coverage_counts(o) == std::map<std::uint32_t, std::uint64_t>{{0, 1}, {1, 14}, {2, 1}});
}

TEST_CASE("stability: patterns select cases, and one that selects none is refused by name") {
  const std::vector<std::string> all{"*"}, some{"world-*", "fan"}, none{"fan", "no-such-*"};
  CHECK(select({}).size() == catalogue().size());
  CHECK(select(all).size() == catalogue().size());
  CHECK(select(some).size() == 5);
  CHECK_THROWS_WITH(select(none), Contains("no-such-*"));
}

TEST_CASE("stability: every case of the catalogue is a test, and no name is used twice") {
  std::ifstream file(QUADRILLE_SOURCE_DIR "/tests/studies/stability_cases.txt");
  std::vector<std::string> listed, wanted;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') listed.push_back(line);
  }
  for (const Case& c : catalogue()) wanted.push_back(c.name + (c.slow ? " slow" : ""));
  CHECK(listed == wanted);
  CHECK(std::set<std::string>(wanted.begin(), wanted.end()).size() == wanted.size());
}

}  // namespace
}  // namespace quadrille::studies::stability
