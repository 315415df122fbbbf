/// The lectures' pipelines through the program: what the flags say, and that machine and laws take every one.
#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

const std::vector<std::vector<std::string>> kEvery{
    {"--shading", "minimal"}, {"--shading", "flat"},  {"--shading", "gouraud"}, {"--shading", "phong"},
    {"--order", "painter"},   {"--view", "overdraw"}, {"--view", "uv"},         {"--view", "normal"},
    {"--view", "triangle"},   {"--view", "depth"}};

/// Runs the program on a small frame, and requires success.
ProgramRun run(const ScratchFolder& folder, std::vector<std::string> arguments,
               const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  ProgramRun done = run_quadrille(folder, arguments);
  CAPTURE(arguments, done.err);
  REQUIRE(done.exit_code == 0);
  return done;
}

bool equal(const ScratchFolder& folder, const std::string& a, const std::string& b) {
  return run_quadrille(folder, {"diff", a, b, "--max-lsb", "0"}).exit_code == 0;
}

}  // namespace

TEST_CASE("shading, order and view: a machine draws what the functional run draws, and its laws hold") {
  for (const std::string scene : {"builtin:cubes", "builtin:overdraw", "builtin:cycle"}) {
    for (const std::vector<std::string>& flags : kEvery) {
      const ScratchFolder folder;
      CAPTURE(scene, flags);
      const std::vector<std::string> small{"render", scene, "--size", "64x36", "-q"};
      std::vector<std::string> exact = flags, functional = flags;
      exact.insert(exact.end(), {"--out", "a.png", "--stats", "a.json"});
      functional.insert(functional.end(), {"--out", "b.png", "--fidelity", "functional"});
      (void)run(folder, small, exact);
      (void)run(folder, small, functional);
      CHECK(equal(folder, "a.png", "b.png"));
      (void)run(folder, small, {"--out", "c.png", "--fidelity", "functional"});
      // The others are unlit; and the painter draws the cubes right.
      if (scene == "builtin:cubes" && flags[0] != "--order") CHECK_FALSE(equal(folder, "b.png", "c.png"));
    }
  }
}

TEST_CASE("shading, order and view: what is the default changes nothing") {
  const ScratchFolder folder;
  const std::vector<std::string> small{"render", "builtin:cubes", "--size", "64x36", "-q"};
  (void)run(folder, small, {"--out", "a.png", "--stats", "a.json"});
  (void)run(folder, small, {"--shading", "pbr", "--order", "file", "--out", "b.png", "--stats", "b.json"});
  CHECK(equal(folder, "a.png", "b.png"));
  json a = json::parse(folder.read("a.json")), b = json::parse(folder.read("b.json"));
  a.erase("host");
  b.erase("host");
  CHECK(a == b);
}

TEST_CASE("shading, order and view: a recorded trace has them in it") {
  for (const std::vector<std::string>& flags : kEvery) {
    const ScratchFolder folder;
    CAPTURE(flags);
    const std::vector<std::string> scene{"builtin:cubes", "--size", "64x36"};
    std::vector<std::string> record{"trace", "record"}, render{"render"};
    record.insert(record.end(), scene.begin(), scene.end());
    render.insert(render.end(), scene.begin(), scene.end());
    record.insert(record.end(), {"--out", "x.qtrace"});
    render.insert(render.end(), {"--fidelity", "functional", "-q", "--out", "a.png"});
    (void)run(folder, record, flags);
    (void)run(folder, render, flags);
    (void)run(folder, {"render", "x.qtrace", "--fidelity", "functional", "-q", "--out", "b.png"}, {});
    CHECK(equal(folder, "a.png", "b.png"));
    require_refused(run_quadrille(folder, {"render", "x.qtrace", flags[0], flags[1]}),
                    {"x.qtrace", flags[0]});
  }
}

TEST_CASE("shading, order and view: frames of an animation have them") {
  const ScratchFolder folder;
  const std::vector<std::string> frames{"render", "builtin:flag", "--size", "48x27",      "--frames",  "2",
                                        "-q",     "--out",        "#.png",  "--fidelity", "functional"};
  for (const std::vector<std::string>& flags : kEvery) {
    CAPTURE(flags);
    (void)run(folder, frames, flags);
    CHECK_FALSE(equal(folder, "0.png", "1.png"));
  }
}

TEST_CASE("shading, order and view: a picture of depths says which are white and black") {
  const ScratchFolder folder;
  const ProgramRun depth =
      run(folder, {"render", "builtin:cycle", "--size", "16x16", "--fidelity", "functional", "-q"},
          {"--view", "depth"});
  CHECK_THAT(depth.err, Catch::StartsWith("builtin:cycle: depth 0.0") && Catch::EndsWith(" black\n"));
  CHECK(std::ranges::count(depth.err, '\n') == 1);
}

TEST_CASE("shading, order and view: the painter has no depths to write") {
  refused({"render", "builtin:cubes", "--size", "16x16", "--order", "painter", "--depth", "d.png"},
          {"--depth", "no depth attachment"});
}

TEST_CASE("shading, order and view: what is not legal is refused with what is") {
  const auto render_refused = [](std::vector<std::string> more, const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"render", "builtin:triangle", "--size", "16x16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    refused(arguments, words);
  };
  render_refused({"--shading", "toon"}, {"--shading", "toon", "minimal", "flat", "gouraud", "phong", "pbr"});
  render_refused({"--shading", ""}, {"--shading", "minimal"});
  render_refused({"--shading", "Phong"}, {"--shading", "Phong", "phong"});
  render_refused({"--order", "back"}, {"--order", "back", "file", "painter"});
  render_refused({"--view", "colors"}, {"--view", "colors", "depth", "overdraw", "uv", "normal", "triangle"});
  render_refused({"--view", "uv", "--shading", "flat"}, {"--view", "--shading"});
  render_refused({"--view", "uv", "--frag", "x.frag"}, {"--view", "--frag"});
  render_refused({"--shading", "flat", "--vert", "x.vert"}, {"--shading", "--vert"});
  render_refused({"--shading"}, {"--shading"});
  refused({"trace", "record", "builtin:triangle", "--out", "x.qtrace", "--shading", "toon"},
          {"--shading", "phong"});
  refused({"accuracy", "builtin:triangle", "--order", "back"}, {"--order", "painter"});
}
