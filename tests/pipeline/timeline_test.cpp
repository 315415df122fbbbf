/// The timeline: its slices add up to the figures, draws keep to rows, and both formats of traces say the
/// same.
#include "pipeline/report/timeline.h"
#include "scenes/scene.h"
#include "tests/pipeline/machine_specimen.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <set>

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

/// Two units over 1000 cycles in slices of 400, the second one on a clock of half the rate; three draws.
Figures two_units() {
  Figures f;
  f.scene = "a \"scene\"";
  f.frame.cycles = 1000;
  f.slice_cycles = 400;
  UnitFigures fast, slow;
  fast.path = "core_0";
  fast.cycles = 1000;
  fast.resources.push_back({"issue", "", hw::Resource::Kind::kRate, 500, {100, 500, 500}});
  fast.resources.push_back({"warp_slots", "", hw::Resource::Kind::kPlaces, 300, {0, 200, 300}});
  slow.path = "memory_0";
  slow.cycles = 500;
  slow.resources.push_back({"bus", "", hw::Resource::Kind::kRate, 200, {100, 200, 200}});
  f.units = {fast, slow};
  Detail detail;
  detail.wanted.draws = true;
  const auto draw = [](const char* label, std::int64_t issued, std::int64_t retired) {
    DrawFigures d;
    d.label = label;
    d.vertex_shader = "place.vert";
    d.fragment_shader = "shade.frag";
    d.issued = issued;
    d.retired = retired;
    d.counts[0] = 7;
    return d;
  };
  detail.draws = {draw("first", 0, 500), draw("", 100, 900), draw("third", 500, 1000)};
  f.detail = detail;
  return f;
}

