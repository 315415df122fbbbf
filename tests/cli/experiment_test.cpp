/// `quadrille experiment`: its list, its refusals, and a small run that writes a page and a plot.
#include <catch2/catch.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

TEST_CASE("experiment names its experiments, and refuses one that is not there with the nearest name") {
  const ScratchFolder folder;
  CHECK(run_quadrille(folder, {"experiment", "--list"}).out.find("memory-scheduling") != std::string::npos);
  const auto refused = run_quadrille(folder, {"experiment", "memory-schedulin"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Catch::Contains("memory-scheduling"));
}

TEST_CASE("experiment vertex-reuse finds as many vertices shaded as the analyser and the published steps") {
  const ScratchFolder folder;
  const auto run =
      run_quadrille(folder, {"experiment", "vertex-reuse", "--scene", "builtin:cubes", "--size", "32x32"});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Catch::Contains("holds  builtin:cubes: vertices shaded apart from the analyser's") &&
                          Catch::Contains("holds  GeForce GTX 1080 Ti, 96 indices: vertices shaded: 3") &&
                          Catch::Contains("holds  GeForce GTX 1080 Ti, 99 indices: vertices shaded: 6") &&
                          !Catch::Contains("FAILS"));
}

TEST_CASE("experiment prints a table and writes a page with its plot") {
  const ScratchFolder folder;
  const auto run = run_quadrille(folder, {"experiment", "memory-scheduling", "--scene", "builtin:quad",
                                          "--size", "64x64", "--out", "pages"});
  CHECK(run.exit_code == 0);  // memory does not limit it: nothing is held to the band
  CHECK(run.out.find("memory is not the limit") != std::string::npos);
  CHECK(folder.read("pages/memory-scheduling.md").find("memory-scheduling.png") != std::string::npos);
  CHECK(folder.read("pages/memory-scheduling.png").substr(1, 3) == "PNG");
}
