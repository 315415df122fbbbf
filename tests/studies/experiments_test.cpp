/// Experiments: readings are summed over the units of a kind, and a verdict is the band's.
#include "studies/experiments/experiment.h"
#include "studies/experiments/unit_benchmarks.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <stdexcept>

using namespace quadrille::studies::experiments;

TEST_CASE("experiments: readings are those of the frame and the sums of a kind") {
  const Readings r(R"({"frame": {"cycles": 70, "memory_bytes": null},
                       "units": {"memory_0": {"cycles": 70, "busy": 5, "counters": {"reads": 3}},
                                 "memory_1": {"cycles": 70, "busy": 6, "counters": {"reads": 4}},
                                 "scan_out": {"cycles": 70, "busy": 1, "counters": {"lines": 9}}}})");
  CHECK(r["frame.cycles"] == 70);
  CHECK(r["memory.reads"] == 7);
  CHECK(r["memory.busy"] == 11);
  CHECK(r["memory.cycles"] == 140);
  CHECK(r["scan_out.lines"] == 9);
  CHECK_THROWS_AS(r["frame.memory_bytes"], std::out_of_range);
}

TEST_CASE("experiments: a figure outside its band fails, and the text and the page say so") {
  Result result;
  result.table = {{"scene", "gain"}, {{"fill", "1.5"}}};
  result.verdicts = {{"gain of fill", 1.5, 1.17, 1.93}};
  CHECK(result.holds());
  result.verdicts.push_back({"gain of overdraw", 1.94, 1.17, 1.93});
  CHECK_FALSE(result.holds());
  const Experiment& experiment = experiments().front();
  CHECK_THAT(result_text(experiment, result),
             Catch::Contains("holds  gain of fill: 1.5") && Catch::Contains("FAILS  gain of overdraw: 1.94"));
  CHECK_THAT(result_markdown(experiment, result, "x.png"),
             Catch::Contains("FAILS  gain of overdraw") && Catch::Contains("(x.png)"));
}

namespace {

/// The verdicts of which the name has `part` in it; at least one.
std::vector<Verdict> verdicts_of(const Result& result, const std::string& part) {
  std::vector<Verdict> found;
  for (const Verdict& v : result.verdicts) {
    if (v.what.find(part) != std::string::npos) found.push_back(v);
  }
  REQUIRE_FALSE(found.empty());
  return found;
}

Setting sized(std::uint32_t width, std::uint32_t height) {
  Setting setting;
  setting.width = width;
  setting.height = height;
  setting.jobs = 2;
  return setting;
}

void check_holds(const std::vector<Verdict>& verdicts) {
  for (const Verdict& v : verdicts) {
    INFO(v.what << " " << v.value);
    CHECK(v.holds());
  }
}

}  // namespace

TEST_CASE("experiments: the set-up rate is the closed form") {
  check_holds(setup_rate(sized(128, 128)).verdicts);
}

TEST_CASE("units: each kind of the machine plan has a frame that it limits and one that it does not") {
  const std::vector<LimitedFrame> limited = limited_frames(32, 32);
  const std::vector<SlackFrame> slack = slack_frames(32, 32);
  quadrille::pipeline::visit_unit_kinds([&]<class Unit>() {
    const std::string_view name = quadrille::pipeline::UnitKind<Unit>::name;
    INFO(name);
    CHECK(std::ranges::find(limited, name, &LimitedFrame::unit) != limited.end());
    CHECK(std::ranges::find(slack, name, &SlackFrame::unit) != slack.end());
  });
}

TEST_CASE("units: a frame that a unit limits takes the cycles of arithmetic, others do not feel its rate") {
  const Result result = units(sized(128, 128));
  CHECK(result.table.rows.size() >= 16);
  check_holds(result.verdicts);
}

