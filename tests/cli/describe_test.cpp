/// What the program says of itself.
#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

std::string output(const std::vector<std::string>& arguments) {
  const ScratchFolder folder;
  const ProgramRun run = run_quadrille(folder, arguments);
  CAPTURE(arguments, run.err);
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  return run.out;
}

}  // namespace

TEST_CASE("help teaches: it names every subcommand and shows examples") {
  const std::string help = output({"--help"});
  for (const char* word : {"render", "diff", "describe", "trace", "scenes", "machines", "Examples"})
    CHECK_THAT(help, Catch::Contains(word));
  const std::string render = output({"render", "--help"});
  for (const char* word :
       {"--machine", "--set", "--size", "--camera", "--eye", "--at", "--vert", "--frag", "--out", "--depth",
        "--stats", "--fidelity", "--leave-out", "--driver", "--max-cycles", "Examples"}) {
    CHECK_THAT(render, Catch::Contains(word));
  }
}

TEST_CASE("lists name what comes with the program") {
  CHECK_THAT(output({"scenes"}), Catch::Contains("builtin:triangle") && Catch::Contains("builtin:courtyard"));
  CHECK_THAT(output({"machines"}),
             Catch::Contains("default") && Catch::Contains("small") && Catch::Contains("large"));
}

TEST_CASE(
    "describe gives every parameter a default, legal values and a reason, and every counter a unit and a "
    "definition") {
  const json d = json::parse(output({"describe", "--json"}));
  REQUIRE(d.at("parameters").size() > 150);
  for (const auto& [path, p] : d.at("parameters").items()) {
    CAPTURE(path);
    CHECK(p.at("value") == p.at("default"));
    CHECK_FALSE(p.at("legal").get<std::string>().empty());
    CHECK_FALSE(p.at("reason").get<std::string>().empty());
  }
  REQUIRE(d.at("counters").size() == 17);
  for (const auto& [kind, counters] : d.at("counters").items()) {
    for (const auto& [name, c] : counters.items()) {
      CAPTURE(kind, name);
      CHECK_FALSE(c.at("unit").get<std::string>().empty());
      CHECK_FALSE(c.at("definition").get<std::string>().empty());
    }
  }
}

TEST_CASE("describe and a run agree on parameters and counters") {
  const ScratchFolder folder;
  REQUIRE(run_quadrille(folder, {"render", "builtin:quad", "--size", "8x8", "--leave-out", "none", "-q",
                                 "--stats", "s.json"})
              .exit_code == 0);
  const json run = json::parse(folder.read("s.json")),
             described = json::parse(output({"describe", "--json"}));
  CHECK(run.at("counter_definitions").size() == described.at("counters").size());
  for (const auto& [kind, counters] : run.at("counter_definitions").items()) {
    CAPTURE(kind);
    CHECK(counters == described.at("counters").at(kind));
  }
  CHECK(run.at("machine").at("parameters").size() == described.at("parameters").size());
}

TEST_CASE("describe takes a group, a machine and a form") {
  const std::string texture = output({"describe", "texture"});
  CHECK_THAT(texture, Catch::Contains("filter_quads_per_clk") && Catch::Contains("cache_hits") &&
                          !Catch::Contains("warp_packer"));
  CHECK_THAT(output({"describe", "link.core_to_rop"}),
             Catch::Contains("credit_latency") && !Catch::Contains("rop_to_depth"));
  CHECK_THAT(output({"describe", "gpu", "--machine", "large"}), Catch::Contains("(default 4)"));
  const std::string one = output({"describe", "texture.cache_lines"});
  CHECK(std::ranges::count(one, '\n') == 2);
  CHECK_THAT(one, Catch::StartsWith("texture\n  cache_lines "));
  CHECK_THAT(output({"describe", "texture.cache_hits"}), Catch::StartsWith("texture counts\n  cache_hits "));
  const std::string everywhere = output({"describe", "cache_lines"});
  CHECK(std::ranges::count(everywhere, '\n') == 12);
  CHECK_THAT(everywhere, Catch::Contains("l2\n  cache_lines ") && !Catch::Contains("cache_ways"));
  const std::string links = output({"describe", "link.core"});
  CHECK_THAT(links, Catch::Contains("link.core_to_rop\n") && Catch::Contains("link.core_to_texture\n") &&
                        !Catch::Contains("link.rop"));
  CHECK(json::parse(output({"describe", "gpu.cores", "--json"})).at("parameters").size() == 1);
  const std::string page = output({"describe", "--markdown"});
  CHECK_THAT(page, Catch::StartsWith("# Parameters") && Catch::Contains("# Counters") &&
                       Catch::Contains("| `tests_per_clk` |"));
  CHECK_THAT(output({"describe", "--only", "counters"}),
             !Catch::Contains("tests_per_clk") && Catch::Contains("tiles_tested"));
}
