/// Several frames of a scene: moments, files, rows and the JSON.
#include <fmt/format.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

ProgramRun frames(const ScratchFolder& folder, const std::string& scene, std::vector<std::string> more) {
  more.insert(more.begin(), {"render", scene, "--size", "64x48"});
  return run_quadrille(folder, more);
}

/// A triangle that moves by its own width in two seconds.
const char* const kMovingTriangle =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,)"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAA="
    R"("}],"bufferViews":[{"buffer":0,"byteLength":68}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":0,"byteOffset":36,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},
{"bufferView":0,"byteOffset":44,"componentType":5126,"count":2,"type":"VEC3"}],
"animations":[{"samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})";

void require_equal(const ScratchFolder& folder, const std::string& a, const std::string& b,
                   bool equal = true) {
  CAPTURE(a, b);
  CHECK((run_quadrille(folder, {"diff", a, b, "--max-lsb", "0"}).exit_code == 0) == equal);
}

}  // namespace

TEST_CASE("frames of an animation are those that --time draws, one file and one row each") {
  const ScratchFolder folder;
  const ProgramRun run =
      frames(folder, "builtin:flag", {"--frames", "4", "--out", "f_##.png", "--stats", "f.json"});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(run.err.empty());
  CHECK(std::ranges::count(run.out, '\n') == 7);
  const json all = json::parse(folder.read("f.json"));
  CHECK(all["schema"] == "quadrille-frames-1");
  CHECK(all["animation_s"] == 2.0);
  REQUIRE(all["frames"].size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const json& frame = all["frames"][i];
    CHECK(frame["frame"] == i);
    CHECK(frame["time_s"] == 0.5 * static_cast<double>(i));
    CHECK(frame["turn"].is_null());
    CHECK(frame["figures"]["schema"] == "quadrille-figures-1");
    CHECK(frame["figures"]["frame"]["cycles"] > 0);
    const json& limit = frame["figures"]["limit"];
    CHECK_THAT(run.out, Catch::Contains(fmt::format("  {} {:.1f}\n", limit["name"].get<std::string>(),
                                                    100 * limit["share"].get<double>())));
  }
  // Exact frames here, a functional picture of one moment there.
  CHECK(
      frames(folder, "builtin:flag", {"--time", "1.5", "--fidelity", "functional", "--out", "one.png", "-q"})
          .exit_code == 0);
  require_equal(folder, "f_03.png", "one.png");
  require_equal(folder, "f_02.png", "one.png", false);
}

TEST_CASE("frames a second step through the animation from --time on") {
  const ScratchFolder folder;
  const ProgramRun run = frames(
      folder, "builtin:flag",
      {"--frames", "2", "--fps", "4", "--time", "0.5", "--fidelity", "functional", "--out", "f#.png", "-q"});
  REQUIRE(run.exit_code == 0);
  CHECK(run.out.empty());
  CHECK(
      frames(folder, "builtin:flag", {"--time", "0.75", "--fidelity", "functional", "--out", "one.png", "-q"})
          .exit_code == 0);
  require_equal(folder, "f1.png", "one.png");
}

TEST_CASE("frames after the end of a file's animation show its last pose, which a note says") {
  const ScratchFolder folder;
  folder.write("move.gltf", kMovingTriangle);
  const auto run = [&](const std::string& scene, const std::string& count, std::vector<std::string> more) {
    more.insert(more.end(),
                {"--frames", count, "--fps", "1", "--fidelity", "functional", "--stats", "s.json"});
    const ProgramRun done = frames(folder, scene, more);
    CAPTURE(done.err);
    REQUIRE(done.exit_code == 0);
    return done.out;
  };
  CHECK_THAT(run("move.gltf", "3", {}), !Catch::Contains("note"));  // the third is at the end
  CHECK(json::parse(folder.read("s.json"))["notes"].empty());
  CHECK_THAT(
      run("move.gltf", "4", {"--out", "f#.png"}),
      Catch::Contains(
          "note: the last 1 of 4 frames are after the animation's end at 2 s and show its last pose\n"));
  CHECK(json::parse(folder.read("s.json"))["notes"].size() == 1);
  require_equal(folder, "f2.png", "f3.png");
  require_equal(folder, "f1.png", "f2.png", false);
  CHECK_THAT(run("move.gltf", "3", {"--time", "1.5"}), Catch::Contains("note: the last 2 of 3 frames"));
  CHECK_THAT(run("builtin:flag", "4", {}), !Catch::Contains("note"));  // which repeats
}

TEST_CASE("frames of a scene without an animation, or with --orbit, go around it") {
  const ScratchFolder folder;
  REQUIRE(frames(folder, "builtin:cubes",
                 {"--frames", "4", "--fidelity", "functional", "--out", "c#.png", "--stats", "c.json"})
              .exit_code == 0);
  const json all = json::parse(folder.read("c.json"));
  CHECK(all["animation_s"].is_null());
  CHECK(all["frames"][3]["time_s"].is_null());
  CHECK(all["frames"][3]["turn"] == 0.75);
  CHECK(all["frames"][3]["figures"]["frame"]["draws"] == 125);
  require_equal(folder, "c0.png", "c2.png", false);
  REQUIRE(frames(folder, "builtin:flag",
                 {"--frames", "2", "--orbit", "--fidelity", "functional", "--out", "o#.png", "-q"})
              .exit_code == 0);
  REQUIRE(
      frames(folder, "builtin:flag", {"--fidelity", "functional", "--out", "still.png", "-q"}).exit_code ==
      0);
  require_equal(folder, "o0.png", "still.png");
  require_equal(folder, "o1.png", "still.png", false);
}

TEST_CASE("frames drawn at the same time are those drawn in turn, and their rows come in order") {
  const ScratchFolder folder;
  const auto draw = [&](const std::string& jobs, const std::string& name) {
    const ProgramRun run =
        frames(folder, "builtin:flag",
               {"--frames", "7", "--jobs", jobs, "--out", name + "#.png", "--stats", name + ".json"});
    REQUIRE(run.exit_code == 0);
    json all = json::parse(folder.read(name + ".json"));
    for (json& frame : all["frames"]) frame["figures"].erase("host");
    return std::pair{run.out, all};
  };
  const auto turns = draw("1", "a"), together = draw("3", "b");
  CHECK(turns.first == together.first);
  CHECK(turns.second == together.second);
  for (const char* number : {"0", "3", "6"})
    CHECK(folder.read(std::string("a") + number + ".png") == folder.read(std::string("b") + number + ".png"));
  require_refused(frames(folder, "builtin:flag", {"--frames", "2", "--jobs", "0"}), {"--jobs", "1..64"});
  require_refused(frames(folder, "builtin:flag", {"--jobs", "2"}), {"--jobs", "--frames"});
}

TEST_CASE("frames: the scan-out of each overlaps the drawing of the next, as far as two targets allow") {
  const ScratchFolder folder;
  const ProgramRun run = frames(folder, "builtin:flag", {"--frames", "5", "--stats", "s.json"});
  REQUIRE(run.exit_code == 0);
  const json all = json::parse(folder.read("s.json"));
  std::vector<std::int64_t> drawn, shown;
  std::int64_t one_after_another = 0, all_drawing = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const json& frame = all["frames"][i]["figures"]["frame"];
    const std::int64_t drawing = frame["render_cycles"], scan_out = frame["scan_out_cycles"];
    const std::int64_t from = std::max(i > 0 ? drawn[i - 1] : 0, i > 1 ? shown[i - 2] : 0);
    drawn.push_back(from + drawing);
    shown.push_back(std::max(drawn[i], i > 0 ? shown[i - 1] : 0) + scan_out);
    one_after_another += drawing + scan_out;
    all_drawing += drawing;
    CHECK(all["frames"][i]["overlapped"] ==
          json{{"drawn_from", from}, {"drawn_at", drawn[i]}, {"shown_at", shown[i]}});
  }
  CHECK(all["cycles"]["one_after_another"] == one_after_another);
  CHECK(all["cycles"]["overlapped"] == shown.back());
  CHECK(shown.back() < one_after_another);
  CHECK(shown.back() > all_drawing);
  CHECK_THAT(run.out,
             Catch::Contains("one after another") && Catch::Contains("overlaps the drawing of the next"));
}