TEST_CASE("units: a unit of another rate than the arithmetic's fails, so each frame measures its unit") {
  // The work distributor, and updates of one word in an L2 slice, have no rate to set.
  const std::map<std::string_view, std::vector<std::string>> other_rates{
      {"command_processor", {"command_processor.draw_clk=8"}},
      {"vertex_fetch", {"vertex_fetch.indices_per_clk=2"}},
      {"primitive_assembly", {"primitive_assembly.triangles_per_clk=2", "link.assembly_to_clipper.width=2"}},
      {"clipper", {"clipper.clip_clk=10"}},
      {"triangle_setup", {"triangle_setup.drawn_per_clk=0.3"}},
      {"coarse_raster", {"coarse_raster.tests_per_clk=2", "coarse_raster.rows_per_clk=2"}},
      {"fine_raster", {"fine_raster.quads_per_clk=8"}},
      {"depth", {"depth.quads_per_clk=2"}},
      {"warp_packer", {"warp_packer.quads_per_clk=2"}},
      {"core", {"core.simd_lanes=16", "core.alu_clk=7", "core.export_bytes_per_clk=16"}},
      {"texture", {"texture.filter_quads_per_clk=2", "texture.decode_blocks_per_clk=2"}},
      {"load_store", {"load_store.lines_per_clk=2"}},
      {"rop", {"rop.quads_per_clk=2"}},
      {"l2", {"gpu.channels=3"}},
      {"memory", {"gpu.memory_mhz=1100"}},
      {"scan_out", {"scan_out.lines_in_flight=32"}},
  };
  std::vector<LimitedFrame> limited = limited_frames(128, 128);
  std::erase_if(limited, [](const LimitedFrame& f) {
    return f.unit == "work_distributor" || f.what == "every fragment adds to one word";
  });
  for (LimitedFrame& f : limited)
    f.settings.insert(f.settings.end(), other_rates.at(f.unit).begin(), other_rates.at(f.unit).end());
  const Result result = judged(limited, {}, sized(128, 128));
  REQUIRE(result.verdicts.size() == limited.size());
  for (const Verdict& v : result.verdicts) {
    INFO(v.what << " " << v.value);
    CHECK_FALSE(v.holds());
  }
  CHECK(result.table.rows[0].back() == "FAILS");
}

TEST_CASE("units: a parameter that moves a frame fails as one that should not") {
  std::vector<LimitedFrame> limited = limited_frames(64, 64);
  const auto rop = std::ranges::find(limited, "rop", &LimitedFrame::unit);
  const SlackFrame slack{"rop", "limited by it", rop->stream, {}, "rop.quads_per_clk", 2};
  const Result result = judged({}, {slack}, sized(64, 64));
  REQUIRE(result.verdicts.size() == 1);
  CHECK_FALSE(result.holds());
  CHECK(result.further_tables[0].rows[0].back() == "FAILS");
}

TEST_CASE("experiments: of layers from front to back one is shaded, from back to front all") {
  check_holds(verdicts_of(hidden_surfaces(sized(100, 60)), "shaded a pixel"));
}

TEST_CASE("experiments: hidden surfaces take the closed form's cycles", "[slow]") {
  check_holds(hidden_surfaces(sized(960, 540)).verdicts);
}

TEST_CASE("experiments: lanes of quads are those counted from the triangles", "[slow]") {
  check_holds(verdicts_of(quad_overhead(sized(320, 180)), "over those counted"));
}

TEST_CASE("experiments: a frame of small triangles takes the closed form's cycles", "[slow]") {
  const Result result = small_triangles(sized(480, 270));
  check_holds(verdicts_of(result, "over closed form"));
  check_holds(verdicts_of(result, "GeForce GTX 680"));
}

TEST_CASE("experiments: both traversals take the cycles that arithmetic predicts", "[slow]") {
  const Result result = traversal(sized(256, 256));
  CHECK(result.verdicts.size() == 2 * result.table.rows.size());
  check_holds(result.verdicts);
}

TEST_CASE("experiments: colours are written at the published ratios of formats", "[slow]") {
  const Result result = color_writes(sized(256, 256));
  CHECK(result.verdicts.size() == 11);
  check_holds(result.verdicts);
}

TEST_CASE("experiments: encoded layers move the bytes that arithmetic predicts", "[slow]") {
  const Result result = compression(sized(256, 128));
  CHECK(result.verdicts.size() == 2 * result.table.rows.size());
  check_holds(result.verdicts);
}

TEST_CASE("experiments: the end of the pipeline moves the bytes that arithmetic predicts", "[slow]") {
  const Result result = raster(sized(512, 256));
  CHECK(result.verdicts.size() == result.table.rows.size());
  check_holds(result.verdicts);
}

TEST_CASE("experiments: depths are off by no more than rounding allows, and fight no earlier") {
  const Result result = depth_precision(sized(256, 128));
  CHECK(result.table.rows.size() == 36);
  check_holds(result.verdicts);
}

TEST_CASE("experiments: ten thousand blended layers drift no further than rounding allows") {
  const Result result = blend_drift(sized(16, 16));
  CHECK(result.verdicts.size() == 4);
  check_holds(result.verdicts);
}

TEST_CASE("experiments: order-independent transparency reaches the exact picture", "[slow]") {
  const Result result = transparency(sized(160, 100));
  CHECK(result.verdicts.size() == 20);
  check_holds(result.verdicts);
}
