/// A frame from the command line to picture, table and JSON.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenes/image/image_io.h"
#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

/// Renders a small frame of `scene` with these arguments too, and requires success and silence on standard
/// error.
ProgramRun render(const ScratchFolder& folder, const std::string& scene, std::vector<std::string> more) {
  std::vector<std::string> arguments{"render", scene};
  if (!scene.ends_with(".qtrace")) arguments.insert(arguments.end(), {"--size", "96x64"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  ProgramRun run = run_quadrille(folder, arguments);
  CAPTURE(arguments, run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(run.err.empty());
  return run;
}

void require_equal_pictures(const ScratchFolder& folder, const std::string& a, const std::string& b) {
  const ProgramRun run = run_quadrille(folder, {"diff", a, b, "--max-lsb", "0"});
  CAPTURE(a, b, run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Catch::StartsWith("equal: 6144 pixels"));
}

json stats(const ScratchFolder& folder, const std::string& scene, std::vector<std::string> more) {
  more.insert(more.end(), {"--quiet", "--stats", "stats.json"});
  CHECK(render(folder, scene, more).out.empty());
  return json::parse(folder.read("stats.json"));
}

}  // namespace

TEST_CASE("a picture in which nothing was drawn says why, in table, JSON and rows of frames") {
  const ScratchFolder folder;
  folder.write("empty.gltf", R"({"asset":{"version":"2.0"}})");
  folder.write("gone.frag",
               "#version 450\nlayout(location=0) out vec4 c;\nvoid main() { c = vec4(1); if (gl_FragCoord.x "
               "> -1.0) discard; }\n");
  const auto says = [&](const std::string& scene, std::vector<std::string> more, const std::string& words) {
    for (const std::string fidelity : {"exact", "functional"}) {
      std::vector<std::string> arguments{"--fidelity", fidelity, "--stats", "s.json"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      CHECK_THAT(render(folder, scene, arguments).out,
                 Catch::Contains("\nNOTE  nothing was drawn: " + words));
      CHECK_THAT(json::parse(folder.read("s.json")).at("notes").at(0).get<std::string>(),
                 Catch::Contains(words));
    }
  };
  says("empty.gltf", {}, "the frame has no draws");
  says("builtin:cubes", {"--eye", "0,100,0", "--at", "0,200,0"},
       "no triangle covers a pixel: 1,500 off screen");
  says("builtin:triangle", {"--frag", "gone.frag"}, "no fragment passed: ");
  CHECK_THAT(render(folder, "empty.gltf", {"--frames", "1"}).out, Catch::Contains("note: nothing was drawn"));
  CHECK_THAT(render(folder, "builtin:triangle", {}).out, !Catch::Contains("NOTE"));
}

TEST_CASE("exact and functional runs give one picture, whatever the driver and what is left out") {
  for (const std::string scene : {"builtin:triangle", "builtin:quad", "builtin:flag"}) {
    const ScratchFolder folder;
    render(folder, scene, {"--out", "exact.png", "-q"});
    render(folder, scene, {"--fidelity", "functional", "--out", "functional.png", "-q"});
    render(folder, scene,
           {"--driver", "native", "--leave-out", "none", "--machine", "small", "--out", "other.png", "-q"});
    require_equal_pictures(folder, "exact.png", "functional.png");
    require_equal_pictures(folder, "exact.png", "other.png");
  }
}

TEST_CASE("depths of a frame in which nothing tests them are those it was cleared to") {
  const ScratchFolder folder;
  folder.write("empty.gltf", R"({"asset":{"version":"2.0"}})");
  for (const std::string fidelity : {"exact", "functional"}) {
    render(folder, "empty.gltf", {"--depth", "d.exr", "--quiet", "--fidelity", fidelity});
    render(folder, "empty.gltf", {"--depth", "d.png", "--quiet", "--fidelity", fidelity});
    const auto depths = quadrille::scenes::load_float_image((folder.path() / "d.exr").string());
    REQUIRE(depths.pixels.size() == std::size_t{96} * 64);
    CHECK(std::ranges::all_of(depths.pixels, [](float d) { return d == 1; }));
  }
}

TEST_CASE("a picture is opaque unless its alpha is asked for, and is the same as .exr") {
  const ScratchFolder folder;
  render(folder, "builtin:triangle", {"--out", "x.png", "-q"});
  render(folder, "builtin:triangle", {"--out", "x.exr", "--depth", "z.exr", "-q"});
  const auto picture = quadrille::scenes::load_image((folder.path() / "x.png").string());
  CHECK((picture.width == 96 && picture.height == 64));
  for (std::size_t i = 3; i < picture.pixels.size(); i += 4) REQUIRE(picture.pixels[i] == 255);
  require_equal_pictures(folder, "x.png", "x.exr");
  const auto depth = quadrille::scenes::load_float_image((folder.path() / "z.exr").string());
  REQUIRE(depth.channels == 1);
  CHECK(depth.pixels[0] == 1.0F);            // the background was cleared to the far plane
  CHECK(depth.pixels[32 * 96 + 48] < 1.0F);  // the triangle covers the middle
}

TEST_CASE("the table names every unit, the clients and the checks, without colour") {
  const ScratchFolder folder;
  const std::string table = render(folder, "builtin:quad", {}).out;
  for (const char* word : {"command_processor", "coarse_raster", "core x4", "texture x4", "l2 x2",
                           "memory x2", "scan_out", "BANDWIDTH", "all clients", "laws hold", "HOST"}) {
    CHECK_THAT(table, Catch::Contains(word));
  }
  CHECK(table.find('\x1b') == std::string::npos);
  CHECK_THAT(table, !Catch::Contains("SystemC"));
  const std::string all = render(folder, "builtin:quad", {"--units", "all"}).out;
  CHECK_THAT(all, Catch::Contains("core_0") && Catch::Contains("core_3") && !Catch::Contains("core x4"));
  CHECK(folder.empty());
}

TEST_CASE("the JSON holds the frame, every unit's cycles, and laws with both sides") {
  const ScratchFolder folder;
  const json s = stats(folder, "builtin:quad", {});
  CHECK(s.at("schema") == "quadrille-figures-1");
  CHECK(s.at("scene") == "builtin:quad");
  CHECK(s.at("fidelity") == "exact");
  CHECK(s.at("machine").at("name") == "default");
  CHECK(s.at("machine").at("parameters").at("gpu.cores") == 4);
  CHECK(s.at("machine").at("parameters").at("coarse_raster.hiz") == true);
  const json& frame = s.at("frame");
  CHECK(frame.at("cycles") > 0);
  CHECK((frame.at("width") == 96 && frame.at("height") == 64));
  CHECK(frame.at("executed_lanes") ==
        frame.at("fragments_shaded").get<int>() + frame.at("helper_lanes").get<int>());
  REQUIRE(s.at("units").contains("core_0"));
  for (const auto& [path, u] : s.at("units").items()) {
    CAPTURE(path);
    CHECK(u.at("busy").get<long>() + u.at("waiting").get<long>() + u.at("starved").get<long>() +
              u.at("blocked").get<long>() + u.at("idle").get<long>() ==
          u.at("cycles").get<long>());
    CHECK(u.at("waits").is_object());
    CHECK(u.at("counters").is_object());
  }
  CHECK(s.at("counter_definitions").at("core").at("fragments").at("unit") == "fragment");
  for (const char* client : {"vertex_fetch", "texture", "depth", "color", "scan_out"}) {
    CHECK(s.at("bandwidth").at(client).at("read_bytes").is_number_unsigned());
    CHECK(s.at("bandwidth").at(client).at("write_bytes").is_number_unsigned());
  }
  REQUIRE(s.at("checks").size() > 20);
  for (const json& check : s.at("checks")) {
    CHECK(check.at("holds") == true);
    CHECK(check.at("left").at("value") == check.at("right").at("value"));
    CHECK_FALSE(check.at("left").at("name").get<std::string>().empty());
  }
  CHECK(s.at("left_out").is_array());
  const json& host = s.at("host");
  for (const char* key : {"load_s", "build_s", "simulate_s", "simulate_cpu_s", "wall_s", "fragments_per_s",
                          "cycles_per_s", "peak_rss_mib"})
    CHECK(host.at(key) > 0);
  CHECK(host.at("wall_s") >= host.at("load_s").get<double>() + host.at("build_s").get<double>() +
                                 host.at("simulate_s").get<double>());
}

TEST_CASE("both drivers and both ways of leaving out count the same cycles") {
  const ScratchFolder folder;
  const json a = stats(folder, "builtin:triangle", {}),
             b = stats(folder, "builtin:triangle", {"--driver", "native"}),
             c = stats(folder, "builtin:triangle", {"--leave-out", "none"});
  CHECK(a.at("frame") == b.at("frame"));
  CHECK(a.at("units") == b.at("units"));
  CHECK(a.at("frame") == c.at("frame"));
}

TEST_CASE("a run without time has no cycles, rather than zero") {
  const ScratchFolder folder;
  const json exact = stats(folder, "builtin:quad", {}),
             functional = stats(folder, "builtin:quad", {"--fidelity", "functional"});
  CHECK(functional.at("fidelity") == "functional");
  CHECK(functional.at("frame").at("cycles").is_null());
  CHECK(functional.at("host").at("cycles_per_s").is_null());
  CHECK(functional.at("units").empty());
  for (const char* count : {"draws", "triangles", "fragments_written"})
    CHECK(functional.at("frame").at(count) == exact.at("frame").at(count));
}

TEST_CASE("a setting is applied after the machine and is in the figures") {
  const ScratchFolder folder;
  const json s = stats(folder, "builtin:triangle",
                       {"--machine", "small", "--set", "gpu.cores=3", "--set", "link.core_to_rop.depth=1"});
  CHECK(s.at("machine").at("name") == "small");
  CHECK(s.at("machine").at("parameters").at("gpu.cores") == 3);
  CHECK(s.at("machine").at("parameters").at("gpu.partitions") == 1);
  CHECK(s.at("machine").at("parameters").at("link.core_to_rop.depth") == 1);
  CHECK(s.at("units").contains("core_2"));
  CHECK_FALSE(s.at("units").contains("core_3"));
}

TEST_CASE("a recorded trace replays to the picture and the cycles of its scene") {
  const ScratchFolder folder;
  REQUIRE(run_quadrille(folder, {"trace", "record", "builtin:quad", "--size", "96x64", "-o", "quad.qtrace"})
              .exit_code == 0);
  const ProgramRun info = run_quadrille(folder, {"trace", "info", "quad.qtrace"});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.out, Catch::Contains("96x64") && Catch::Contains("draws"));
  render(folder, "builtin:quad", {"--out", "scene.png", "--stats", "scene.json", "-q"});
  REQUIRE(run_quadrille(folder, {"trace", "replay", "quad.qtrace", "--out", "replay.png", "--stats",
                                 "replay.json", "-q"})
              .exit_code == 0);
  render(folder, "quad.qtrace", {"--out", "render.png", "-q"});
  require_equal_pictures(folder, "scene.png", "replay.png");
  require_equal_pictures(folder, "scene.png", "render.png");
  CHECK(json::parse(folder.read("scene.json")).at("units") ==
        json::parse(folder.read("replay.json")).at("units"));
}

TEST_CASE("diff tells pictures apart, by how much, and where") {
  const ScratchFolder folder;
  render(folder, "builtin:triangle", {"--out", "a.png", "-q"});
  render(folder, "builtin:quad", {"--out", "b.png", "-q"});
  CHECK(run_quadrille(folder, {"diff", "a.png", "b.png"}).exit_code == 0);
  const ProgramRun run =
      run_quadrille(folder, {"diff", "a.png", "b.png", "--max-lsb", "8", "--heat", "heat.png"});
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.out, Catch::Contains("largest difference") && Catch::Contains("8x8 blocks"));
  CHECK_THAT(run.err, Catch::Contains("--max-lsb allows 8"));
  CHECK(quadrille::scenes::load_image((folder.path() / "heat.png").string()).width == 96);
  CHECK(run_quadrille(folder, {"diff", "a.png", "b.png", "--max-lsb", "255"}).exit_code == 0);
}

TEST_CASE("the JSON of --stats - is alone on standard output, and the table on standard error") {
  const ScratchFolder folder;
  const std::vector<std::string> draw{"render", "builtin:triangle", "--size", "16x16", "--stats", "-"};
  const ProgramRun run = run_quadrille(folder, draw);
  CHECK(run.exit_code == 0);
  CHECK(json::parse(run.out).at("schema") == "quadrille-figures-1");
  CHECK_THAT(run.err, Catch::StartsWith("FRAME  builtin:triangle"));
  std::vector<std::string> quiet = draw;
  quiet.emplace_back("-q");
  CHECK(run_quadrille(folder, quiet).err.empty());
  const ProgramRun frames = run_quadrille(folder, {"render", "builtin:flag", "--size", "16x16", "--frames",
                                                   "2", "--fidelity", "functional", "--stats", "-"});
  CHECK(json::parse(frames.out).at("frames").size() == 2);
  CHECK_THAT(frames.err, Catch::StartsWith("FRAMES  builtin:flag"));
  const ProgramRun leave_out = run_quadrille(
      folder, {"leave-out", "builtin:triangle", "--size", "16x16", "--repeat", "1", "--json", "-"});
  CHECK(json::parse(leave_out.out).at("machine").at("name") == "default");
  CHECK_THAT(leave_out.err, Catch::StartsWith("LEAVE OUT"));
  const ProgramRun stability = run_quadrille(folder, {"stability", "empty-pass", "--json", "-"});
  CHECK(json::accept(stability.out));
  CHECK_FALSE(stability.err.empty());
  CHECK(folder.empty());
}

TEST_CASE("a frame's time is given with scan-out and where that overlaps the next frame") {
  const ScratchFolder folder;
  const ProgramRun run =
      run_quadrille(folder, {"render", "builtin:triangle", "--size", "64x64", "--stats", "s.json"});
  const json frame = json::parse(folder.read("s.json")).at("frame");
  const std::int64_t cycles = frame.at("cycles"), drawing = frame.at("render_cycles"),
                     scan_out = frame.at("scan_out_cycles");
  CHECK(drawing + scan_out == cycles);
  CHECK(drawing > 0);
  CHECK(scan_out > 0);
  CHECK(frame.at("period_cycles") == std::max(drawing, scan_out));
  CHECK_THAT(run.out, Catch::Contains("frames/s one after another") &&
                          Catch::Contains("frames/s where scan-out overlaps the next frame"));
}

TEST_CASE("details of draws and tiles add up to the frame, in JSON and table, and change neither") {
  const ScratchFolder folder;
  const json plain = stats(folder, "builtin:overdraw", {"--out", "a.png"});
  json detailed = stats(folder, "builtin:overdraw", {"--out", "b.png", "--detail", "draws,tiles"});
  require_equal_pictures(folder, "a.png", "b.png");
  CHECK(detailed.at("frame") == plain.at("frame"));
  CHECK(detailed.at("units") == plain.at("units"));
  CHECK_FALSE(plain.contains("draws"));
  CHECK_FALSE(plain.contains("tiles"));
  REQUIRE(detailed.at("draws").size() == 16);
  std::uint64_t shaded = detailed.at("outside_draws").at("fragments").at("shaded"), tiled = 0;
  for (const json& draw : detailed.at("draws"))
    shaded += draw.at("fragments").at("shaded").get<std::uint64_t>();
  const json& tiles = detailed.at("tiles");
  for (const json& n : tiles.at("fragments_shaded")) tiled += n.get<std::uint64_t>();
  CHECK(shaded == plain.at("frame").at("fragments_shaded"));
  CHECK(tiled == plain.at("frame").at("fragments_shaded"));
  CHECK(tiles.at("bytes").size() ==
        tiles.at("width").get<std::size_t>() * tiles.at("height").get<std::size_t>());
  const std::string table = render(folder, "builtin:overdraw", {"--detail", "draws"}).out;
  CHECK_THAT(table, Catch::Contains("\nDRAWS  the 10 of 16 that were in flight longest"));
  CHECK_THAT(render(folder, "builtin:overdraw", {}).out, !Catch::Contains("DRAWS"));
  CHECK_FALSE(stats(folder, "builtin:triangle", {"--detail", "draws"}).contains("tiles"));
}

TEST_CASE("a timeline is written in both formats, tells the same, and changes no figure") {
  const ScratchFolder folder;
  const json plain = stats(folder, "builtin:overdraw", {"--out", "a.png"});
  json timed = stats(folder, "builtin:overdraw",
                     {"--out", "b.png", "--detail", "timeline", "--timeline", "t.pftrace"});
  require_equal_pictures(folder, "a.png", "b.png");
  CHECK(timed.at("units") == plain.at("units"));
  CHECK_FALSE(plain.contains("timeline"));
  const json& line = timed.at("timeline");
  CHECK(line.at("units").size() == timed.at("units").size());
  CHECK(line.at("units").at("core_0").at("issue").size() == line.at("slices").get<std::size_t>());
  render(folder, "builtin:overdraw", {"--timeline", "t.json"});
  const json events = json::parse(folder.read("t.json")).at("traceEvents");
  const auto draws = std::ranges::count_if(events, [](const json& e) { return e.at("ph") == "X"; });
  CHECK(draws == 16);
  CHECK(folder.read("t.pftrace").size() > 10000);
}
