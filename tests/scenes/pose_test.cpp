/// Skins, morph targets and moving nodes, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/ext/vector_double3.hpp>

#include "scenes/gltf/joint_streams.h"
#include "scenes/gltf/loader.h"
#include "scenes/record/host_pose.h"
#include "scenes/record/pose_streams.h"
#include "scenes/scene.h"
#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

constexpr double kQuarter = 1.5707963267948966;

/// The positions, or another attribute, of an instance as the host poses them, in the world.
std::vector<glm::vec3> posed(const SceneData& scene, std::size_t instance = 0,
                             Semantic semantic = Semantic::kPosition) {
  const Instance& i = scene.instances.at(instance);
  const Primitive& primitive = scene.primitives[i.primitive];
  const Pose& pose = scene.poses.at(static_cast<std::size_t>(i.pose));
  const auto arrays = pose_on_host(scene, primitive, pose, !pose.joints.empty());
  const Array& array = arrays[static_cast<std::size_t>(semantic)].value();
  std::vector<glm::vec3> values(array.count);
  for (std::size_t v = 0; v < values.size(); ++v) {
    std::memcpy(&values[v], &array.data[v * sizeof(glm::vec3)], sizeof(glm::vec3));
    if (semantic == Semantic::kPosition) values[v] = glm::vec3(i.world * glm::dvec4(values[v], 1));
  }
  return values;
}

void check_near(const glm::vec3& a, const glm::vec3& b) {
  for (int c = 0; c < 3; ++c) CHECK(a[c] == Approx(b[c]).margin(1e-6));
}

GltfScene opened(const std::string& text, const GltfChoice& choice = {"", true, ""}) {
  const TempGltf file(text);
  return {file.path(), choice};
}

/// Where the upper corners of the arm and its middle are when bone 1 has turned by `angle` around z.
void check_arm(const SceneData& scene, double angle) {
  const auto s = static_cast<float>(std::sin(angle)), c = static_cast<float>(std::cos(angle));
  const std::vector<glm::vec3> at = posed(scene);
  check_near(at[0], {-0.5F, 0, 0});
  check_near(at[4], {-0.5F * c - s, 1 - 0.5F * s + c, 0});
  check_near(at[5], {0.5F * c - s, 1 + 0.5F * s + c, 0});
  // The middle hangs half on each bone.
  check_near(at[2], {0.5F * (-0.5F - 0.5F * c), 0.5F * (1 + 1 - 0.5F * s), 0});
}

}  // namespace

TEST_CASE("pose: a two-bone arm bends as its joints turn, at the keys, between them and beyond") {
  GltfScene arm = opened(arm_gltf());
  CHECK(arm.length() == 1);
  for (const double time : {0.0, 0.25, 0.5, 1.0, 7.0}) {
    CAPTURE(time);
    arm.pose(time);
    check_arm(arm.data(), std::min(time, 1.0) * kQuarter);
  }
}

TEST_CASE("pose: joints of 16 bits, weights of 8 and 16 bits and a second set of four give the same arm") {
  for (const auto& [wide, bits, second] :
       {std::tuple{true, 32, false}, {false, 16, false}, {true, 8, false}, {false, 32, true}}) {
    CAPTURE(wide, bits, second);
    ArmOptions options;
    options.wide_joints = wide;
    options.weight_bits = bits;
    options.second_set = second;
    GltfScene arm = opened(arm_gltf(options));
    arm.pose(1);
    const std::vector<glm::vec3> at = posed(arm.data());
    // A half in 8 or 16 bits is a little less than a half; two of them are divided by their sum.
    check_near(at[4], {-1, 0.5F, 0});
    check_near(at[2], {-0.25F, 0.75F, 0});
  }
}

