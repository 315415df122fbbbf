#include "scenes/gltf_loader.h"
#include "scenes/scene.h"

#include <catch2/catch.hpp>

#include "models/base/error.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

SceneData load(const std::string& text) {
  const TempGltf file(text);
  return load_gltf(file.path());
}

const std::string kIndices = R"(,"indices":1)";

/// The triangle with an index buffer of one byte each.
std::string indexed(std::vector<std::uint8_t> indices) {
  std::string text = triangle_gltf(kIndices);
  const std::string count = std::to_string(indices.size());
  const auto put = [&](const std::string& before, const std::string& what) { text.insert(text.find(before) + before.size(), what); };
  put(R"("max":[1,1,0]})", R"(,{"bufferView":1,"componentType":5121,"count":)" + count + R"(,"type":"SCALAR"})");
  put(R"("byteLength":36})", R"(,{"buffer":1,"byteLength":)" + count + "}");
  put(R"("buffers":[)", "");
  text.insert(text.rfind("]}"), R"(,{"byteLength":)" + count + R"(,"uri":")" + data_uri_of(indices) + "\"}");
  return text;
}

}  // namespace

TEST_CASE("gltf: one triangle becomes one instance of one primitive") {
  const SceneData scene = load(triangle_gltf("", "", R"(,"translation":[1,2,3],"scale":[2,2,2])"));
  REQUIRE(scene.instances.size() == 1);
  REQUIRE(scene.primitives.size() == 1);
  REQUIRE(scene.materials.size() == 1);
  REQUIRE(scene.bounds().low == glm::vec3(1, 2, 3));
  REQUIRE(scene.bounds().high == glm::vec3(3, 4, 3));
}

TEST_CASE("gltf: indices of one byte stay bytes, and one that is too large is named") {
  const SceneData scene = load(indexed({0, 1, 2, 2, 1, 0}));
  REQUIRE(scene.primitives[0].index_type == traces::IndexType::kUint8);
  REQUIRE(scene.primitives[0].count == 6);
  REQUIRE_THAT(load_result(indexed({0, 1, 3})), Contains("meshes[0].primitives[0].indices: accessor 1: index 3 is beyond 3 vertices"));
}

TEST_CASE("gltf: points and lines are refused by name") {
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"mode":0)")), Contains("meshes[0].primitives[0]: primitive mode POINTS is not supported"));
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"mode":3)")), Contains("LINE_STRIP is not supported"));
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"mode":9)")), Contains("mode 9 is not one of glTF's"));
  REQUIRE(load(triangle_gltf(R"(,"mode":6)")).primitives[0].topology == traces::Topology::kTriangleFan);
}

TEST_CASE("gltf: a required extension that is lacking is named") {
  REQUIRE_THAT(load_result(triangle_gltf("", R"(,"extensionsRequired":["KHR_texture_transform","KHR_texture_basisu","X_y"])")),
               Contains("extensionsRequired: KHR_texture_basisu, X_y not supported; supported are EXT_mesh_gpu_instancing, "));
  REQUIRE(load_result(triangle_gltf("", R"(,"extensionsRequired":["KHR_materials_unlit"])")) == "loaded");
  REQUIRE_THAT(load_result(triangle_gltf("", R"(,"extensionsRequired":[""])")), Contains("extensionsRequired: '' not supported"));
}

TEST_CASE("gltf: loops and shared children are not trees, numbers of things that do not exist are named") {
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"children":[0])")), Contains("nodes[0]: it is reached twice"));
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"children":[7])")), Contains("node 7 does not exist"));
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"camera":2)")), Contains("nodes[0].camera: camera 2 does not exist (the file has 0)"));
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"material":4)")), Contains("material 4 does not exist"));
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"extensions":{"KHR_lights_punctual":{"light":3}})")),
               Contains("nodes[0].extensions.KHR_lights_punctual.light: light 3 does not exist (the file has 0)"));
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"material":0)", R"(,"materials":[{"normalTexture":{"index":5}}])")),
               Contains("materials[0].normalTexture.index: texture 5 does not exist"));
}

TEST_CASE("gltf: a deep tree of nodes and deeply nested JSON neither overflow the stack") {
  std::string nodes = R"({"mesh":0,"children":[1]})";
  for (int i = 1; i < 50000; ++i) nodes += i == 49999 ? ",{}" : R"(,{"children":[)" + std::to_string(i + 1) + "]}";
  std::string text = triangle_gltf();
  text.replace(text.find(R"({"mesh":0})"), 10, nodes);
  REQUIRE(load_result(text) == "loaded");
  const std::string deep(100000, '[');
  REQUIRE_THAT(load_result(triangle_gltf("", R"(,"extras":)" + deep)), Contains("nested deeper than"));
}

