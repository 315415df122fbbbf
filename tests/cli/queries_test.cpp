/// --queries: a scene, its trace and a functional run tell the same, and what has queries is given no others.
#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

namespace {

nlohmann::json queries_of(const ScratchFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"-q", "--stats", "f.json"});
  const ProgramRun done = run_quadrille(folder, arguments);
  CAPTURE(arguments, done.err);
  REQUIRE(done.exit_code == 0);
  return nlohmann::json::parse(folder.read("f.json")).value("queries", nlohmann::json());
}

}  // namespace

TEST_CASE(
    "queries: eight layers over the picture are eight queries of as many samples, and one of statistics") {
  const ScratchFolder folder;
  const std::vector<std::string> scene{"builtin:fill", "--size", "64x36", "--queries"};
  std::vector<std::string> render{"render"}, record{"trace", "record"};
  render.insert(render.end(), scene.begin(), scene.end());
  record.insert(record.end(), scene.begin(), scene.end());
  record.insert(record.end(), {"--out", "x.qtrace"});
  const nlohmann::json asked = queries_of(folder, render);
  REQUIRE(asked.size() == 9);
  CHECK(asked[0].at("type") == "pipeline_statistics");
  CHECK(asked[0].at("draws") == 8);
  CHECK(asked[0].at("values").at("input_assembly_primitives") == 16);
  for (std::size_t i = 1; i < 9; ++i) {
    CHECK(asked[i].at("first_draw") == i - 1);
    CHECK(asked[i].at("values").at("samples_passed") == 64 * 36);
  }
  REQUIRE(run_quadrille(folder, record).exit_code == 0);
  CHECK(queries_of(folder, {"render", "x.qtrace"}) == asked);
  nlohmann::json functional = queries_of(folder, {"render", "x.qtrace", "--fidelity", "functional"});
  CHECK(functional[0].at("values").at("input_assembly_primitives").is_null());
  functional[0] = asked[0];
  CHECK(functional == asked);
  require_refused(run_quadrille(folder, {"render", "x.qtrace", "--queries"}),
                  {"--queries: x.qtrace", "queries of its own"});
  CHECK(queries_of(folder, {"render", "builtin:fill", "--size", "64x36"}).is_null());
}