TEST_CASE(
    "pose: weights that do not sum to one are divided by their sum, in every format, over one set or two") {
  for (const int bits : {8, 16, 32}) {
    for (const bool second : {false, true}) {
      for (const float weight : {0.98F, 0.3F, 1e-3F, 0.0F}) {
        CAPTURE(bits, second, weight);
        if (bits == 8 && weight == 1e-3F) continue;  // which is none there
        ArmOptions options;
        options.weight_bits = bits;
        options.second_set = second;
        options.weight = weight;
        GltfScene arm = opened(arm_gltf(options));
        arm.pose(0.5);
        check_arm(arm.data(), 0.5 * kQuarter);
      }
    }
  }
  ArmOptions heavy;  // floats may be larger than one, up to the largest
  for (const float weight : {2.0F, 3e38F}) {
    heavy.weight = weight;
    GltfScene arm = opened(arm_gltf(heavy));
    arm.pose(0.5);
    check_arm(arm.data(), 0.5 * kQuarter);
  }
}

TEST_CASE("pose: weights that sum to one but for the rounding of their floats stay as they are") {
  Elements joints{Component::kUint8, 4, false, 2, std::vector<std::byte>(8)},
      weights{Component::kFloat, 4, false, 2, {}};
  const std::array<float, 8> values{0.1F, 0.2F, 0.3F, 0.4F, 0.25F, 0.25F, 0.25F, 0.2500002F};
  weights.data.resize(sizeof(values));
  std::memcpy(weights.data.data(), values.data(), sizeof(values));
  std::array<JointElements, 1> sets{JointElements{joints, weights}};
  CHECK(mend_weights(sets) == 0);
  CHECK(sets[0].weights.data == weights.data);
  const float off = 0.26F;
  std::memcpy(&sets[0].weights.data[28], &off, 4);
  CHECK(mend_weights(sets) == 1);
  const std::vector<std::byte> first(sets[0].weights.data.begin(), sets[0].weights.data.begin() + 16);
  CHECK(first == std::vector<std::byte>(weights.data.begin(), weights.data.begin() + 16));
  CHECK(mend_weights(sets) == 0);
}

TEST_CASE(
    "pose: without an animation the skin follows its bones at rest, and the node's own matrix counts for "
    "nothing") {
  ArmOptions options;
  options.node_of_mesh = R"(,"translation":[50,60,70],"scale":[3,3,3])";
  const TempGltf file(arm_gltf(options));
  const SceneData scene = load_gltf(file.path());
  check_arm(scene, 0);
}

TEST_CASE("pose: a skin far from the origin, or far from the size of one, keeps its precision") {
  for (const auto& [place, scale] : {std::pair{1e7, 1.0}, {0.0, 1e-6}, {0.0, 1e9}}) {
    CAPTURE(place, scale);
    std::string text = arm_gltf();
    const std::string lower = R"({"name":"lower")";
    text.insert(text.find(lower) + lower.size(),
                fmt::format(R"(,"translation":[{0},0,0],"scale":[{1},{1},{1}])", place, scale));
    GltfScene arm = opened(text);
    arm.pose(1);
    const Instance& instance = arm.data().instances[0];
    const Pose& pose = arm.data().poses[0];
    for (const JointMatrix& joint : pose.joints) {
      for (const glm::vec4& row : joint) CHECK(glm::length(row) < 4);
    }
    const auto arrays = pose_on_host(arm.data(), arm.data().primitives[0], pose, true);
    glm::vec3 corner;
    std::memcpy(&corner, &arrays[0].value().data[4 * sizeof(glm::vec3)], sizeof(corner));
    const glm::dvec3 world = glm::dvec3(corner) * instance.world[0].x + glm::dvec3(instance.world[3]);
    check_near(glm::vec3((world - glm::dvec3(place, 0, 0)) / scale), {-1, 0.5F, 0});
  }
}

