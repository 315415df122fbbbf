/// Machines in layers, and that every report says what was changed from what.
#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

ProgramRun render(const ScratchFolder& folder, std::vector<std::string> more) {
  std::vector<std::string> arguments{"render", "builtin:triangle", "--size", "16x16"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  ProgramRun run = run_quadrille(folder, arguments);
  CAPTURE(arguments, run.err);
  CHECK(run.exit_code == 0);
  return run;
}

json described(const ScratchFolder& folder, const std::string& machine) {
  const ProgramRun run =
      run_quadrille(folder, {"describe", "--only", "parameters", "--json", "--machine", machine});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  const json all = json::parse(run.out);
  json values;
  for (const auto& [path, p] : all.at("parameters").items()) values[path] = p.at("value");
  return values;
}

}  // namespace

TEST_CASE("a report says what was changed from what") {
  const ScratchFolder folder;
  CHECK_THAT(render(folder, {}).out, Catch::Contains("machine default, exact"));
  CHECK_THAT(render(folder, {"--set", "gpu.cores=8", "--set", "gpu.channels=2"}).out,
             // a value that it had is no change
             Catch::Contains("machine default with gpu.cores=8 (4), exact"));
  CHECK_THAT(render(folder, {"--machine", "large", "--set", "gpu.cores=8"}).out,
             Catch::Contains("machine large with gpu.cores=8 (16), exact"));
  folder.write("mine.toml", "[gpu]\ncores = 8\n");
  CHECK_THAT(render(folder, {"--machine", "mine.toml"}).out,
             Catch::Contains("machine mine.toml: default with gpu.cores=8 (4), exact"));
  folder.write("named.toml", "name = \"mine\"\n[gpu]\ncores = 8\n");
  CHECK_THAT(render(folder, {"--machine", "named.toml"}).out,
             Catch::Contains("machine mine: default with gpu.cores=8 (4), exact"));
  std::vector<std::string> many{"--frames", "1"};
  for (const char* parameter : {"depth", "width", "latency", "credit_latency"}) {
    for (const char* link : {"core_to_rop", "rop_to_depth"})
      many.insert(many.end(), {"--set", std::string("link.") + link + "." + parameter + "=5"});
  }
  CHECK_THAT(render(folder, many).out,
             Catch::Contains("machine default with link.rop_to_depth.depth=5 (8), ") &&
                 Catch::Contains(" and 2 more, exact"));
}

TEST_CASE("the JSON holds the whole machine, its base and what was changed") {
  const ScratchFolder folder;
  folder.write("mine.toml", "base = \"large\"\ntexture.cache_lines = 64\n");
  (void)render(folder, {"--machine", "mine.toml", "--set", "gpu.cores=8", "-q", "--stats", "s.json"});
  const json machine = json::parse(folder.read("s.json")).at("machine");
  CHECK(machine.at("name") == "mine.toml");
  CHECK(machine.at("base") == "large");
  CHECK(machine.at("changed").size() == 2);
  CHECK(machine.at("changed").at("gpu.cores") == json{{"value", 8}, {"base", 16}});
  CHECK(machine.at("changed").at("texture.cache_lines").at("value") == 64);
  CHECK(machine.at("parameters").at("gpu.cores") == 8);
  CHECK(machine.at("parameters").size() == described(folder, "default").size());
}

TEST_CASE("a machine file is a layer on its base: one by name, or a file beside it") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  folder.write("sub/a.toml", "base = \"large\"\n[l2]\ncache_lines = 64\n");
  folder.write("b.toml", "base = \"sub/a.toml\"\n[gpu]\nchannels = 3\n");
  json expected = described(folder, "large");
  expected["l2.cache_lines"] = 64;
  CHECK(described(folder, "sub/a.toml") == expected);
  expected["gpu.channels"] = 3;
  CHECK(described(folder, "b.toml") == expected);
  folder.write("first.toml", "gpu.cores = 3\nbase = \"small\"\n");  // the base comes first wherever it stands
  CHECK(described(folder, "first.toml").at("gpu.cores") == 3);
}