/// The same, and a client and two links of four places each. At 1 GHz a cycle has a million ticks; the last
/// write-back ends 100 cycles behind the frame.
Figures with_flow() {
  Figures f = two_units();
  f.frame.clock_mhz = 1000;
  f.moving_cycles = 1100;
  f.bandwidth = {{"texture", 1000, 150}};
  LinkFigures link;
  link.key = "link.coarse_to_fine";
  link.depth = 4;
  link.tokens = 30;
  link.held_ticks = 2'000'000'000;
  f.links = {link, link};
  constexpr hw::Tick kCycle = 1'000'000;
  f.flow = FlowFigures{400 * kCycle,
                       1100 * kCycle,
                       3,
                       {{"texture", {400, 600, 0}, {0, 0, 150}}},
                       {{"texture", {32, 0, 0}, {0, 0, 0}}, {"write_back", {0, 0, 0}, {0, 0, 600}}},
                       {{"link.coarse_to_fine", {800'000'000, 3'200'000'000, 0}}}};
  return f;
}

}  // namespace

TEST_CASE("timeline: bytes are a cycle's, tokens one link's, and the last slice lasts until all is still") {
  const Timeline line = timeline_of(with_flow());
  REQUIRE(line.flow.size() == 3);
  CHECK(line.flow[0].curves[0].name == "texture read");
  CHECK(line.flow[0].curves[0].value[0] == Approx(1));
  CHECK(line.flow[0].curves[0].value[1] == Approx(1.5));
  CHECK(line.flow[0].curves[0].value[2] == 0);
  CHECK(line.flow[0].curves[1].value[2] == Approx(0.5));
  REQUIRE(line.flow[1].curves.size() == 2);  // what is 0 throughout is left out
  CHECK(line.flow[1].curves[1].name == "write_back written");
  CHECK(line.flow[1].curves[1].value[2] == Approx(2));
  CHECK(line.flow[2].curves[0].name == "coarse_to_fine");
  CHECK(line.flow[2].curves[0].value[0] == Approx(1));
  CHECK(line.flow[2].curves[0].value[1] == Approx(4));
}

TEST_CASE("timeline: the figures have bytes of slices as counts, and tokens of a class of links") {
  Figures figures = with_flow();
  figures.report_timeline = true;
  const MachineConfig machine;
  const auto document = nlohmann::json::parse(report_json({figures, machine, 8, 8}));
  const auto& timeline = document["timeline"];
  CHECK(timeline["bandwidth"]["texture"]["read_bytes"] == std::vector<int>{400, 600, 0});
  CHECK(timeline["bandwidth"]["texture"]["write_bytes"] == std::vector<int>{0, 0, 150});
  CHECK(timeline["memory"]["write_back"] == std::vector<int>{0, 0, 600});
  CHECK(timeline["links"]["coarse_to_fine"] == std::vector<double>{1, 4, 0});
  CHECK(document["frame"]["moving_cycles"] == 1100);
  const auto& link = document["links"]["coarse_to_fine"];
  CHECK(link["links"] == 2);
  CHECK(link["depth"] == 4);
  CHECK(link["tokens"] == 60);
  CHECK(link["held_cycles"].get<double>() == Approx(4000));
}

TEST_CASE("timeline: a trace has what moved as counters in their own units") {
  const Figures figures = with_flow();
  const MachineConfig machine;
  const auto document = nlohmann::json::parse(timeline_trace_json({figures, machine, 8, 8}));
  std::vector<double> read, held;
  for (const auto& event : document["traceEvents"]) {
    if (event["name"] == "L2 cache texture read") read.push_back(event["args"]["B/cycle"]);
    if (event["name"] == "links coarse_to_fine") held.push_back(event["args"]["tokens"]);
  }
  REQUIRE(read.size() == 4);
  CHECK(read[1] == Approx(1.5));
  CHECK(read[3] == 0);  // the frame's end
  REQUIRE(held.size() == 4);
  CHECK(held[1] == Approx(4));
}

TEST_CASE("timeline: shares of each slice are of its own length, on the unit's clock") {
  const Figures figures = two_units();
  const Timeline line = timeline_of(figures);
  REQUIRE(line.slices == 3);
  CHECK(line.length_of(0) == 400);
  CHECK(line.length_of(2) == 200);
  REQUIRE(line.units.size() == 2);
  const auto& issue = line.units[0].resources[0].share;
  CHECK(issue == std::vector<double>{0.25, 1, 0});
  CHECK(line.units[0].resources[1].share == std::vector<double>{0, 0.5, 0.5});
  CHECK(line.units[1].resources[0].share == std::vector<double>{0.5, 0.5, 0});
}

TEST_CASE("timeline: a draw takes the first row that is free") {
  const Figures figures = two_units();
  const Timeline line = timeline_of(figures);
  REQUIRE(line.draw_rows.size() == 2);
  CHECK(line.draw_rows[0].size() == 2);
  CHECK(line.draw_rows[0][1].draw == 2);
  CHECK(line.draw_rows[1][0].draw == 1);
}

TEST_CASE("timeline: a frame without units has none") {
  CHECK(timeline_of(Figures{}).units.empty());
  CHECK(timeline_of(Figures{}).slices == 0);
}

TEST_CASE("timeline: the JSON has each counter at each slice's begin and 0 at the end, and each draw whole") {
  const Figures figures = two_units();
  const MachineConfig machine;
  const auto document = nlohmann::json::parse(timeline_trace_json({figures, machine, 8, 8}));
  std::vector<double> issue;
  std::set<std::string> draws;
  for (const auto& event : document["traceEvents"]) {
    if (event["ph"] == "C" && event["name"] == "core_0 issue: used") issue.push_back(event["args"]["%"]);
    if (event["ph"] != "X") continue;
    CHECK(event["args"]["vertex shader"] == "place.vert");
    CHECK(event["args"]["fragment shader"] == "shade.frag");
    draws.insert(event["name"].get<std::string>() + " " + std::to_string(event["dur"].get<double>()));
  }
  CHECK(issue == std::vector<double>{25, 100, 0, 0});
  CHECK(draws == std::set<std::string>{"draw 1 0.800000", "first 0.500000", "third 0.500000"});
}
