/// Skins, morph targets and animations that are wrong, or more than memory is meant for, are refused with
/// their place.
#include <catch2/catch.hpp>
#include <cmath>

#include <fmt/format.h>

#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

TEST_CASE("pose: malformed skins are refused with their place") {
  ArmOptions options;
  options.last_joint = 2;
  CHECK_THAT(animated_result(arm_gltf(options)),
             Contains("meshes[0].primitives[0]: JOINTS name joint 2; skins[0] has 2 joints"));
  options = {};
  options.inverse_binds = 1;
  CHECK_THAT(animated_result(arm_gltf(options)),
             Contains("skins[0].inverseBindMatrices: 1 matrices for 2 joints"));
  options = {};
  options.joints = "[1,9]";
  CHECK_THAT(animated_result(arm_gltf(options)),
             Contains("skins[0].joints[1]: node 9 does not exist (the file has 4)"));
  options.joints = "[]";
  CHECK_THAT(animated_result(arm_gltf(options)), Contains("skins[0].joints"));
  options = {};
  options.weight = -1;
  CHECK_THAT(animated_result(arm_gltf(options)), Contains("JOINTS_0: vertex 0 has the weight -1"));
  std::string text = arm_gltf();
  text.replace(text.find(R"("skin":0)"), 8, R"("skin":5)");
  CHECK_THAT(animated_result(text), Contains("nodes[0].skin: skin 5 does not exist (the file has 1)"));
  text = arm_gltf();
  text.replace(text.find("\"WEIGHTS_0\""), 11, "\"WEIGHTS_9\"");
  CHECK_THAT(animated_result(text), Contains("JOINTS_0 and WEIGHTS_0 come together"));
  text = arm_gltf();
  text.replace(text.find(R"("nodes":[0,1])"), 13, R"("nodes":[0])");
  CHECK_THAT(animated_result(text), Contains("skins[0].joints: node 1 is not in the scene that is drawn"));
}

TEST_CASE("pose: malformed animations are refused with their place, and only when they are played") {
  ArmOptions options;
  for (const auto& [times, words] :
       {std::pair{std::vector<float>{0, 0}, "input: key 1 at 0 s is not after the one before it"},
        {std::vector<float>{1, 0.5F}, "key 1 at 0.5 s is not after"},
        {std::vector<float>{0, std::nanf("")}, "key 1 is at nan s"},
        {std::vector<float>{-1, 0}, "key 0 is at -1 s"},
        {std::vector<float>{0, 1, 2}, "output: 2 elements where 3 keys take 3"}}) {
    options.key_times = times;
    CHECK_THAT(animated_result(arm_gltf(options)), Contains("animations[0].samplers[0]") && Contains(words));
  }
  CHECK(load_result(arm_gltf(options)) == "loaded");
  options = {};
  options.interpolation = "BOUNCE";
  CHECK_THAT(animated_result(arm_gltf(options)),
             Contains("interpolation 'BOUNCE' is not STEP, LINEAR or CUBICSPLINE"));
  options.interpolation = "CUBICSPLINE";
  CHECK_THAT(animated_result(arm_gltf(options)), Contains("output: 2 elements where 2 keys take 6"));
  std::string text = arm_gltf();
  text.replace(text.find(R"("path":"rotation")"), 17, R"("path":"weights")");
  CHECK_THAT(animated_result(text),
             Contains("animations[0].channels[0]: weights of node 2, which has no morph targets"));
  text = arm_gltf();
  text.replace(text.find(R"("path":"rotation")"), 17, R"("path":"colour")");
  CHECK_THAT(animated_result(text), Contains("path 'colour' is not translation, rotation, scale or weights"));
}

TEST_CASE("pose: a skin that is shown without end is refused before it takes all memory") {
  // A skin of 1000 joints, all the same node, on 5000 nodes.
  ArmOptions options;
  options.joints = "[1,2";
  for (int i = 2; i < 1000; ++i) options.joints += ",1";
  options.joints += "]";
  options.inverse_binds = 1000;
  std::string text = arm_gltf(options), nodes, roots;
  for (int i = 4; i < 5000; ++i) {
    nodes += R"(,{"mesh":0,"skin":0})";
    roots += "," + std::to_string(i);
  }
  const std::string first = R"("nodes":[0,1)", list = R"({"camera":0,"translation":[0,0,5]})";
  text.insert(text.find(first) + first.size(), roots);
  text.insert(text.find(list) + list.size(), nodes);
  CHECK_THAT(animated_result(text), Contains("poses more than 4194304 joints and weights"));
}

TEST_CASE("pose: morph targets that do not match their mesh are refused") {
  CHECK_THAT(animated_result(morph_gltf(2, "[1]")),
             Contains("nodes[0]: 1 weights for a mesh of 2 morph targets"));
  CHECK_THAT(animated_result(morph_gltf(1, "[1e39]")), Contains("weight is not finite"));
  std::string text = morph_gltf(1, "[1]");
  text.replace(text.find(R"("targets":[{"POSITION":4)"), 24, R"("targets":[{"POSITION":3)");
  CHECK_THAT(animated_result(text), Contains("meshes[0].primitives[0].targets[0].POSITION"));
}

TEST_CASE("pose: primitives that hang on more joints than memory is meant for are refused") {
  GltfBuilder b;
  const int positions = b.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int joints = b.accessor<std::uint16_t>({9999, 0, 0, 0, 9999, 0, 0, 0, 9999, 0, 0, 0}, "VEC4");
  const int weights = b.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const std::string one = fmt::format(R"({{"attributes":{{"POSITION":{},"JOINTS_0":{},"WEIGHTS_0":{}}}}})",
                                      positions, joints, weights);
  std::string all = one, bones = "1";
  for (int i = 1; i < 2000; ++i) all += "," + one;
  for (int i = 1; i < 10000; ++i) bones += ",1";
  CHECK_THAT(load_result(b.text(
                 R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0},{}],"skins":[{"joints":[)" +
                 bones + R"(]}],"meshes":[{"primitives":[)" + all + "]}]")),
             Contains("joints") && Contains("more than 4194304"));
}

TEST_CASE("pose: more morph targets of weight than can be added are refused before they are") {
  constexpr int kTargets = 10000;
  GltfBuilder b;
  const int positions = b.accessor(std::vector<std::int8_t>(3 * 40000, 1), "VEC3");
  std::string list, weights;
  for (int t = 0; t < kTargets; ++t) {
    list += fmt::format(R"({}{{"POSITION":{}}})", t == 0 ? "" : ",", positions);
    weights += t == 0 ? "1" : ",1";
  }
  const auto text = [&](const std::string& members) {
    return b.text(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{)" + members +
                  fmt::format(R"("primitives":[{{"attributes":{{"POSITION":{}}},"targets":[{}]}}]}}])",
                              positions, list));
  };
  CHECK(load_result(text("")) == "loaded");  // none has weight
  CHECK_THAT(load_result(text("\"weights\":[" + weights + "],")),
             Contains("nodes[0]: the scene's morph targets move more than 268435456 attributes of vertices"));
}