TEST_CASE("pose: a skin faces as most of its joints do") {
  // of two joints, one is mirrored, or both are
  for (const auto& [bone, mirrored] : {std::pair{"upper", false}, {"lower", true}}) {
    std::string text = arm_gltf();
    const std::string name = fmt::format(R"({{"name":"{}")", bone);
    text.insert(text.find(name) + name.size(), R"(,"scale":[-1,1,1])");
    CHECK(opened(text).data().poses[0].mirrored == mirrored);
  }
}

TEST_CASE("pose: a skin's normals turn with its joints") {
  GltfScene arm = opened(arm_gltf());
  arm.pose(1);
  for (const glm::vec3& n : posed(arm.data(), 0, Semantic::kNormal)) check_near(n, {0, 0, 1});
}

TEST_CASE("pose: the box of a posed instance holds its posed vertices") {
  GltfScene arm = opened(arm_gltf());
  for (int i = 0; i <= 8; ++i) {
    arm.pose(i / 8.0);
    const Bounds box = arm.data().box(arm.data().instances[0]);
    for (const glm::vec3& p : posed(arm.data())) {
      for (int c = 0; c < 3; ++c) CHECK((p[c] >= box.low[c] - 1e-5F && p[c] <= box.high[c] + 1e-5F));
    }
  }
}

TEST_CASE("pose: a camera that frames an animated scene stands still, and one on a bone rides along") {
  GltfScene arm = opened(arm_gltf());
  arm.pose(0);
  const Bounds first = arm.data().bounds();
  const glm::dmat4 start = arm.data().cameras[0].pose.value();
  arm.pose(1);
  CHECK(arm.data().bounds().low == first.low);
  CHECK(arm.data().bounds().high == first.high);
  CHECK(first.low.x <= -1);
  check_near(glm::vec3(start[3]), {0, 1, 5});
  check_near(glm::vec3(arm.data().cameras[0].pose.value()[0]), {0, 1, 0});  // its right is now up
}

TEST_CASE("pose: a morph target of half weight moves half as far") {
  const TempGltf file(morph_gltf(2, "[0.5,0.25]"));
  const SceneData scene = load_gltf(file.path());
  check_near(posed(scene)[0], {0.5F, 0.25F, 0});
  check_near(posed(scene)[3], {1.5F, 1.25F, 0});
  check_near(posed(scene, 0, Semantic::kNormal)[0], {0.75F, 0, 1});
  const Bounds box = scene.box(scene.instances[0]);
  CHECK((box.high.x >= 1.5F && box.high.y >= 1.25F));
}

TEST_CASE("pose: animated weights replace the mesh's") {
  GltfScene square = opened(morph_gltf(3, "[0.5,0.5,0.5]"));
  square.pose(0);
  CHECK(square.data().instances[0].pose == -1);  // nothing is moved, so nothing is posed
  square.pose(0.5);
  check_near(posed(square.data())[0], {0.25F, 0.25F, 0.25F});
}

TEST_CASE("pose: only targets with weight become streams, and what does not fit is left to the host") {
  const std::array<bool, kSemantics> lit{true, true, false, false, false, false},
      flat{true, false, false, false, false, false};
  const TempGltf file(morph_gltf(11, "[1,1,1,1,1,0,0,0,0,0,0]"));
  const SceneData scene = load_gltf(file.path());
  Pose pose = scene.poses[0];
  PoseStreams plan = choose_pose_streams(scene.primitives[0], pose, lit, false);
  CHECK_FALSE(plan.morph_on_host);
  REQUIRE(plan.streams.size() == 10);
  CHECK(plan.streams.back().location == 15);
  CHECK(plan.block.size() == 32);  // five weights in two vectors
  pose.weights[7] = 0.1F;          // a sixth, with normals too, is too many
  CHECK(choose_pose_streams(scene.primitives[0], pose, lit, false).morph_on_host);
  CHECK_FALSE(choose_pose_streams(scene.primitives[0], pose, flat, false).morph_on_host);
  CHECK(choose_pose_streams(scene.primitives[0], pose, flat, true).streams.empty());
}

