#include "scenes/gltf/loader.h"
#include "scenes/scene.h"

#include <catch2/catch.hpp>

#include <cstring>

#include "models/base/error.h"
#include "tests/scenes/gltf_builder.h"
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
std::string indexed(const std::vector<std::uint8_t>& indices) {
  std::string text = triangle_gltf(kIndices);
  const std::string count = std::to_string(indices.size());
  const auto put = [&](const std::string& before, const std::string& what) {
    text.insert(text.find(before) + before.size(), what);
  };
  put(R"("max":[1,1,0]})",
      R"(,{"bufferView":1,"componentType":5121,"count":)" + count + R"(,"type":"SCALAR"})");
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
  REQUIRE_THAT(load_result(indexed({0, 1, 3})),
               Contains("meshes[0].primitives[0].indices: accessor 1: index 3 is beyond 3 vertices"));
}

TEST_CASE("gltf: all modes are read, and others refused") {
  using traces::Topology;
  const auto read = [](int mode) {
    return load(triangle_gltf(fmt::format(R"(,"mode":{})", mode))).primitives[0];
  };
  REQUIRE(read(0).topology == Topology::kPointList);
  REQUIRE(read(1).topology == Topology::kLineList);
  REQUIRE(read(2).topology == Topology::kLineStrip);
  REQUIRE(read(3).topology == Topology::kLineStrip);
  REQUIRE(read(4).topology == Topology::kTriangleList);
  REQUIRE(read(5).topology == Topology::kTriangleStrip);
  REQUIRE(read(6).topology == Topology::kTriangleFan);
  REQUIRE(read(3).count == 3);
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"mode":9)")), Contains("mode 9 is not one of glTF's"));
}

TEST_CASE("gltf: a loop is a strip that comes back to its first vertex") {
  const SceneData plain = load(triangle_gltf(R"(,"mode":2)"));
  REQUIRE(plain.primitives[0].count == 4);
  REQUIRE(plain.primitives[0].index_type == traces::IndexType::kUint32);
  const Array& counted = plain.arrays[static_cast<std::size_t>(plain.primitives[0].indices)];
  std::vector<std::uint32_t> indices(counted.count);
  std::memcpy(indices.data(), counted.data.data(), counted.data.size());
  REQUIRE(indices == std::vector<std::uint32_t>{0, 1, 2, 0});
}

TEST_CASE("gltf: a required extension that is lacking is named") {
  REQUIRE_THAT(load_result(triangle_gltf(
                   "", R"(,"extensionsRequired":["KHR_texture_transform","KHR_texture_basisu","X_y"])")),
               Contains("extensionsRequired: KHR_texture_basisu, X_y not supported; supported are "
                        "EXT_lights_image_based, EXT_mesh_gpu_instancing, "));
  REQUIRE(load_result(triangle_gltf("", R"(,"extensionsRequired":["KHR_materials_unlit"])")) == "loaded");
  REQUIRE_THAT(load_result(triangle_gltf("", R"(,"extensionsRequired":[""])")),
               Contains("extensionsRequired: '' not supported"));
}

TEST_CASE("gltf: loops and shared children are not trees, numbers of things that do not exist are named") {
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"children":[0])")),
               Contains("nodes[0]: it is reached twice"));
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"children":[7])")), Contains("node 7 does not exist"));
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"camera":2)")),
               Contains("nodes[0].camera: camera 2 does not exist (the file has 0)"));
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"material":4)")), Contains("material 4 does not exist"));
  REQUIRE_THAT(
      load_result(triangle_gltf("", "", R"(,"extensions":{"KHR_lights_punctual":{"light":3}})")),
      Contains("nodes[0].extensions.KHR_lights_punctual.light: light 3 does not exist (the file has 0)"));
  REQUIRE_THAT(
      load_result(triangle_gltf(R"(,"material":0)", R"(,"materials":[{"normalTexture":{"index":5}}])")),
      Contains("materials[0].normalTexture.index: texture 5 does not exist"));
}

