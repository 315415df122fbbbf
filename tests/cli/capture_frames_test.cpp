/// Several frames of a capture: pictures, rows and the JSON, and what is refused.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

const std::string kTrail = QUADRILLE_SOURCE_DIR "/tests/traces/capture/own/trail.gfxr";

ProgramRun frames(const ScratchFolder& folder, std::vector<std::string> more) {
  more.insert(more.begin(), {"render", kTrail, "--frames"});
  return run_quadrille(folder, more);
}

}  // namespace

TEST_CASE("frames of a capture are drawn on top of each other, the same however many at a time") {
  const ScratchFolder folder;
  const auto draw = [&](const std::string& jobs, const std::string& name) {
    const ProgramRun run =
        frames(folder, {"3", "--jobs", jobs, "--out", name + "_#.png", "--stats", name + ".json"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(std::ranges::count(run.out, '\n') == 6);
    json all = json::parse(folder.read(name + ".json"));
    for (json& frame : all["frames"]) frame["figures"].erase("host");
    return all;
  };
  const json all = draw("1", "a");
  CHECK(all == draw("3", "b"));
  CHECK(all["schema"] == "quadrille-frames-1");
  CHECK(all["animation_s"].is_null());
  REQUIRE(all["frames"].size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const json& frame = all["frames"][i];
    CHECK(frame["time_s"].is_null());
    CHECK(frame["turn"].is_null());
    CHECK(frame["figures"]["frame"]["cycles"] > 0);
    const std::string ours = "a_" + std::to_string(i) + ".png";
    CHECK(folder.read(ours) == folder.read("b_" + std::to_string(i) + ".png"));
  }
  // The first is the frame that is drawn alone.
  REQUIRE(
      run_quadrille(folder, {"render", kTrail, "--out", "one.png", "--stats", "one.json", "-q"}).exit_code ==
      0);
  CHECK(folder.read("one.png") == folder.read("a_0.png"));
  CHECK(json::parse(folder.read("one.json"))["frame"] == all["frames"][0]["figures"]["frame"]);
}

TEST_CASE("frames of a capture: a page, and draws that are left out of the picture but not of what stays") {
  const ScratchFolder folder;
  const auto draw = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"2", "-q"});
    const ProgramRun run = frames(folder, more);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
  };
  draw({"--out", "all_#.png", "--report", "page.html"});
  CHECK(folder.has("page.html"));
  draw({"--out", "cut_#.png", "--draws", "0..0", "--pass", "1"});
  const auto same = [&](const std::string& a, const std::string& b) {
    return run_quadrille(folder, {"diff", a, b, "--max-lsb", "0"}).exit_code == 0;
  };
  CHECK_FALSE(same("all_0.png", "cut_0.png"));
  CHECK_FALSE(same("cut_0.png", "cut_1.png"));
}

TEST_CASE("frames of a capture that cannot be are refused before any is drawn") {
  const ScratchFolder folder;
  require_refused(frames(folder, {"4"}), {"--frames", "trail.gfxr", "3 frames", "1..3"});
  require_refused(frames(folder, {"2", "--fps", "3"}), {"--fps", "is a capture"});
  require_refused(frames(folder, {"2", "--orbit"}), {"--orbit", "is a capture"});
  require_refused(frames(folder, {"2", "--time", "1"}), {"--time"});
  require_refused(frames(folder, {"2", "--draws", "0..99"}), {"trail.gfxr", "draws 0..99"});
  require_refused(run_quadrille(folder, {"render", "no.gfxr", "--frames", "2"}), {"no.gfxr", "no such file"});
  CHECK(folder.empty());
}
