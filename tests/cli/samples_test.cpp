/// --samples: what is refused, and that a scene, its trace and a functional run agree.
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
