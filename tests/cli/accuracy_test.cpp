/// `quadrille accuracy` and `render --window` from the command line.
#include <nlohmann/json.hpp>

#include <cstdlib>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

void accuracy_refused(std::vector<std::string> more, const std::vector<std::string>& words) {
  std::vector<std::string> arguments{"accuracy", "builtin:triangle"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  refused(arguments, words);
}

/// Sets PATH while it lives.
class PathOf {
 public:
  explicit PathOf(const std::string& folder) : old_(std::getenv("PATH")) {
    setenv("PATH", folder.c_str(), 1);
  }
  ~PathOf() { setenv("PATH", old_.c_str(), 1); }
  PathOf(const PathOf&) = delete;
  PathOf& operator=(const PathOf&) = delete;

 private:
  std::string old_;
};

}  // namespace

TEST_CASE("a window that cannot be is refused") {
  for (const std::string window : {"-1", "many", "1.5", "1000001", ""})
    refused({"render", "builtin:triangle", "--window", window}, {"--window", "1000000"});
  refused({"render", "builtin:triangle", "--window", "4", "--driver", "native"},
          {"--window", "native", "exact"});
  refused({"render", "builtin:triangle", "--window", "4", "--fidelity", "functional"},
          {"--window", "functional"});
}

TEST_CASE("a run with a window says that it is approximate, one with a window of 0 is exact") {
  const ScratchFolder folder;
  const std::vector<std::string> base{"render",  "builtin:quad", "--size",  "48x32",
                                      "--stats", "s.json",       "--window"};
  const auto with = [&](const std::string& window) {
    std::vector<std::string> arguments = base;
    arguments.push_back(window);
    const ProgramRun run = run_quadrille(folder, arguments);
    REQUIRE(run.exit_code == 0);
    return std::pair(run.out, json::parse(folder.read("s.json")));
  };
  const auto [table, stats] = with("64");
  CHECK_THAT(table, Catch::Contains("approximate (window of 64 cycles") &&
                        Catch::Contains("UNITS (approximate)") && Catch::Contains("BANDWIDTH (approximate)"));
  CHECK(stats.at("fidelity") == "approximate");
  CHECK(stats.at("window_cycles") == 64);
  const auto [exact_table, exact_stats] = with("0");
  CHECK_THAT(exact_table, !Catch::Contains("approximate"));
  CHECK(exact_stats.at("fidelity") == "exact");
  CHECK(exact_stats.at("window_cycles") == 0);
}

TEST_CASE("a study that cannot be is refused before anything runs") {
  refused({"accuracy"}, {"SCENE"});
  refused({"accuracy", "builtin:triangle", "nothing.obj"}, {"nothing.obj"});
  refused({"accuracy", "builtin:triangle", "builtin:nothing", "--repeat", "0"}, {"--repeat", "1000"});
  for (const std::string windows : {"", "0", "4,", "4,4", "4;8", "x", "1000001"})
    accuracy_refused({"--windows", windows}, {"--windows"});
  accuracy_refused({"--size", "0x4"}, {"--size"});
  accuracy_refused({"--set", "gpu.cores=0"}, {"gpu.cores"});
  accuracy_refused({"--json", "x.txt"}, {"--json", ".json"});
  accuracy_refused({"--plot", "x.pdf"}, {"--plot", ".svg"});
  accuracy_refused({"--plot", "x.svg", "--precision-plot", "./x.svg"}, {"--plot", "--precision-plot"});
  accuracy_refused({"--no-precision", "--precision-plot", "x.svg"}, {"--precision-plot", "--no-precision"});
}

TEST_CASE("a scene that is not there is refused before any other is measured") {
  const ScratchFolder folder;
  for (const char* command : {"accuracy", "leave-out"}) {
    for (const char* missing : {"builtin:nope", "nope.glb", "nope.qtrace"}) {
      const ProgramRun run = run_quadrille(folder, {command, "builtin:triangle", missing, "--repeat", "1"});
      require_refused(run, {missing});
      CHECK(run.out.empty());
    }
  }
}

TEST_CASE("plots without gnuplot are refused before anything runs") {
  const ScratchFolder nothing;
  const PathOf empty(nothing.path().string());
  accuracy_refused({"--plot", "x.svg"}, {"--plot", "gnuplot-nox"});
  accuracy_refused({"--precision-plot", "x.svg"}, {"--precision-plot", "gnuplot-nox"});
}

TEST_CASE("a study of two scenes prints their tables and writes JSON and plots") {
  const ScratchFolder folder;
  const ProgramRun run = run_quadrille(
      folder, {"accuracy", "builtin:triangle", "builtin:quad", "--size", "32x24", "--repeat", "1",
               "--windows", "16", "--json", "a.json", "--plot", "a.svg", "--precision-plot", "p.png"});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(run.err.empty());
  for (const char* line :
       {"ACCURACY  builtin:triangle, 32x24", "ACCURACY  builtin:quad, 32x24", "  functional ", "  exact ",
        "  window 16 ", "PICTURE  against", "PRECISION  pictures", "  subpixel_bits "})
    CHECK_THAT(run.out, Catch::Contains(line));
  const json document = json::parse(folder.read("a.json"));
  CHECK(document.at("schema") == "quadrille-accuracy-1");
  REQUIRE(document.at("scenes").size() == 2);
  CHECK(document.at("scenes").at(1).at("settings").size() == 3);
  CHECK_THAT(folder.read("a.svg"), Catch::Contains("<svg") && Catch::Contains("builtin:quad"));
  CHECK(folder.read("p.png").starts_with("\x89PNG"));
}

TEST_CASE("a recorded trace is a scene too, without a table of triangles") {
  const ScratchFolder folder;
  REQUIRE(run_quadrille(folder, {"trace", "record", "builtin:triangle", "--size", "24x16", "-o", "t.qtrace"})
              .exit_code == 0);
  const ProgramRun run =
      run_quadrille(folder, {"accuracy", "t.qtrace", "--repeat", "1", "--windows", "4", "--no-precision"});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.out, Catch::Contains("t.qtrace, 24x16") && !Catch::Contains("PRECISION"));
}
