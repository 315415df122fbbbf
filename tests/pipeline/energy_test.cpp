/// Energy and area are counts times costs: held to arithmetic by hand, to their sums, and to their ranges.
#include "pipeline/report/energy.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "pipeline/watched_render.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"

using namespace quadrille;
using namespace quadrille::pipeline;
using Catch::Contains;

namespace {

constexpr const char* kSmall = R"(
[constants.operation]
low = 1
typical = 2
high = 4
unit = "pJ"
source = "made up"
[constants.dram_gddr6]
low = 5
typical = 7
high = 9
unit = "pJ"
source = "made up"
[constants.bit]
low = 0.5
typical = 0.5
high = 1
unit = "um2"
source = "made up"
[[sram]]
kib = 8
low = 8
typical = 10
high = 12
source = "made up"
[[sram]]
kib = 32
low = 20
typical = 20
high = 20
source = "made up"
[[event]]
unit = "core"
counter = "lane_operations"
times = 3
cost = "operation"
what = "lanes"
[[event]]
unit = "memory"
counter = "read_bytes"
times = 8
cost = "dram_{memory.kind}"
what = "bits"
[[event]]
unit = "texture"
counter = "texels"
cost = "sram"
bytes = ["texture.cache_lines", 128]
what = "texels"
[[area]]
unit = "texture"
count = ["texture.cache_lines", 128, 8]
cost = "bit"
what = "cache"
)";

void require(const Range& r, double low, double typical, double high) {
  CHECK(r.low == Approx(low));
  CHECK(r.typical == Approx(typical));
  CHECK(r.high == Approx(high));
}

bool in_order(const Range& r) { return 0 <= r.low && r.low <= r.typical && r.typical <= r.high; }

Figures counted(const std::vector<std::pair<std::string, CounterFigure>>& counters) {
  Figures f;
  for (const auto& [path, counter] : counters) {
    UnitFigures unit;
    unit.path = path;
    unit.counters.push_back(counter);
    f.units.push_back(std::move(unit));
  }
  return f;
}

Figures some_counts() {
  return counted({{"core_0", {"lane_operations", "lane", "", 100}},
                  {"core_1", {"lane_operations", "lane", "", 50}},
                  {"texture_0", {"texels", "texel", "", 1000}},
                  {"memory_0", {"read_bytes", "byte", "", 64}}});
}

/// The small file with one of its lines changed.
std::string changed(const std::string& line, const std::string& to) {
  std::string text = kSmall;
  const std::size_t at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.replace(at, line.size(), to);
}

std::string refusal(const std::string& text) {
  const MachineConfig machine;
  try {
    (void)read_costs(text, "f.toml", machine);
  } catch (const UserError& e) { return e.what(); }
  return "";
}

}  // namespace