TEST_CASE("gltf: a node that mirrors is seen by its determinant") {
  const SceneData scene = load(triangle_gltf("", "", R"(,"scale":[-1,1,1])"));
  REQUIRE(glm::determinant(glm::mat3(scene.instances[0].world)) < 0);
}

TEST_CASE("gltf: lights take place, direction and colour from node and extension") {
  const SceneData scene = load(
      triangle_gltf("", R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,0.5,0],"intensity":8,"range":4}]}})",
                    R"(,"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}})"));
  REQUIRE(scene.lights.size() == 1);
  REQUIRE(scene.lights[0].kind == Light::Kind::kPoint);
  REQUIRE(scene.lights[0].position == glm::dvec3(1, 2, 3));
  REQUIRE(scene.lights[0].color == glm::vec3(8, 4, 0));
  REQUIRE(scene.lights[0].direction == glm::vec3(0, 0, -1));
}

TEST_CASE("gltf: a material's factors, modes and unlit extension are read, wrong ones are named") {
  const std::string use = R"(,"material":0)";
  const Material m =
      load(triangle_gltf(use,
                         R"(,"materials":[{"alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,"extensions":{"KHR_materials_unlit":{}},
    "emissiveFactor":[0,1,0],"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1],"metallicFactor":0.5,"roughnessFactor":0.75}}])"))
          .materials[0];
  REQUIRE(m.alpha == AlphaMode::kMask);
  REQUIRE(m.alpha_cutoff == 0.25F);
  REQUIRE(m.double_sided);
  REQUIRE(m.unlit);
  REQUIRE(m.base_color == glm::vec4(1, 0.5F, 0.25F, 1));
  REQUIRE(m.metallic == 0.5F);
  REQUIRE(m.roughness == 0.75F);
  REQUIRE_THAT(load_result(triangle_gltf(use, R"(,"materials":[{"alphaMode":"GLASS"}])")), Contains("materials[0].alphaMode: 'GLASS'"));
  REQUIRE_THAT(load_result(triangle_gltf(use, R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":3}}])")),
               Contains("materials[0].metallicFactor: 3 is outside 0..1"));
}

TEST_CASE("gltf: what is no glTF is the user's error") {
  REQUIRE_THAT(load_result(""), Contains("t.gltf: "));
  REQUIRE_THAT(load_result("not json at all"), Contains("t.gltf: "));
  REQUIRE_THAT(load_result("[]"), Contains("t.gltf: "));
  REQUIRE_THAT(load_result("glTF"), Contains("t.gltf: "));
  REQUIRE_THAT(load_result(R"({"asset":{"version":"1.0"}})"), Contains("asset.version '1.0'"));
  REQUIRE_THROWS_AS(load_gltf("/nonexistent/x.gltf"), UserError);
}

TEST_CASE("gltf: a camera of pi and more may be in a file, only a picture through it is refused") {
  const auto drawn = [](const std::string& node, const SceneOptions& options) {
    const TempGltf file(triangle_gltf("", R"(,"cameras":[{"type":"perspective","perspective":{"yfov":4,"znear":0.1}}])", node));
    try {
      (void)load_scene(file.path(), options);
    } catch (const UserError& error) { return std::string(error.what()); }
    return std::string("drawn");
  };
  SceneOptions options;
  options.width = options.height = 16;
  REQUIRE(drawn("", options) == "drawn");
  REQUIRE_THAT(drawn(R"(,"camera":0)", options), Contains("cameras[0]: yfov 4 is outside 0..pi"));
  options.eye = glm::vec3(0, 0, 5);
  REQUIRE(drawn(R"(,"camera":0)", options) == "drawn");
}

TEST_CASE("gltf: a node that is not visible hides meshes and lights of itself and below, not cameras") {
  const auto nodes = [](const std::string& first, const std::string& second) {
    return load(triangle_gltf(
        "",
        R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"extensionsRequired":["KHR_node_visibility"],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})",
        R"(,"children":[1],"extensions":{"KHR_node_visibility":)" + first +
            R"(}},{"mesh":0,"camera":0,"extensions":{"KHR_lights_punctual":{"light":0},"KHR_node_visibility":)" + second + "}"));
  };
  for (const std::string shown : {"{}", R"({"visible":true})"}) {
    const SceneData all = nodes(shown, shown);
    REQUIRE(all.instances.size() == 2);
    REQUIRE(all.lights.size() == 1);
    const SceneData first = nodes(shown, R"({"visible":false})");
    REQUIRE(first.instances.size() == 1);
    REQUIRE(first.lights.empty());
    REQUIRE(first.cameras[0].pose.has_value());
    const SceneData none = nodes(R"({"visible":false})", shown);
    REQUIRE(none.instances.empty());
    REQUIRE(none.lights.empty());
    REQUIRE(none.cameras[0].pose.has_value());
  }
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"extensions":{"KHR_node_visibility":{"visible":0}})")),
               Contains("nodes[0].extensions.KHR_node_visibility.visible: true or false is due"));
}