TEST_CASE("pose: a skin of more joints than a block holds is posed on the host") {
  const TempGltf file(arm_gltf());
  const SceneData scene = load_gltf(file.path());
  const std::array<bool, kSemantics> flat{true, false, false, false, false, false};
  Pose pose = scene.poses[0];
  CHECK(choose_pose_streams(scene.primitives[0], pose, flat, false).block.size() == 16 * 48);
  pose.joints.resize(kMaxShaderJoints);
  CHECK(choose_pose_streams(scene.primitives[0], pose, flat, false).block.size() == kMaxShaderJoints * 48);
  pose.joints.resize(kMaxShaderJoints + 1);
  const PoseStreams plan = choose_pose_streams(scene.primitives[0], pose, flat, false);
  CHECK((plan.skin_on_host && plan.block.empty() && plan.streams.empty()));
}

TEST_CASE("pose: channels of KHR_animation_pointer are left out, and the others play") {
  std::string text = arm_gltf();
  const std::string channels = R"("channels":[)";
  text.insert(
      text.find(channels) + channels.size(),
      R"({"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/nodes/2/scale"}}}},)");
  text.insert(text.rfind('}'), R"(,"extensionsUsed":["KHR_animation_pointer"])");
  GltfScene arm = opened(text);
  arm.pose(1);
  check_arm(arm.data(), kQuarter);
  text.insert(text.rfind('}'), R"(,"extensionsRequired":["KHR_animation_pointer"])");
  CHECK_THAT(animated_result(text), Contains("extensionsRequired: KHR_animation_pointer not supported"));
}

TEST_CASE(
    "pose: an animation and a scene are chosen by number or name, and a wrong choice lists what there is") {
  CHECK(load_result(arm_gltf(), {"", true, "bend"}) == "loaded");
  CHECK(load_result(arm_gltf(), {"", true, "all"}) == "loaded");
  CHECK_THAT(load_result(arm_gltf(), {"", true, "1"}),
             Contains("animation '1' does not exist; animations: 0 'bend'"));
  CHECK(opened(arm_gltf(), {"bones", false, ""}).data().instances.empty());
  CHECK(opened(arm_gltf(), {"0", false, ""}).data().instances.size() == 1);
  CHECK_THAT(load_result(arm_gltf(), {"legs", false, ""}),
             Contains("scene 'legs' does not exist; scenes: 0 'all', 1 'bones'"));
}

TEST_CASE("pose: primitives over the same joints have the same boxes") {
  constexpr std::size_t kVertices = 1000;
  GltfBuilder b;
  const int positions = b.accessor(std::vector<std::int8_t>(3 * kVertices, 1), "VEC3");
  const int joints = b.accessor(std::vector<std::uint8_t>(4 * kVertices, 1), "VEC4");
  const int weights = b.accessor(std::vector<std::uint8_t>(4 * kVertices, 64), "VEC4", true);
  const std::string one = fmt::format(R"({{"attributes":{{"POSITION":{},"JOINTS_0":{},"WEIGHTS_0":{}}}}})",
                                      positions, joints, weights);
  std::string all = one;
  for (int i = 1; i < 300; ++i) all += "," + one;
  const auto text = [&](const std::string& bones) {
    return b.text(
        R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0},{}],"extensionsUsed":["KHR_mesh_quantization"],)"
        R"("skins":[{"joints":)" +
        bones + R"(}],"meshes":[{"primitives":[)" + all + "]}]");
  };
  const TempGltf file(text("[1,1]"));
  const SceneData scene = load_gltf(file.path());
  REQUIRE(scene.primitives.size() == 300);
  for (const Primitive& p : scene.primitives) {
    REQUIRE(p.joint_boxes.size() == 2);
    REQUIRE(p.joint_boxes[0].empty());
    REQUIRE(p.joint_boxes[1].low == glm::vec3(1));
  }
  CHECK_THAT(load_result(text("[1]")), Contains("JOINTS name joint 1; skins[0] has 1 joints"));
}
