/// Instanced draws: one command for all copies, and the same streams as the copies one by one would have.
#include "scenes/gltf/instancing.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstring>

#include <glm/ext/matrix_transform.hpp>

#include "scenes/gltf/loader.h"
#include "scenes/material/shader_sources.h"
#include "scenes/record/recorder.h"
#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"
#include "traces/trace_file.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

/// The triangle with an extension of these streams (each a name, a type, and floats).
struct Stream {
  const char *name, *type;
  std::vector<float> values;
};

std::string instanced(const std::vector<Stream>& streams, const std::string& material = "") {
  std::string accessors, views, buffers, attributes;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const Stream& s = streams[i];
    const std::size_t components = std::string(s.type) == "VEC4" ? 4 : 3;
    accessors += fmt::format(R"(,{{"bufferView":{},"componentType":5126,"count":{},"type":"{}"}})", i + 1,
                             s.values.size() / components, s.type);
    views += fmt::format(R"(,{{"buffer":{},"byteLength":{}}})", i + 1, 4 * s.values.size());
    buffers += fmt::format(R"(,{{"byteLength":{},"uri":"{}"}})", 4 * s.values.size(), data_uri_of(s.values));
    attributes += fmt::format(R"({}"{}":{})", i == 0 ? "" : ",", s.name, i + 1);
  }
  std::string text =
      triangle_gltf(material.empty() ? "" : R"(,"material":0)", material,
                    R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" + attributes + "}}}");
  const auto put = [&](const std::string& before, const std::string& what) {
    text.insert(text.find(before) + before.size(), what);
  };
  put(R"("max":[1,1,0]})", accessors);
  put(R"("byteLength":36})", views);
  text.insert(text.find(']', text.find(R"("buffers":[)")), buffers);
  return text;
}

SceneData load(const std::string& text) {
  const TempGltf file(text);
  return load_gltf(file.path());
}

const Stream kThree{"TRANSLATION", "VEC3", {0, 0, 0, 2, 0, 0, 0, 3, 0}};

}  // namespace