TEST_CASE("a base that is none, or goes in a circle, is refused with its place") {
  const ScratchFolder folder;
  const auto refuse = [&](const std::string& machine, const std::vector<std::string>& words) {
    require_refused(run_quadrille(folder, {"render", "builtin:triangle", "--machine", machine}), words);
  };
  folder.write("typo.toml", "\nbase = \"larg\"\n");
  refuse("typo.toml", {"typo.toml:2: base", "larg", "did you mean 'large'?"});
  folder.write("key.toml", "bse = \"large\"\n");
  refuse("key.toml", {"key.toml:1: unknown key 'bse'", "did you mean 'base'?"});
  folder.write("bare.toml", "cores = 3\n");
  refuse("bare.toml", {"bare.toml:1: unknown key 'cores'", "did you mean 'gpu.cores'?"});
  folder.write("number.toml", "base = 3\n");
  refuse("number.toml", {"number.toml:1: base", "name of a machine"});
  folder.write("table.toml", "[base]\ncores = 3\n");
  refuse("table.toml", {"table.toml:1: base"});
  folder.write("missing.toml", "base = \"nowhere.toml\"\n");
  refuse("missing.toml", {"missing.toml:1: base", "nowhere.toml: no such file"});
  folder.write("self.toml", "base = \"self.toml\"\n");
  refuse("self.toml", {"in a circle: self.toml -> self.toml"});
  folder.write("x.toml", "base = \"y.toml\"\n");
  folder.write("y.toml", "base = \"./x.toml\"\n");
  refuse("x.toml", {"x.toml:1: base: y.toml:1: base", "in a circle: x.toml -> y.toml -> ./x.toml"});
  for (int i = 0; i < 40; ++i)
    folder.write(std::to_string(i) + ".toml", "base = \"" + std::to_string(i + 1) + ".toml\"\n");
  refuse("0.toml", {"at most 32"});
  folder.write("wrong.toml", "[gpu]\ncores = 0\n");
  folder.write("above.toml", "base = \"wrong.toml\"\n");
  refuse("above.toml", {"above.toml:1: base: wrong.toml:2", "gpu.cores"});
}

TEST_CASE("what must hold between parameters is asked of the whole, not of a layer") {
  const ScratchFolder folder;
  folder.write("half.toml", "[texture]\ncache_lines = 3\n");
  folder.write("whole.toml", "base = \"half.toml\"\n[texture]\ncache_ways = 3\n");
  CHECK(described(folder, "whole.toml").at("texture.cache_lines") == 3);
  require_refused(run_quadrille(folder, {"describe", "--machine", "half.toml"}),
                  {"half.toml", "texture.cache_lines"});
}

TEST_CASE("a cache is whole sets: other numbers of lines are refused with the nearest legal ones") {
  for (const std::string cache : {"vertex_fetch", "texture", "depth", "rop", "l2"}) {
    const auto with = [&](int lines, int ways) {
      return std::vector<std::string>{"describe", "--set", cache + ".cache_lines=" + std::to_string(lines),
                                      "--set", cache + ".cache_ways=" + std::to_string(ways)};
    };
    refused(with(12, 8), {cache + ".cache_lines (12)", cache + ".cache_ways (8)", "8 or 16"});
    refused(with(8, 16), {cache + ".cache_lines (8)", cache + ".cache_ways (16)", "can be 16"});
    refused(with(15, 16), {"can be 16"});
    const ScratchFolder folder;
    for (const auto& [lines, ways] : {std::pair{16, 16}, {12, 4}, {1, 1}, {15, 5}})
      CHECK(run_quadrille(folder, with(lines, ways)).exit_code == 0);
  }
}

TEST_CASE("a machine is written out whole, and read back it is the same") {
  const ScratchFolder folder;
  folder.write("mine.toml",
               "name = \"a\\nb\"\nbase = \"large\"\ngpu.clock_mhz = 1.5\ngpu.linear_log2 = "
               "true\nmemory.path_clk = 7\n");
  for (const std::string machine : {"default", "small", "large", "mine.toml"}) {
    const ProgramRun run = run_quadrille(folder, {"describe", "machine", machine, "--toml"});
    REQUIRE(run.exit_code == 0);
    folder.write("whole.toml", run.out);
    CHECK(described(folder, "whole.toml") == described(folder, machine));
  }
  const ProgramRun changed =
      run_quadrille(folder, {"describe", "machine", "large", "--set", "gpu.cores=8", "--toml"});
  CHECK_THAT(changed.out, Catch::StartsWith("# large with gpu.cores=8 (16)\n") &&
                              Catch::Contains("\ncores = 8  # core, 1 to 64: "));
  refused({"describe", "texture", "large"}, {"'large'", "describe machine"});
  refused({"describe", "machine", "larg"}, {"larg", "large"});
}