TEST_CASE("a frame that fails names its number, and those before it stay") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "f_1.png");  // the second frame cannot be written
  const ProgramRun run =
      frames(folder, "builtin:flag",
             {"--frames", "3", "--fidelity", "functional", "--out", "f_#.png", "--stats", "s.json", "-q"});
  require_refused(run, {"frame 1", "f_1.png"});
  CHECK(folder.has("f_0.png"));
  CHECK_FALSE(folder.has("f_2.png"));
  CHECK_FALSE(folder.has("s.json"));
}

TEST_CASE("frames that cannot be are refused before any is drawn") {
  const ScratchFolder folder;
  require_refused(frames(folder, "builtin:flag", {"--frames", "0"}), {"--frames", "1..100000"});
  require_refused(frames(folder, "builtin:flag", {"--frames", "2", "--out", "f.png"}),
                  {"--out", "frame_####.png"});
  require_refused(frames(folder, "builtin:flag", {"--frames", "2", "--out", "f#_#.png"}),
                  {"--out", "frame_####.png"});
  require_refused(frames(folder, "builtin:flag", {"--frames", "2", "--fps", "0"}), {"--fps"});
  require_refused(frames(folder, "builtin:flag", {"--fps", "3"}), {"--fps", "--frames"});
  require_refused(frames(folder, "builtin:flag", {"--orbit"}), {"--orbit", "--frames"});
  require_refused(frames(folder, "builtin:cubes", {"--frames", "2", "--fps", "3"}),
                  {"--fps", "no animation"});
  require_refused(frames(folder, "builtin:flag", {"--time", "-1"}), {"--time"});
  require_refused(frames(folder, "builtin:flag", {"--time", "nan"}), {"--time"});
  require_refused(frames(folder, "builtin:flag", {"--animation", "walk"}),
                  {"animation 'walk' does not exist", "0"});
  require_refused(frames(folder, "builtin:flag", {"--scene", "1"}), {"one scene"});
  CHECK(folder.empty());
}