TEST_CASE("instancing: one draw for all copies, framed by all of them") {
  const SceneData scene = load(instanced({kThree, {"_COLOR_0", "VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1}}}));
  REQUIRE(scene.instances.size() == 1);
  REQUIRE(scene.copies.size() == 1);
  REQUIRE(scene.bounds().low == glm::vec3(0));
  REQUIRE(scene.bounds().high == glm::vec3(3, 4, 0));
  const traces::CommandStream stream = Recorder(scene, {}).record();
  traces::validate(stream);
  const traces::StreamTotals totals = traces::stream_totals(stream);
  REQUIRE(totals.draws == 1);
  REQUIRE(totals.triangles == 3);
}

TEST_CASE("instancing: copies that mirror are a draw of their own, with the other front face") {
  const SceneData scene = load(instanced({kThree, {"SCALE", "VEC3", {1, 1, 1, -1, 1, 1, 2, 2, 2}}}));
  REQUIRE(scene.instances.size() == 2);
  REQUIRE(scene.copies[0].size() == 2);
  REQUIRE(scene.copies[1].size() == 1);
  const traces::CommandStream stream = Recorder(scene, {}).record();
  REQUIRE(stream.pipelines.size() == 2);
  REQUIRE(stream.pipelines[0].front != stream.pipelines[1].front);
}

TEST_CASE("instancing: matrices are scale, then rotation, then translation, under the node's own") {
  const float half = 0.70710678F;
  std::string text = instanced({{"TRANSLATION", "VEC3", {1, 2, 3}},
                                {"ROTATION", "VEC4", {0, 0, half, half}},
                                {"SCALE", "VEC3", {2, 3, 4}}});
  text.insert(text.find(R"("mesh":0)"), R"("translation":[10,0,0],)");
  const glm::dmat4 m = load(text).copies[0][0];
  const glm::vec4 x = m * glm::dvec4(1, 0, 0, 1), y = m * glm::dvec4(0, 1, 0, 1);
  REQUIRE(glm::length(x - glm::vec4(11, 4, 3, 1)) < 1e-5F);
  REQUIRE(glm::length(y - glm::vec4(8, 2, 3, 1)) < 1e-5F);
}

TEST_CASE("instancing: blended copies are sorted from back to front, opaque ones keep their order") {
  for (const bool blended : {false, true}) {
    SceneData scene =
        load(instanced({{"TRANSLATION", "VEC3", {0, 0, 1, 0, 0, 5, 0, 0, 3}}}, R"(,"materials":[{}])"));
    if (blended) scene.materials[0].alpha = AlphaMode::kBlend;
    scene.cameras.resize(1);
    scene.cameras[0].pose = glm::translate(glm::mat4(1), glm::vec3(0, 0, 10));
    const traces::CommandStream stream = Recorder(scene, {}).record();
    const auto found = std::ranges::find_if(
        stream.buffers, [](const traces::Buffer& b) { return b.name.ends_with(" instances"); });
    REQUIRE(found != stream.buffers.end());
    std::vector<float> z;
    for (std::size_t i = 0; i < 3; ++i) {
      z.push_back(0);
      std::memcpy(&z.back(), &found->data[i * 96 + 44], 4);  // third row, last column
    }
    REQUIRE(z == (blended ? std::vector<float>{1, 3, 5} : std::vector<float>{1, 5, 3}));
  }
}

TEST_CASE(
    "instancing: in visibility mode each copy is a draw, so that its triangles have their own numbers") {
  const SceneData scene = load(instanced({kThree}));
  SceneOptions options;
  options.visibility = true;
  const traces::StreamTotals totals = traces::stream_totals(Recorder(scene, options).record());
  REQUIRE(totals.draws == 3);
  REQUIRE(totals.triangles == 3);
}

namespace {

/// A square that is posed by morphing along x, and drawn with each of these matrices.
SceneData posed_copies(const std::string& weight, std::vector<glm::dmat4> copies) {
  SceneData scene = load(morph_gltf(1, weight));
  scene.instances[0].copies = 0;
  scene.copies.push_back(std::move(copies));
  scene.cameras.resize(1);
  scene.cameras[0].pose = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 30));
  return scene;
}

/// What the host has posed, in the order of recording.
std::vector<std::vector<std::byte>> posed_buffers(const SceneData& scene, const SceneOptions& options,
                                                  const std::string& semantic) {
  std::vector<std::vector<std::byte>> found;
  for (const traces::Buffer& buffer : Recorder(scene, options).record().buffers) {
    if (buffer.name.ends_with(semantic + " posed")) found.push_back(buffer.data);
  }
  return found;
}

}  // namespace

TEST_CASE(
    "instancing: posed copies share one posed mesh, the same one in colours, in ids, and under a vertex "
    "shader of the user's") {
  SceneData scene =
      posed_copies("[0.3]", {glm::dmat4(1), glm::translate(glm::dmat4(1), glm::dvec3(2, 0, 0))});
  Instance mirrored = scene.instances[0];
  mirrored.copies = 1;
  scene.instances.push_back(mirrored);
  scene.copies.push_back({glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1))});
  const std::vector<std::vector<std::byte>> colors = posed_buffers(scene, {}, "POSITION");
  REQUIRE(colors.size() == 1);
  const TempGltf plain(std::string(kInterfaceGlsl) + std::string(kMaterialVert), "plain.vert");
  for (const bool visibility : {false, true}) {
    for (const std::string& shader : {std::string(), plain.path()}) {
      CAPTURE(visibility, shader);
      SceneOptions options;
      options.visibility = visibility;
      options.vertex_shader = shader;
      CHECK(posed_buffers(scene, options, "POSITION") == colors);
      CHECK(posed_buffers(scene, options, "NORMAL").size() <= 1);
      CHECK(traces::stream_totals(Recorder(scene, options).record()).triangles == 6);
    }
  }
}

