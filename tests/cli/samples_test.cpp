/// --samples and what goes with it: what is refused, and that a scene, its trace and a functional run agree.
#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

namespace {

/// Runs the program and requires success.
void run(const ScratchFolder& folder, const std::vector<std::string>& arguments) {
  const ProgramRun done = run_quadrille(folder, arguments);
  CAPTURE(arguments, done.err);
  REQUIRE(done.exit_code == 0);
}

bool equal(const ScratchFolder& folder, const std::string& a, const std::string& b) {
  return run_quadrille(folder, {"diff", a, b, "--max-lsb", "0"}).exit_code == 0;
}

}  // namespace

TEST_CASE("samples: other numbers are refused before anything is loaded") {
  for (const std::string number : {"0", "3", "16", "-4", "4.0", "", "four"})
    refused({"render", "builtin:cubes", "--samples", number, "--out", "a.png"},
            {"--samples", "1, 2, 4 or 8"});
}

TEST_CASE("samples: a trace has those that it was recorded with, or is given them, once") {
  const ScratchFolder folder;
  run(folder, {"render", "builtin:cubes", "--size", "64x36", "--samples", "4", "-q", "--out", "a.png"});
  run(folder, {"trace", "record", "builtin:cubes", "--size", "64x36", "--samples", "4", "--out", "x.qtrace"});
  run(folder, {"trace", "record", "builtin:cubes", "--size", "64x36", "--out", "y.qtrace"});
  run(folder, {"render", "x.qtrace", "-q", "--out", "b.png", "--fidelity", "functional"});
  run(folder, {"render", "y.qtrace", "-q", "--out", "c.png", "--samples", "4"});
  run(folder, {"render", "y.qtrace", "-q", "--out", "d.png"});
  CHECK(equal(folder, "a.png", "b.png"));
  CHECK(equal(folder, "a.png", "c.png"));
  CHECK_FALSE(equal(folder, "a.png", "d.png"));
  require_refused(run_quadrille(folder, {"render", "x.qtrace", "--samples", "2"}),
                  {"--samples: x.qtrace", "images of 4 samples"});
}

TEST_CASE("samples: passes that must keep one are told of") {
  const ScratchFolder folder;
  const ProgramRun done = run_quadrille(
      folder, {"render", "builtin:outlines", "--size", "64x36", "--samples", "4", "-q", "--out", "a.png"});
  CHECK(done.exit_code == 0);
  CHECK_THAT(done.err, Catch::Contains("builtin:outlines: 1 of its passes keep one sample a pixel"));
}

TEST_CASE("samples: shading each is refused where there is one, goes into traces, and shades as many") {
  refused({"render", "builtin:cubes", "--supersample", "--out", "a.png"},
          {"--supersample", "--samples 2, 4 or 8"});
  refused({"render", "builtin:cubes", "--supersample", "--samples", "1"}, {"--supersample"});
  const ScratchFolder folder;
  const std::vector<std::string> scene{"builtin:quad", "--size", "64x36", "--samples", "4"};
  const auto with = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), scene.begin(), scene.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  run(folder, with({"render"}, {"-q", "--out", "a.png"}));
  run(folder, with({"render"}, {"-q", "--out", "b.png", "--supersample"}));
  run(folder, with({"trace", "record"}, {"--out", "x.qtrace", "--supersample"}));
  run(folder, {"render", "x.qtrace", "-q", "--out", "c.png", "--fidelity", "functional"});
  CHECK_FALSE(equal(folder, "a.png", "b.png"));
  CHECK(equal(folder, "b.png", "c.png"));
  // Eight layers over the whole picture. By pixel, those on the squares' diagonals are shaded twice.
  const auto shaded = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", "builtin:fill", "--size", "64x36",   "--samples", "4",
                                       "-q",     "--out",        "f.png",  "--stats", "f.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run(folder, arguments);
    return nlohmann::json::parse(folder.read("f.json")).at("frame").at("fragments_shaded").get<int>();
  };
  CHECK(shaded({"--supersample"}) == 8 * 64 * 36 * 4);
  CHECK(shaded({}) > 8 * 64 * 36);
  CHECK(shaded({}) < 8 * 64 * 36 * 11 / 10);
}

TEST_CASE("samples: alpha to coverage smooths what an alpha test cuts out, and is in a trace") {
  const ScratchFolder folder;
  const std::vector<std::string> scene{"builtin:courtyard", "--size",     "96x54",
                                       "--fidelity",        "functional", "-q"};
  const auto picture = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render"};
    arguments.insert(arguments.end(), scene.begin(), scene.end());
    arguments.insert(arguments.end(), {"--out", file});
    arguments.insert(arguments.end(), more.begin(), more.end());
    run(folder, arguments);
  };
  picture("a.png", {"--samples", "4"});
  picture("b.png", {"--samples", "4", "--alpha-to-coverage"});
  CHECK_FALSE(equal(folder, "a.png", "b.png"));
  run(folder, {"trace", "record", "builtin:courtyard", "--size", "96x54", "--samples", "4",
               "--alpha-to-coverage", "--out", "x.qtrace"});
  run(folder, {"render", "x.qtrace", "-q", "--out", "c.png", "--fidelity", "functional"});
  CHECK(equal(folder, "b.png", "c.png"));
  require_refused(run_quadrille(folder, {"render", "x.qtrace", "--alpha-to-coverage"}),
                  {"--alpha-to-coverage", "are for scenes"});
}

TEST_CASE("samples: a picture of them has the edges of triangles in other colours than their inside") {
  const ScratchFolder folder;
  for (const char* file : {"a.png", "b.png"})
    run(folder, {"render", "builtin:cubes", "--size", "64x36", "--view", "samples", "--samples",
                 file[0] == 'a' ? "1" : "4", "-q", "--out", file});
  CHECK_FALSE(equal(folder, "a.png", "b.png"));
}
