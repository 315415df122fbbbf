/// What is drawn otherwise than a file says, said in a line each on standard error; and a file's light,
/// brought into the picture.
#include "tests/cli/quadrille.h"

#include <fmt/format.h>

using namespace quadrille::tests;

namespace {

/// A triangle; its second accessor holds two normals of zero and one that is not a number, its third and
/// fourth joints and weights that sum to 0.75, 1 and 0.
std::string triangle(const std::string& attributes, const std::string& node = "",
                     const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0)" + attributes +
         R"(}}]}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":36},{"buffer":2,"byteLength":12},{"buffer":3,"byteLength":48}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":2,"componentType":5121,"count":3,"type":"VEC4"},{"bufferView":3,"componentType":5126,"count":3,"type":"VEC4"}],"buffers":[)"
         R"({"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"},)"
         R"({"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAADAfwAAAAAAAIA/"},)"
         R"({"byteLength":12,"uri":"data:;base64,AAAAAAAAAAAAAAAA"},)"
         R"({"byteLength":48,"uri":"data:;base64,AAAAPwAAgD4AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"}])" +
         more + "}";
}

/// What drawing the file says on standard error.
std::string said(const std::string& text, std::vector<std::string> more = {}) {
  const ScratchFolder folder;
  folder.write("t.gltf", text);
  std::vector<std::string> arguments{"render", "t.gltf", "--size", "16x16", "--fidelity", "functional"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = run_quadrille(folder, arguments);
  CHECK(run.exit_code == 0);
  return run.err;
}

}  // namespace

TEST_CASE("a file that is drawn as it is says nothing") { CHECK(said(triangle("")).empty()); }

TEST_CASE("normals without a direction are named in one line") {
  CHECK(said(triangle(R"(,"NORMAL":1)")) ==
        "t.gltf: meshes[0].primitives[0]: 3 of 3 vertices have a normal without a direction; faces of such "
        "vertices are drawn with their "
        "own\n");
}

TEST_CASE("joint weights that do not sum to one are named in one line") {
  CHECK(said(triangle(R"(,"JOINTS_0":2,"WEIGHTS_0":3)", R"(,"skin":0)", R"(,"skins":[{"joints":[0]}])")) ==
        "t.gltf: meshes[0].primitives[0]: 2 of 3 vertices have joint weights that do not sum to 1; they are "
        "divided by their sum, and "
        "without any weight "
        "the first joint moves the vertex\n");
}

TEST_CASE("members that are null are named in one line, by the first") {
  CHECK(said(triangle("", R"(,"camera":null)")) == "t.gltf: nodes[0].camera is null and counts as absent\n");
  CHECK(said(triangle("", R"(,"rotation":null,"name":null)", R"(,"skins":null)")) ==
        "t.gltf: nodes[0].name is null, as are 2 more members, and counts as absent\n");
}

TEST_CASE("instances without a number are drawn once, which a line says") {
  CHECK_THAT(said(triangle("", R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}})")),
             Catch::Contains("nodes[0]: EXT_mesh_gpu_instancing has no attribute that says how many copies "
                             "there are; it is drawn once\n"));
}

TEST_CASE("an animation of a scene without one is refused, whatever it is called") {
  const ScratchFolder folder;
  folder.write("t.gltf", triangle(""));
  for (const std::string name : {"0", "5", "all", "walk"}) {
    for (const std::string scene : {"t.gltf", "builtin:cubes"})
      require_refused(run_quadrille(folder, {"render", scene, "--animation", name}),
                      {scene, fmt::format("animation '{}' does not exist; animations: none", name)});
  }
}

TEST_CASE("exposure is a factor or auto, which says what it chose") {
  const std::string sun =
      R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional","intensity":2000}]}})";
  const std::string file = triangle("", R"(,"extensions":{"KHR_lights_punctual":{"light":0}})", sun);
  CHECK(said(file, {"--exposure", "auto"}) == "t.gltf: exposure 0.0012\n");
  CHECK(said(file, {"--exposure", "0.0012"}).empty());
  for (const std::string factor : {"0", "-1", "bright", "", "nan", "inf", "1e13", "AUTO"})
    refused({"render", "builtin:triangle", "--exposure", factor}, {"--exposure", "auto", "1e-12"});
}

TEST_CASE("exposure brings a file that is lit by the sun out of the white") {
  const std::string sun =
      R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional","intensity":2000,"color":[1,0.5,0.25]}]}})";
  const ScratchFolder folder;
  folder.write("t.gltf", triangle("", R"(,"extensions":{"KHR_lights_punctual":{"light":0}})", sun));
  const auto picture = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"render",     "t.gltf",     "--size", "32x32",
                                       "--fidelity", "functional", "--out",  name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    CHECK(run_quadrille(folder, arguments).exit_code == 0);
    return folder.read(name);
  };
  const std::string burnt = picture("a.png", {}), same = picture("b.png", {"--exposure", "1"}),
                    good = picture("c.png", {"--exposure", "auto"});
  CHECK(burnt == same);
  CHECK(burnt != good);
}
