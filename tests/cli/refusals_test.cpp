/// What the program says to a wrong flag, file or value, and that nothing is left behind.
#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

namespace {

/// A render of the smallest scene, with these arguments too.
void render_refused(std::vector<std::string> more, const std::vector<std::string>& words) {
  std::vector<std::string> arguments{"render", "builtin:triangle", "--size", "16x16"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  refused(arguments, words);
}

}  // namespace

TEST_CASE("a wrong command line is refused in one line") {
  refused({}, {"--help"});
  refused({"draw"}, {"draw"});
  refused({"render"}, {"SCENE"});
  refused({"render", "builtin:triangle", "--no-such-flag"}, {"--no-such-flag"});
  refused({"render", "builtin:triangle", "--size"}, {"--size"});
  refused({"trace"}, {"--help"});
  refused({"trace", "record", "builtin:triangle"}, {"--out"});
  refused({"diff", "a.png"}, {"B"});
}

TEST_CASE("an environment is a file or a sky, and not for shaders that look at none") {
  render_refused({"--environment", "x.png"},
                 {"--environment: 'x.png' is neither a .hdr or .exr file nor sky"});
  render_refused({"--environment", "sky:91"}, {"--environment: 'sky:91'", "1..90"});
  render_refused({"--environment", "x.hdr"}, {"x.hdr"});
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--view", "depth"},
                                                {"--shading", "phong"},
                                                {"--vert", "x.glsl"},
                                                {"--frag", "x.glsl"}}) {
    std::vector<std::string> arguments{"--environment", "sky"};
    arguments.insert(arguments.end(), other.begin(), other.end());
    render_refused(arguments, {"--environment: not together with --vert, --frag, --view"});
  }
  refused({"render", "builtin:glow", "--environment", "sky"}, {"--environment is not for it"});
}

TEST_CASE("a faster unit has to exist, and to be faster") {
  render_refused({"--faster", "shader=2"}, {"--faster: no unit is called 'shader'", "command_processor, "});
  render_refused({"--faster", "core"}, {"--faster: how many times as fast? for example core=1.1"});
  render_refused({"--faster", "core=0.5"}, {"--faster", "1..100"});
  render_refused({"--faster", "core=fast"}, {"--faster", "fast"});
  render_refused({"--faster", "core=2", "--faster", "core=3"}, {"--faster: core is given twice"});
  render_refused({"--faster", "core=2", "--fidelity", "functional"},
                 {"--faster: a functional run has no units"});
  refused({"why", "builtin:triangle", "--units", "core,texure"}, {"--units: no unit is called 'texure'"});
  refused({"why", "builtin:triangle", "--size", "16x16", "--units", "texture"},
          {"--units: builtin:triangle needs no texture, so none can be faster"});
  refused({"why", "builtin:triangle", "--jobs", "0"}, {"--jobs"});
  refused({"why"}, {"SCENE"});
}

TEST_CASE("a name that is nearly one is refused with the one that may be meant") {
  refused({"rende", "builtin:triangle"},
          {"quadrille: unknown subcommand 'rende'; did you mean 'render'?; see quadrille --help"});
  refused({"builtin:triangle", "rende"},
          {"unknown subcommand 'builtin:triangle'; there are render, compare, diff, "});
  refused({"trace", "recrod", "builtin:triangle"},
          {"unknown subcommand 'recrod'; did you mean 'record'?; see quadrille trace --help"});
  render_refused({"--sizes", "3x3"},
                 {"unknown option '--sizes'; did you mean '--size'?; see quadrille render --help"});
  render_refused({"--stat=x.json"}, {"'--stat=x.json'; did you mean '--stats'"});
  // not that SCENE were missing
  refused({"render", "--siz", "3x3"}, {"unknown option '--siz'; did you mean '--size'?"});
  refused({"trace", "record", "builtin:triangle", "--ou", "x.qtrace"},
          {"'--ou'; did you mean '--out'?; see quadrille trace record --help"});
  render_refused({"second.gltf", "third.gltf"}, {"unexpected argument 'second.gltf'"});
  refused({"render", "builtin:tirangle"}, {"did you mean 'builtin:triangle'?"});
  refused({"render", "courtyard"}, {"did you mean 'builtin:courtyard'?"});
  refused({"render", "buildin:quad"}, {"did you mean 'builtin:quad'?"});
  refused({"scenes", "builtin:quads"}, {"did you mean 'builtin:quad'?"});
  render_refused({"--machine", "smal"}, {"did you mean 'small'?"});
  render_refused({"--set", "gpu.croes=3"}, {"did you mean 'gpu.cores'?"});
  render_refused({"--set", "cores=3"}, {"did you mean 'gpu.cores'?"});
  render_refused({"--set", "link.core_to_rops.depth=3"}, {"did you mean 'link.core_to_rop.depth'?"});
  refused({"describe", "texure"}, {"did you mean 'texture'?"});
  refused({"describe", "texture.cache_linse"}, {"did you mean 'texture.cache_lines'?"});
  refused({"describe", "cache_hit"}, {"did you mean "});
  refused({"stability", "empty-pas"},
          {"stability: no case matches 'empty-pas'", "did you mean 'empty-pass'?"});
  refused({"describe", "bicycle"}, {"bicycle", "groups: "});
  refused({"describe", ""}, {"WHAT is empty"});
  refused({"describe", "machine", "large", "--machine", "small"}, {"named twice"});
  refused({"describe", "--toml", "--only", "counters"}, {"--toml"});
}