TEST_CASE("energy: every figure is a count times a cost, and sums of units are the total") {
  MachineConfig machine;
  const EnergyFigures e = energy_of(some_counts(), machine, read_costs(kSmall, "f.toml", machine));
  REQUIRE(e.events.size() == 3);
  CHECK(e.events[0].count == 150);
  require(e.events[0].energy, 450, 900, 1800);          // 150 x 3 x (1, 2, 4)
  require(e.events[1].energy, 2560, 3584, 4608);        // 64 x 8 x (5, 7, 9)
  require(e.events[2].energy, 20'000, 20'000, 20'000);  // 1000 x 20: 256 lines of 128 bytes are 32 KiB
  REQUIRE(e.units.size() == 3);
  CHECK(e.units[0].first == "core");
  CHECK(e.units[1].first == "texture");
  CHECK(e.units[2].first == "memory");
  require(e.total, 450 + 2560 + 20'000, 900 + 3584 + 20'000, 1800 + 4608 + 20'000);
  REQUIRE(e.areas.size() == 1);
  CHECK(e.areas[0].units == machine.gpu.cores);  // the frame's figures need not have them
  require(e.total_area, 4 * 262'144 * 0.5, 4 * 262'144 * 0.5, 4 * 262'144.0);
  CHECK(e.draws.empty());
}

TEST_CASE("energy: an access costs more in a larger memory, on a line between the sizes of the file") {
  const auto access = [](int lines) {
    MachineConfig machine;
    machine.texture.cache_lines.set(lines);
    return read_costs(kSmall, "f.toml", machine).events[2].each;
  };
  require(access(64), 8, 10, 12);
  require(access(256), 20, 20, 20);
  require(access(128), std::sqrt(8 * 20), std::sqrt(10 * 20), std::sqrt(12 * 20));
  CHECK(access(1024).typical == Approx(40));  // four times the size, twice the cost, as from 8 to 32 KiB
  CHECK(access(16).typical == Approx(5));
  CHECK(access(1024).low == access(1024).typical);  // its line rises more steeply, and is held to the order
  CHECK(access(1024).high == access(1024).typical);
}

TEST_CASE("energy: the kind of memory chooses what a bit costs") {
  MachineConfig machine;
  machine.set("memory.kind", "hbm2", "test");
  CHECK_THAT(
      [&] {
        try {
          (void)read_costs(kSmall, "f.toml", machine);
        } catch (const UserError& e) { return std::string(e.what()); }
        return std::string();
      }(),
      Contains("f.toml:42: event[1].cost: no constant in pJ is called 'dram_hbm2'; there are") &&
          Contains("dram_gddr6"));
}

TEST_CASE("energy: the costs of 45 nm are in order, on every machine and memory") {
  for (const std::string& name : machine_names())
    for (const std::string kind : {"ddr4", "lpddr5", "gddr6", "hbm2"}) {
      MachineConfig machine;
      load_machine(machine, name);
      machine.begin_layer();
      machine.set("memory.kind", kind, "test");
      const CostFile costs = load_costs("45nm", machine);
      CAPTURE(name, kind);
      for (const CostConstant& c : costs.constants) {
        CAPTURE(c.name);
        CHECK(in_order(c.value));
        CHECK(c.value.low > 0);
        CHECK_THAT(c.source, Contains("[") && Contains("]"));
      }
      for (const auto* list : {&costs.events, &costs.areas})
        for (const Cost& cost : *list) CHECK(in_order(cost.each));
    }
}

TEST_CASE("energy: of draws and of none is of the frame, and follows from its counters") {
  scenes::SceneOptions options;
  options.width = 96;
  options.height = 64;
  const std::string problems = hw::contract::in_child([&] {
    std::string said;
    MachineConfig machine;
    const CostFile costs = load_costs("45nm", machine);
    const traces::CommandStream stream = scenes::load_scene("builtin:glass", options);
    KeptCounters kept{counters_of(costs), {}, {}};
    const RenderedFrame frame = render_exact_watched(stream, machine, {}, {}, {.draws = true}, kept);
    if (!frame.figures.checks_hold()) said += "a law is broken; ";
    const EnergyFigures e = energy_of(frame.figures, machine, costs, &kept.by_draw);
    const auto counter = [&](std::string_view kind, std::string_view name) {
      double sum = 0;
      for (const UnitFigures& unit : frame.figures.units)
        if (unit.path.starts_with(kind))
          for (const CounterFigure& c : unit.counters)
            if (c.name == name) sum += static_cast<double>(c.value);
      return sum;
    };
    const auto unit = [&](std::string_view kind) {
      for (const auto& sum : e.units)
        if (sum.first == kind) return sum.second;
      return Range{};
    };
    const auto near = [&](std::string_view what, double is, double should) {
      if (std::abs(is - should) > 1e-9 * should || !(should > 0))
        said += fmt::format("{}: {} is not {}; ", what, is, should);
    };
    near("core", unit("core").typical,
         64 * counter("core_", "instructions") + (2.3 + 6) * counter("core_", "lane_operations"));
    near("memory", unit("memory").high,
         14 * 8 * (counter("memory_", "read_bytes") + counter("memory_", "write_bytes")));
    near("fine_raster", unit("fine_raster").low,
         192 * 0.05 * counter("fine_raster", "tiles") + 2 * 4.5 * counter("fine_raster", "fragments"));
    if (e.draws.size() != frame.figures.frame.draws || e.draws.empty()) said += "draws are missing; ";
    Range sum = e.outside_draws;
    for (const Range& draw : e.draws) {
      sum += draw;
      if (!in_order(draw) || draw.low <= 0) said += "a draw without energy, or out of order; ";
    }
    near("low", sum.low, e.total.low);
    near("typical", sum.typical, e.total.typical);
    near("high", sum.high, e.total.high);
    return said;
  });
  CHECK(problems == "");
}

TEST_CASE("energy: the laws of kept counters break when a draw or a square loses what the units counted") {
  KeptCounters kept{{{{"core", "instructions"}}, {{7}, {2}}, {1}, 10},
                    {{"quads", {"warp_packer", "quads"}, {3, 4}, 5, 12}},
                    {}};
  const auto broken = [&] {
    return std::ranges::count_if(checks_of(kept), [](const Check& c) { return !c.holds(); });
  };
  CHECK(checks_of(kept).size() == 2);
  CHECK(broken() == 0);
  kept.by_draw.draws[1][0] = 1;
  CHECK(broken() == 1);
  kept.by_square[0].squares[0] = 2;
  CHECK(broken() == 2);
}

TEST_CASE("energy: a wrong file is refused with its line and what is legal") {
  CHECK(refusal(kSmall).empty());
  struct Wrong {
    std::string line, to, says;
  };
  for (
      const Wrong& w : std::initializer_list<Wrong>{
          {"typical = 2", "typical = 0.5",
           "f.toml:4: constants.operation.typical: low <= typical <= high is expected, not 1, 0.5, 4"},
          {"typical = 2", "typical = \"2\"", "f.toml:4: constants.operation.typical: a number of 0 to 1e+12"},
          {"typical = 2", "typical = nan", "f.toml:4: constants.operation.typical: a number"},
          {"low = 1", "low = -1", "f.toml:3: constants.operation.low: a number"},
          {"high = 4", "hihg = 4", "f.toml:5: unknown key 'hihg' in constants.operation; there are low"},
          {"high = 4\n", "\n", "constants.operation.high: a number"},
          {"unit = \"pJ\"", "unit = \"eV\"",
           "f.toml:6: constants.operation.unit: 'eV' is neither pJ nor um2"},
          {"source = \"made up\"\n", "\n", "constants.operation.source: a text in quotes"},
          {"[constants.operation]", "[constants.operation", "f.toml:2: "},
          {"kib = 32", "kib = 8", "sram[1].kib: sizes are expected from the smallest to the largest"},
          {"unit = \"core\"", "unit = \"cores\"", "event[0].unit: no unit is called 'cores'; there are"},
          {"counter = \"texels\"", "counter = \"texel\"",
           "event[2].counter: texture has no counter 'texel'; quadrille describe texture lists them; did you "
           "mean 'texels'?"},
          {"cost = \"operation\"", "cost = \"bit\"", "event[0].cost: no constant in pJ is called 'bit'"},
          {"cost = \"bit\"", "cost = \"operation\"",
           "area[0].cost: no constant in um2 is called 'operation'"},
          {"dram_{memory.kind}", "dram_{memory.kid}", "a parameter that is a word is expected"},
          {"dram_{memory.kind}", "dram_}{", "a parameter that is a word is expected"},
          {"bytes = [\"texture.cache_lines\", 128]", "bytes = [\"texture.cash_lines\", 128]",
           "event[2].bytes: no parameter is called 'texture.cash_lines'; did you mean "
           "'texture.cache_lines'?"},
          {"bytes = [\"texture.cache_lines\", 128]", "bytes = [\"memory.kind\"]", "memory.kind is no number"},
          {"bytes = [\"texture.cache_lines\", 128]", "bytes = 128", "a list of numbers and of parameters"},
          {"bytes = [\"texture.cache_lines\", 128]", "bytes = []", "a list of numbers and of parameters"},
          {"bytes = [\"texture.cache_lines\", 128]", "bytes = [0]", "an array of no bytes"},
          {"bytes = [\"texture.cache_lines\", 128]", "bytes = [1e12, 1e12]", "the product is 1e+24"},
          {"bytes = [\"texture.cache_lines\", 128]", "", "goes with cost = \"sram\""},
          {"times = 3", "times = 3\nbytes = [1]", "goes with cost = \"sram\""},
          {"[[area]]", "[area]", "area: tables are expected, each begun by [[area]]"},
          {"[[area]]", "[[aera]]",
           "unknown key 'aera' in the file; there are constants, sram, event, area"}}) {
    CAPTURE(w.line, w.to);
    CHECK_THAT(refusal(changed(w.line, w.to)), Contains(w.says) && Contains("f.toml:"));
  }
  CHECK_THAT(refusal("constants = 3\n"), Contains("f.toml:1: the file.constants: a table is expected"));
  CHECK_THAT(refusal("x = \"" + std::string(2000, 'x') + "\""),
             Contains("f.toml:1: the line has 2006 bytes"));
  CHECK(refusal("").empty());  // a file that charges nothing
}
