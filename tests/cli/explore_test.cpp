/// `quadrille explore` as its users run it.
#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

namespace {

constexpr const char* kSweep = R"([[scene]]
file = "builtin:triangle"
size = "32x32"
[[scene]]
file = "builtin:cubes"
size = "32x32"
[vary]
gpu.cores = [1, 2]
l2.cache_lines = { from = 1024, to = 4096, factor = 2 }
[[objective]]
name = "cycles"
formula = "frame.cycles"
over = "sum"
)";

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

}  // namespace

TEST_CASE("explore: a sweep is drawn, said and written, and drawn once") {
  const ScratchFolder folder;
  folder.write("sweep.toml", kSweep);
  const ProgramRun first = run_quadrille(folder, {"explore", "sweep.toml", "--jobs", "2", "--csv", "a.csv"});
  CAPTURE(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK_THAT(first.out, Catch::Contains("6 machines x 2 scenes = 12 points"));
  CHECK_THAT(first.out, Catch::Contains("BEST  by cycles, of 6 machines"));
  CHECK_THAT(first.err, Catch::Contains("12 of 12 points"));
  CHECK(lines_of(folder.read("a.csv")) == 13);
  CHECK_THAT(folder.read("a.csv"), Catch::StartsWith("scene,machine,gpu.cores,l2.cache_lines,status"));
  const ProgramRun second = run_quadrille(folder, {"explore", "sweep.toml", "--csv", "b.csv"});
  CHECK(second.exit_code == 0);
  CHECK_THAT(second.err, !Catch::Contains("points"));
  CHECK(folder.read("a.csv") == folder.read("b.csv"));
}

TEST_CASE("explore: the cycles of a point are those of render") {
  const ScratchFolder folder;
  folder.write("sweep.toml", kSweep);
  REQUIRE(run_quadrille(folder, {"explore", "sweep.toml", "--csv", "a.csv"}).exit_code == 0);
  const std::string csv = folder.read("a.csv");
  const ProgramRun run =
      run_quadrille(folder, {"render", "builtin:cubes", "--size", "32x32", "--set", "gpu.cores=2", "--set",
                             "l2.cache_lines=1024", "-q", "--csv", "f.csv"});
  REQUIRE(run.exit_code == 0);
  const std::string figures = folder.read("f.csv"), path = "frame.cycles,";
  const std::size_t at = figures.find(path) + path.size();
  const std::string cycles = figures.substr(at, figures.find(',', at) - at);
  CHECK_THAT(csv, Catch::Contains("cubes,default,2,1024,done,," + cycles + ","));
}

TEST_CASE("explore: a dry run says points, time and disk, and leaves nothing") {
  const ScratchFolder folder;
  folder.write("sweep.toml", kSweep);
  const ProgramRun run = run_quadrille(folder, {"explore", "sweep.toml", "--dry-run", "--jobs", "1"});
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Catch::Contains("= 12 points") &&
                          Catch::Contains("0 points are known; the other 12 take about") &&
                          Catch::Contains("MiB (6 points were measured)"));
  CHECK_FALSE(folder.has("sweep.db"));
}

TEST_CASE("explore: a dry run of a sweep that screens says what each of its rounds takes") {
  const ScratchFolder folder;
  folder.write("sweep.toml", kSweep + std::string("[screen]\nwindow = 500\nmachines = 2\n"));
  const ProgramRun run = run_quadrille(folder, {"explore", "sweep.toml", "--dry-run", "--jobs", "1"});
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Catch::Contains("with a window of 500 cycles:\n  0 points are known; the other 12"));
  CHECK_THAT(run.out, Catch::Contains("the best 2, exactly:\n  0 points are known; the other 4"));
  CHECK_FALSE(folder.has("sweep.db"));
}

TEST_CASE("explore: what is wrong is refused before anything is drawn, with file and line") {
  const auto refuse = [](const std::string& text, const std::vector<std::string>& words) {
    const ScratchFolder folder;
    folder.write("sweep.toml", text);
    CAPTURE(text);
    require_refused(run_quadrille(folder, {"explore", "sweep.toml"}), words);
    CHECK_FALSE(folder.has("sweep.db"));
  };
  const std::string scene = "[[scene]]\nfile = \"builtin:triangle\"\n";
  refuse(scene + "sise = \"4x4\"\n", {"sweep.toml:3", "did you mean 'size'"});
  refuse(scene + "size = \"4y4\"\n", {"sweep.toml:1", "WIDTHxHEIGHT"});
  refuse("[[scene]]\nfile = \"builtin:triangel\"\n", {"sweep.toml:1", "triangel"});
  refuse("[[scene]]\nfile = \"missing.gltf\"\n", {"sweep.toml:1", "missing.gltf"});
  refuse(scene + "[vary]\ngpu.cores = [100]\n", {"sweep.toml:4", "gpu.cores"});
  refuse("constraints = [\"gpu.cores > 99\"]\n" + scene, {"no machine is left"});
  refused({"explore", "nothing.toml"}, {"nothing.toml"});
  refused({"explore", "nothing.toml", "--jobs", "0"}, {"--jobs"});
}

TEST_CASE("explore: an unknown figure is refused with the line of its formula") {
  const ScratchFolder folder;
  folder.write(
      "sweep.toml",
      "[[scene]]\nfile = \"builtin:triangle\"\n[[objective]]\nname = \"a\"\nformula = \"frame.cycels\"\n");
  require_refused(run_quadrille(folder, {"explore", "sweep.toml"}),
                  {"sweep.toml:5", "did you mean 'frame.cycles'"});
}