TEST_CASE("a scene that is none is refused with what is legal") {
  refused({"render", "courtyard"}, {"courtyard", ".gltf", ".qtrace", "builtin:"});
  refused({"render", "scene.obj"}, {"scene.obj", ".gltf"});
  refused({"render", "missing.gltf"}, {"missing.gltf"});
  refused({"render", "missing.glb"}, {"missing.glb"});
  refused({"render", "missing.qtrace"}, {"missing.qtrace"});
  refused({"render", "builtin:nothing"}, {"nothing", "triangle"});
}

TEST_CASE("a damaged scene is refused with its name") {
  for (const std::string name : {"broken.gltf", "broken.glb", "broken.qtrace"}) {
    const ScratchFolder folder;
    folder.write(name, "not what its name says");
    require_refused(run_quadrille(folder, {"render", name, "--out", "x.png"}), {name});
    CHECK_FALSE(folder.has("x.png"));
  }
}

TEST_CASE("a size is two numbers within 1..16384") {
  for (const std::string size : {"", "x", "12", "0x4", "4x0", "16385x4", "4x16385", "-4x4", "4x4x4", "4 x4",
                                 "1e3x4", "99999999999999999999x1"}) {
    refused({"render", "builtin:triangle", "--size", size}, {"--size", "16384"});
  }
}

TEST_CASE("a view is numbers, and a camera that exists") {
  for (const std::string point :
       {"", "1", "1,2", "1,2,3,4", "a,b,c", "1,2,nan", "1,2,inf", "1,2,", ",,", "1;2;3"}) {
    render_refused({"--eye", point}, {"--eye", "X,Y,Z"});
    render_refused({"--at", point}, {"--at", "X,Y,Z"});
  }
  render_refused({"--camera", "99"}, {"camera '99'", "cameras: "});
  render_refused({"--camera", "-1"}, {"camera '-1'"});
  render_refused({"--camera", "one"}, {"camera 'one'"});
  for (const char* flag : {"--camera", "--scene", "--animation", "--vert", "--frag"})
    render_refused({flag, ""}, {flag});
  refused({"experiment", "--jobs", "0", "--list"}, {"--jobs"});
  render_refused({"--camera", "0", "--eye", "1,2,3"}, {"--camera", "--eye"});
  render_refused({"--eye", "1,2,3", "--at", "1,2,3"}, {"eye"});
}

TEST_CASE("a shader that is missing or wrong is refused with its name") {
  render_refused({"--frag", "missing.frag"}, {"missing.frag"});
  const ScratchFolder folder;
  folder.write("wrong.frag", "#version 450\nvoid main() { nonsense; }\n");
  require_refused(run_quadrille(folder, {"render", "builtin:triangle", "--frag", "wrong.frag"}),
                  {"wrong.frag", "nonsense"});
}

TEST_CASE("a machine or setting that is none is refused with what is legal") {
  render_refused({"--machine", "gigantic"}, {"gigantic", "default"});
  render_refused({"--machine", "missing.toml"}, {"missing.toml"});
  render_refused({"--set", "gpu.cores"}, {"--set", "KEY=VALUE"});
  render_refused({"--set", "gpu.cores=0"}, {"gpu.cores", "64"});
  render_refused({"--set", "gpu.cores=many"}, {"gpu.cores"});
  render_refused({"--set", "gpu.colour=1"}, {"gpu.colour", "cores"});
  render_refused({"--set", "=1"}, {"--set"});
  render_refused({"--set", "nothing.cores=1"}, {"nothing.cores", "coarse_raster"});
  render_refused({"--set", "rop.cache_lines=1", "--set", "rop.cache_ways=8"}, {"rop.cache_lines"});
  render_refused({"--set", "coarse_raster.traversal=edges"}, {"edge_functions", "edge_walking"});
  render_refused({"--set", "coarse_raster.traversal=edge_walking", "--set", "coarse_raster.order=morton"},
                 {"coarse_raster.order", "scan"});
  const ScratchFolder folder;
  folder.write("m.toml", "[gpu]\ncores = 2\nclock = 3\n");
  require_refused(run_quadrille(folder, {"render", "builtin:triangle", "--machine", "m.toml"}),
                  {"m.toml:3", "clock"});
}

