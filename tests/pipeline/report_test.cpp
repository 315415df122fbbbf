#include "pipeline/report/report.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/report/unit_facets.h"

using namespace quadrille;
using namespace quadrille::pipeline;
using Catch::Contains;

namespace {

UnitFigures memory_unit(const std::string& path, std::int64_t busy, std::int64_t starved) {
  UnitFigures u;
  u.path = path;
  u.cycles = 1000;
  u.busy = busy;
  u.starved = starved;
  u.idle = 1000 - busy - starved;
  u.waits = {{"request_in", true, starved}};
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"reads", 30}, {"writes", 10}, {"read_bytes", 960}, {"write_bytes", 320}})
    u.counters.push_back({name, "access", "for a test", value});
  u.row = {hw::count("accesses", 40),
           hw::share("row hit", 20, 40),
           hw::mean("in queue", 5, 1000),
           {"bursts", hw::Facet::Kind::kRate, 100, 0, 2}};
  return u;
}

Figures two_channels() {
  Figures f;
  f.scene = "hand-made";
  f.frame.cycles = 1000;
  f.frame.fragments_shaded = 75;
  f.frame.helper_lanes = 25;
  f.units = {memory_unit("memory_0", 200, 700), memory_unit("memory_1", 300, 500)};
  f.bandwidth = {{"texture", 1920, 640}};
  f.checks = {{"bytes in = bytes out", "left.bytes", "right.bytes", 7, 7}};
  return f;
}

}  // namespace

TEST_CASE("report: a broken law is listed with both sides, in table and JSON") {
  Figures f = two_channels();
  CHECK(failed_checks(f).empty());
  f.checks.push_back({"draws = draws", "a.draws", "b.draws", 3, 4});
  const MachineConfig machine;
  CHECK_THAT(failed_checks(f), Contains("draws = draws") && Contains("a.draws is 3") &&
                                   Contains("b.draws is 4") && !Contains("left.bytes"));
  CHECK_THAT(report_table({f, machine, 10, 10}), Contains("1 of 2 laws hold") && Contains("a.draws is 3"));
  const auto checks = nlohmann::json::parse(report_json({f, machine, 10, 10})).at("checks");
  CHECK(checks.at(0).at("holds") == true);
  CHECK(checks.at(1).at("holds") == false);
  CHECK(checks.at(1).at("left").at("value") == 3);
  CHECK(checks.at(1).at("right").at("name") == "b.draws");
}

TEST_CASE("report: units of a kind share a row of means with the spread of busy") {
  const Figures f = two_channels();
  const auto folded = group_units(f.units, true);
  REQUIRE(folded.size() == 1);
  CHECK(folded[0].kind == "memory");
  CHECK(folded[0].counter("reads") == 60);
  CHECK(folded[0].busy_spread() == Approx(5.0));
  CHECK(group_units(f.units, false).size() == 2);
  const MachineConfig machine;
  const std::string table = report_table({f, machine, 10, 10});
  CHECK_THAT(table, Contains("memory x2" + std::string(13, ' ') + "0.0   25.0 +-5.0"));
  CHECK_THAT(table, Contains("request_in       60.0"));  // of 2000 cycles of both
  CHECK_THAT(table, Contains("accesses 80") && Contains("row hit 50.0 %") && Contains("in queue 0.01") &&
                        Contains("bursts 0.10/clk (5 % of 2)"));
  CHECK_THAT(report_table({f, machine, 10, 10}, UnitRows::kAll),
             Contains("memory_1" + std::string(14, ' ') + "0.0   30.0") && !Contains("x2"));
}

TEST_CASE("report: bytes of memory are those of its channels, in JSON too") {
  Figures f = two_channels();
  CHECK(memory_bytes(f) == 2560);
  f.units[1].path = "rop_0";
  CHECK(memory_bytes(f) == 1280);
  const MachineConfig machine;
  CHECK(nlohmann::json::parse(report_json({f, machine, 10, 10})).at("frame").at("memory_bytes") == 1280);
}

TEST_CASE("report: bandwidth is a rate in GPU cycles and a share of what all channels can move") {
  MachineConfig machine;
  // two channels of 32 bytes a cycle, one clock
  CHECK(peak_memory_bytes_per_cycle(machine) == 64.0);
  // 2560 bytes in 1000 cycles
  CHECK_THAT(report_table({two_channels(), machine, 10, 10}), Contains("2.560        4.0"));
  machine.set("gpu.memory_mhz", "500", "test");
  machine.set("memory.t_burst", "4", "test");
  machine.set("gpu.channels", "4", "test");
  CHECK(peak_memory_bytes_per_cycle(machine) == 32.0);
}

TEST_CASE("report: numbers of units are told from names, and thousands are grouped") {
  CHECK(without_number("core_12") == "core");
  CHECK(without_number("l2_0") == "l2");
  CHECK(without_number("scan_out") == "scan_out");
  CHECK(without_number("core_") == "core_");
  CHECK(without_number("l2") == "l2");
  CHECK(grouped(0) == "0");
  CHECK(grouped(999) == "999");
  CHECK(grouped(1000) == "1,000");
  CHECK(grouped(1234567) == "1,234,567");
}

TEST_CASE("report: what only time can give is null when nothing was timed") {
  Figures f = two_channels();
  f.fidelity = "functional";
  f.units.clear();
  const MachineConfig machine;
  const auto document = nlohmann::json::parse(report_json({f, machine, 10, 10}));
  CHECK(document.at("frame").at("cycles").is_null());
  CHECK(document.at("frame").at("memory_bytes").is_null());
  CHECK(document.at("host").at("cycles_per_s").is_null());
  CHECK(document.at("frame").at("executed_lanes") == 100);
  CHECK_THAT(report_table({f, machine, 10, 10}), Contains("not simulated") && !Contains("UNITS"));
}
