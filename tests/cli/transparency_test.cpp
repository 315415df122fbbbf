/// --transparency: what is refused, and that a scene and its trace agree.
#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

namespace {

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("transparency: what means nothing is refused before anything is loaded") {
  const std::vector<std::string> glass{"render", "builtin:glass"};
  refused(with(glass, {"--transparency", "zbuffer"}), {"--transparency", "sorted", "abuffer", "kbuffer"});
  refused(with(glass, {"--transparency-layers", "4"}), {"--transparency-layers", "abuffer or kbuffer"});
  refused(with(glass, {"--transparency", "sorted", "--transparency-layers", "4"}), {"--transparency-layers"});
  for (const std::string layers : {"0", "9", "-1", "2.5", "", "many"})
    refused(with(glass, {"--transparency", "kbuffer", "--transparency-layers", layers}),
            {"--transparency-layers", "1..8"});
  refused(with(glass, {"--transparency", "abuffer", "--transparency-layers", "65"}), {"1..64"});
  refused(with(glass, {"--transparency", "abuffer", "--order", "painter"}), {"--transparency", "painter"});
  refused(with(glass, {"--transparency", "abuffer", "--view", "overdraw"}), {"--transparency", "--view"});
  refused({"render", "builtin:shadow", "--transparency", "kbuffer"}, {"builtin:shadow", "--transparency"});
  refused({"render", "x.qtrace", "--transparency", "abuffer"}, {"--transparency"});
}

TEST_CASE("transparency: a trace draws what its scene draws, and the counters tell") {
  const ScratchFolder folder;
  const std::vector<std::string> scene{"builtin:glass",  "--size", "96x60", "--samples", "4",
                                       "--transparency", "abuffer"};
  const auto run = [&](const std::vector<std::string>& arguments) {
    const ProgramRun done = run_quadrille(folder, arguments);
    CAPTURE(arguments, done.err);
    REQUIRE(done.exit_code == 0);
  };
  run(with(with({"render"}, scene), {"-q", "--out", "a.png", "--stats", "a.json"}));
  run(with(with({"trace", "record"}, scene), {"--out", "x.qtrace"}));
  run({"render", "x.qtrace", "-q", "--out", "b.png", "--fidelity", "functional"});
  CHECK(run_quadrille(folder, {"diff", "a.png", "b.png", "--max-lsb", "0"}).exit_code == 0);
  CHECK_THAT(folder.read("a.json"), Catch::Contains("nodes_composed"));
}