TEST_CASE("a choice is one of its words") {
  render_refused({"--fidelity", "perfect"}, {"--fidelity", "exact", "functional"});
  render_refused({"--leave-out", "all"}, {"--leave-out", "auto"});
  render_refused({"--driver", "diesel"}, {"--driver", "native"});
  render_refused({"--units", "some"}, {"--units", "folded"});
  for (const std::string cycles : {"0", "-5", "many", "1.5"})
    render_refused({"--max-cycles", cycles}, {"--max-cycles"});
}

TEST_CASE("an option that would change nothing is refused") {
  const std::vector<std::vector<std::string>> of_machines{{"--window", "0"},
                                                          {"--max-cycles", "10"},
                                                          {"--driver", "native"},
                                                          {"--driver", "dispatcher"},
                                                          {"--units", "all"}};
  for (std::vector<std::string> option : of_machines) {
    const std::string name = option.front();
    option.insert(option.end(), {"--fidelity", "functional"});
    render_refused(option, {name, "functional"});
  }
  render_refused({"--frames", "2", "--units", "all"}, {"--units", "--frames"});
}

TEST_CASE("an output that cannot be written is refused before anything runs") {
  render_refused({"--out", "picture"}, {"--out", ".png", ".exr"});
  render_refused({"--out", "picture.jpg"}, {"--out", "picture.jpg", ".png"});
  render_refused({"--depth", "depth.tiff"}, {"--depth", ".exr"});
  render_refused({"--stats", "stats.txt"}, {"--stats", ".json", "-"});
  render_refused({"--out", "-"}, {"--out", ".png"});
  render_refused({"--out", "no/such/folder/x.png"}, {"--out", "no/such/folder"});
  render_refused({"--out", "x.exr", "--depth", "./x.exr"}, {"--out", "--depth"});
  refused({"trace", "record", "builtin:triangle", "-o", "x.trace"}, {"--out", ".qtrace"});
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "x.png");
  require_refused(run_quadrille(folder, {"render", "builtin:triangle", "--out", "x.png"}),
                  {"--out", "x.png", "plain file"});
  CHECK(std::filesystem::is_empty(folder.path() / "x.png"));
}

TEST_CASE("a wrong output spares the other one") {
  render_refused({"--out", "fine.png", "--stats", "stats.txt"}, {"--stats"});
  const ScratchFolder folder;
  folder.write("old.png", "an older picture");
  require_refused(run_quadrille(folder, {"render", "builtin:nothing", "--out", "old.png"}), {"nothing"});
  CHECK(folder.read("old.png") == "an older picture");
}

TEST_CASE("a frame that takes longer than it may is given up with who waits for whom") {
  const ScratchFolder folder;
  const ProgramRun run = run_quadrille(folder, {"render", "builtin:triangle", "--size", "64x64",
                                                "--max-cycles", "10", "--out", "x.png", "--stats", "x.json"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Catch::StartsWith("quadrille: the limit of "));
  CHECK(folder.empty());
}

TEST_CASE("pictures that do not compare are refused") {
  refused({"diff", "a.png", "b.png"}, {"a.png"});
  refused({"diff", "a.json", "b.json"}, {"a.json: figures", "diff compares two pictures", "--out of render"});
  refused({"diff", "a.png", "b.qtrace"}, {"b.qtrace: a trace", "diff compares two pictures"});
  const ScratchFolder folder;
  folder.write("a.png", "no picture");
  require_refused(run_quadrille(folder, {"diff", "a.png", "a.png"}), {"a.png"});
  require_refused(run_quadrille(folder, {"diff", "a.png", "a.png", "--max-lsb", "256"}),
                  {"--max-lsb", "255"});
  require_refused(run_quadrille(folder, {"diff", "a.png", "a.png", "--heat", "h.jpg"}), {"--heat", ".png"});
}

TEST_CASE("a group that is none is refused with the groups") {
  refused({"describe", "engine"}, {"engine", "coarse_raster", "link"});
}

TEST_CASE("a trace command wants a trace, and a trace takes no view") {
  refused({"trace", "info", "builtin:triangle"}, {".qtrace"});
  refused({"trace", "replay", "scene.gltf"}, {".qtrace"});
  refused({"render", "x.qtrace", "--size", "16x16"}, {"x.qtrace", "--size"});
  refused({"trace", "replay", "x.qtrace", "--size", "16x16"}, {"--size"});
}

TEST_CASE("details that are none, or that nothing would show, are refused") {
  render_refused({"--detail", "draw"}, {"--detail: draw not in {draws,tiles,timeline,path,misses,textures}"});
  render_refused({"--detail", "draws,"},
                 {"--detail: an empty word not in {draws,tiles,timeline,path,misses,textures}"});
  render_refused({"--detail", "tiles"}, {"--detail: tiles are in the JSON alone; add --stats"});
  render_refused({"--detail", "draws", "--frames", "2"},
                 {"--detail: with --frames each frame is one row; add --stats"});
  render_refused({"--detail", "draws", "--fidelity", "functional"},
                 {"--detail: a functional run has no units and no cycles"});
}