TEST_CASE("gltf: a deep tree of nodes and deeply nested JSON neither overflow the stack") {
  std::string nodes = R"({"mesh":0,"children":[1]})";
  for (int i = 1; i < 50000; ++i)
    nodes += i == 49999 ? ",{}" : R"(,{"children":[)" + std::to_string(i + 1) + "]}";
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
  const SceneData scene = load(triangle_gltf(
      "",
      R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,0.5,0],"intensity":8,"range":4}]}})",
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
      load(
          triangle_gltf(
              use,
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
  REQUIRE_THAT(load_result(triangle_gltf(use, R"(,"materials":[{"alphaMode":"GLASS"}])")),
               Contains("materials[0].alphaMode: 'GLASS'"));
  REQUIRE_THAT(
      load_result(triangle_gltf(use, R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":3}}])")),
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
    const TempGltf file(triangle_gltf(
        "", R"(,"cameras":[{"type":"perspective","perspective":{"yfov":4,"znear":0.1}}])", node));
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
            R"(}},{"mesh":0,"camera":0,"extensions":{"KHR_lights_punctual":{"light":0},"KHR_node_visibility":)" +
            second + "}"));
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

TEST_CASE("gltf: members that are null count as absent, whatever they are") {
  for (const char* member : {R"("material":null)", R"("indices":null)", R"("mode":null)", R"("targets":null)",
                             R"("extensions":null)", R"("extensions":{"KHR_materials_variants":null})"}) {
    CAPTURE(member);
    CHECK(load_result(triangle_gltf(std::string(",") + member)) == "loaded");
  }
  for (const char* table :
       {R"("cameras":null)", R"("images":null)", R"("animations":null)", R"("extensionsRequired":null)",
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","range":null,"color":null}]}})"})
    CHECK(load_result(triangle_gltf("", std::string(",") + table)) == "loaded");
  CHECK(load_result(triangle_gltf("", "", R"(,"rotation":null,"camera":null,"children":null)")) == "loaded");
  // What may not be missing may not be null, and an element of an array is no member.
  CHECK_THAT(load_result(R"({"asset":null})"), Contains("asset: is missing; an object is due"));
  CHECK_THAT(load_result(triangle_gltf("", "", R"(,"children":[null])")),
             Contains("nodes[0].children[0]: an integer of 0 or more is due"));
}

namespace {

/// The triangle with these normals or tangents, as they lie in the file.
template <class T>
SceneData with_stream(const char* semantic, const std::vector<T>& values, const std::string& type,
                      bool normalized) {
  GltfBuilder b;
  const int positions = b.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normals = b.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int stream = b.accessor(values, type, normalized);
  const std::string more = std::string(semantic) == "NORMAL" ? "" : fmt::format(R"(,"NORMAL":{})", normals);
  const TempGltf file(b.text(fmt::format(
      R"("scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{},"{}":{}{}}}}}]}}])",
      positions, semantic, stream, more)));
  return load_gltf(file.path());
}

}  // namespace

TEST_CASE("gltf: normals without a direction are those of their faces, in every format") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  CHECK_FALSE(
      with_stream<float>("NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", false).primitives[0].partial_normals);
  for (const float bad : {0.0F, -0.0F, nan, inf}) {
    const SceneData scene = with_stream<float>("NORMAL", {0, 0, 1, bad, bad, bad, 0, 0, 1}, "VEC3", false);
    REQUIRE(scene.primitives[0].partial_normals);
    const Array& normals = scene.arrays[static_cast<std::size_t>(scene.primitives[0].attributes[1])];
    for (std::size_t c = 3; c < 6; ++c) CHECK(normals.data[4 * c] == std::byte{0});
  }
  CHECK(with_stream<std::int8_t>("NORMAL", {0, 0, 127, 0, 0, 0, 0, 0, 127}, "VEC3", true)
            .primitives[0]
            .partial_normals);
  CHECK(with_stream<std::int16_t>("NORMAL", {0, 0, 127, 0, 0, 0, 0, 0, 127}, "VEC3", true)
            .primitives[0]
            .partial_normals);
  CHECK_FALSE(with_stream<std::int16_t>("NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", true)
                  .primitives[0]
                  .partial_normals);
}

TEST_CASE("gltf: normals too short or too long for their squares keep their direction") {
  const SceneData scene =
      with_stream<float>("NORMAL", {0, 0, 1e-30F, 0, 3e30F, 4e30F, 0, 0, 2}, "VEC3", false);
  CHECK_FALSE(scene.primitives[0].partial_normals);
  const Array& normals = scene.arrays[static_cast<std::size_t>(scene.primitives[0].attributes[1])];
  std::array<float, 9> n{};
  std::memcpy(n.data(), normals.data.data(), sizeof(n));
  const std::array<float, 9> wanted{0, 0, 1, 0, 0.6F, 0.8F, 0, 0, 2};
  for (std::size_t i = 0; i < n.size(); ++i) CHECK(n[i] == Approx(wanted[i]));
}

TEST_CASE("gltf: tangents without a direction or a side give way to those that texture coordinates span") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto tangent = [](const SceneData& scene) { return scene.primitives[0].attributes[2]; };
  CHECK(tangent(with_stream<float>("TANGENT", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4", false)) >= 0);
  CHECK(tangent(with_stream<float>("TANGENT", {1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1}, "VEC4", false)) == -1);
  CHECK(tangent(with_stream<float>("TANGENT", {1, 0, 0, 1, nan, 0, 0, 1, 1, 0, 0, 1}, "VEC4", false)) == -1);
  CHECK(tangent(with_stream<float>("TANGENT", {1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1}, "VEC4", false)) == -1);
  CHECK(tangent(with_stream<std::int8_t>("TANGENT", {127, 0, 0, 127, 0, 0, 0, 127, 127, 0, 0, 127}, "VEC4",
                                         true)) == -1);
}