TEST_CASE("a trace of a posed moment replays to its picture") {
  const ScratchFolder folder;
  REQUIRE(run_quadrille(folder, {"trace", "record", "builtin:flag", "--size", "64x48", "--time", "0.7", "-o",
                                 "f.qtrace"})
              .exit_code == 0);
  REQUIRE(run_quadrille(folder,
                        {"trace", "replay", "f.qtrace", "--fidelity", "functional", "--out", "a.png", "-q"})
              .exit_code == 0);
  REQUIRE(
      frames(folder, "builtin:flag", {"--time", "0.7", "--fidelity", "functional", "--out", "b.png", "-q"})
          .exit_code == 0);
  require_equal(folder, "a.png", "b.png");
  require_refused(run_quadrille(folder, {"render", "f.qtrace", "--frames", "2"}), {"--frames", "f.qtrace"});
  require_refused(run_quadrille(folder, {"render", "f.qtrace", "--time", "1"}), {"--time"});
}

TEST_CASE("the scenes, cameras and animations of a file are listed with their numbers") {
  const ScratchFolder folder;
  const ProgramRun run = run_quadrille(folder, {"scenes", "builtin:flag"});
  CHECK(run.exit_code == 0);
  for (const char* words : {"scenes 1, cameras 1, animations 1", "'below', perspective", "2 s"})
    CHECK_THAT(run.out, Catch::Contains(words));
  require_refused(run_quadrille(folder, {"scenes", "missing.gltf"}), {"missing.gltf"});
}

TEST_CASE("scenes: names of a file, and its warnings, are printed in one line whatever they hold") {
  const ScratchFolder folder;
  const std::string name = "a\nb.gltf", evil = R"("name":"x\n\u001b[2J")";
  folder.write(name, R"({"asset":{"version":"2.0"},"extensionsUsed":["X_y"],"scenes":[{)" + evil +
                         R"(}],"cameras":[{)" + evil +
                         R"(,"type":"perspective","perspective":{"yfov":1,"znear":1}}],"animations":[{)" +
                         evil + R"(,"channels":[],"samplers":[]}]})");
  const ProgramRun run = run_quadrille(folder, {"scenes", name});
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK(std::ranges::count(run.out, '\n') == 4);
  CHECK(std::ranges::count(run.err, '\n') == 1);
  CHECK((run.out + run.err).find('\x1b') == std::string::npos);
  CHECK(run.out.find("a?b.gltf: scenes 1, cameras 1, animations 1") == 0);
}