TEST_CASE("instancing: blended copies are sorted by where their pose has put them") {
  // At rest the turned copy is nearer by one; posed, ten along its own x takes it ten back.
  const glm::dmat4 turned = glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 1)),
                                        1.5707963267948966, glm::dvec3(0, 1, 0));
  SceneData scene = posed_copies("[10]", {glm::dmat4(1), turned});
  for (Material& material : scene.materials) material.alpha = AlphaMode::kBlend;
  const traces::CommandStream stream = Recorder(scene, {}).record();
  const auto found = std::ranges::find_if(
      stream.buffers, [](const traces::Buffer& b) { return b.name.ends_with(" instances"); });
  REQUIRE(found != stream.buffers.end());
  float first = 0;
  std::memcpy(&first, &found->data[44], sizeof(first));  // of the first copy: third row, last column
  CHECK(first == 1);
}

TEST_CASE("instancing: a node with a skin is drawn once, where its joints place it") {
  ArmOptions options;
  options.node_of_mesh = R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}})";
  const SceneData scene = load(arm_gltf(options));
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].copies == -1);
  CHECK(scene.copies.empty());
}

TEST_CASE("instancing: attributes that only an application knows say how many copies there are, too") {
  const Stream ids{"_FEATURE_ID_0", "VEC3", {1, 2, 3, 4, 5, 6}};
  std::string text = instanced({ids});
  text.insert(text.find(R"("mesh":0)"), R"("translation":[10,0,0],)");
  const SceneData scene = load(text);
  REQUIRE(scene.copies.size() == 1);
  REQUIRE(scene.copies[0].size() == 2);
  for (const glm::dmat4& copy : scene.copies[0])
    CHECK(copy == glm::translate(glm::dmat4(1), glm::dvec3(10, 0, 0)));
  CHECK(load(instanced({ids, {"SCALE", "VEC3", {1, 1, 1, 2, 2, 2}}})).copies[0][1][0].x == 2);
  CHECK_THAT(load_result(instanced({kThree, ids})),
             Contains("attributes._FEATURE_ID_0: 2 elements where another attribute has 3"));
}

TEST_CASE("instancing: without any attribute the mesh is drawn once") {
  const SceneData scene = load(instanced({}));
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].copies == -1);
}

TEST_CASE(
    "instancing: unequal counts, other types and values that are not finite are refused with their place") {
  REQUIRE_THAT(
      load_result(instanced({kThree, {"SCALE", "VEC3", {1, 1, 1}}})),
      Contains(
          "nodes[0].EXT_mesh_gpu_instancing.attributes.SCALE: 1 elements where another attribute has 3"));
  REQUIRE_THAT(load_result(instanced({{"ROTATION", "VEC3", {1, 1, 1}}})),
               Contains("ROTATION: accessor 1 is not of 4 floats"));
  REQUIRE_THAT(load_result(instanced({{"ROTATION", "VEC4", {0, 0, 0, 0}}})),
               Contains("element 0 is not a quaternion"));
  REQUIRE_THAT(load_result(instanced({{"SCALE", "VEC3", {1, INFINITY, 1}}})),
               Contains("element 0 is not finite"));
  REQUIRE_THAT(load_result(instanced({{"SCALE", "VEC3", {1e38F, 1e38F, 1e38F}},
                                      {"TRANSLATION", "VEC3", {3e38F, 3e38F, 3e38F}}})),
               Catch::Equals("loaded"));
}

TEST_CASE("instancing: copies count once for each primitive of their mesh, over all nodes") {
  std::string text = instanced({{"TRANSLATION", "VEC3", std::vector<float>(3 * 1024, 0)}});
  const std::string one = R"({"attributes":{"POSITION":0}})";
  std::string more;
  for (int i = 1; i < 1024; ++i) more += "," + one;
  text.insert(text.find(one) + one.size(), more);
  REQUIRE(load_result(text) == "loaded");  // 2^20
  text.insert(text.find(one) + one.size(), "," + one);
  REQUIRE_THAT(load_result(text),
               Contains("nodes[0]: the scene has more than 1048576 instances of primitives"));
}
