/// Tangents that a file lacks: which primitives get them, what becomes of vertices that need several, and how
/// near they come to those that exporters wrote.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "scenes/data/vertex_values.h"
#include "scenes/gltf/loader.h"
#include "scenes/gltf/tangents.h"
#include "scenes/scene.h"
#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/scene_folder.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

/// Vertices stand in columns of two.
float column(std::uint32_t vertex) {
  const std::uint32_t number = vertex / 2;
  return static_cast<float>(number);
}

constexpr std::size_t at(Semantic semantic) { return static_cast<std::size_t>(semantic); }

const char* const kImage =
    R"("images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}],"textures":[{"source":0}])";
const char* const kMapped = R"("materials":[{"normalTexture":{"index":0}}])";

/// Three quads in a row along x, of eight shared vertices. The coordinates of the last one are mirrored, so
/// that the two vertices before it need two tangents each.
struct Strip {
  std::string attributes = R"("NORMAL":1,"TEXCOORD_0":2,"COLOR_0":4)";
  std::string primitive = R"("indices":3)";
  std::string mesh = "", node = "", more = "";
  std::string materials = kMapped;
};

SceneData loaded(const Strip& strip, const GltfChoice& choice = {}) {
  GltfBuilder b;
  std::vector<float> positions, normals, uvs, colors, moved, turned, weights;
  std::vector<std::uint8_t> joints;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 2; ++j) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      positions.insert(positions.end(), {x, y, 0});
      normals.insert(normals.end(), {0, 0, 1});
      uvs.insert(uvs.end(), {i < 3 ? x : 1, 1 - y});
      colors.insert(colors.end(), {x / 4, y / 2, 0});
      moved.insert(moved.end(), {0, 0, x});  // folds the strip up by 45 degrees
      turned.insert(turned.end(), {-1, 0, 0});
      joints.insert(joints.end(), {static_cast<std::uint8_t>(i), 0, 0, 0});
      weights.insert(weights.end(), {1, 0, 0, 0});
    }
  }
  b.accessor(positions, "VEC3");
  b.accessor(normals, "VEC3");
  b.accessor(uvs, "VEC2");
  b.accessor<std::uint8_t>({0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5, 4, 6, 5, 5, 6, 7}, "SCALAR");
  b.accessor(colors, "VEC3");
  b.accessor(moved, "VEC3");
  b.accessor(turned, "VEC3");
  b.accessor(joints, "VEC4");
  b.accessor(weights, "VEC4");
  const TempGltf file(b.text(fmt::format(
      R"("scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,{}}},"material":0,{}}}]{}}}],{},{}{})",
      strip.node, strip.attributes, strip.primitive, strip.mesh, strip.materials, kImage, strip.more)));
  return std::move(GltfScene(file.path(), choice).data());
}

const Array& stream(const SceneData& scene, Semantic semantic) {
  return scene.arrays[static_cast<std::size_t>(scene.primitives[0].attributes[at(semantic)])];
}

glm::vec4 vertex_of(const Array& array, std::uint32_t vertex) {
  const auto v = values_at(array, vertex);
  return {glm::dvec4(v[0], v[1], v[2], v[3])};
}

bool has_tangents(const SceneData& scene) {
  return scene.primitives[0].attributes[at(Semantic::kTangent)] >= 0;
}

}  // namespace

TEST_CASE("gltf tangents: a vertex with two becomes two, in all streams and in the indices") {
  const SceneData scene = loaded({});
  const Primitive& primitive = scene.primitives[0];
  REQUIRE(has_tangents(scene));
  CHECK(primitive.topology == traces::Topology::kTriangleList);
  CHECK(primitive.index_type == traces::IndexType::kUint8);
  CHECK(primitive.count == 18);
  const Corners corners = corners_of(scene, primitive);
  for (const Semantic semantic :
       {Semantic::kPosition, Semantic::kNormal, Semantic::kTangent, Semantic::kUv0, Semantic::kColor})
    CHECK(stream(scene, semantic).count == 10);
  const std::vector<std::uint32_t> before{0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5, 4, 6, 5, 5, 6, 7};
  for (std::size_t c = 0; c < before.size(); ++c) {
    const auto x = column(before[c]), y = static_cast<float>(before[c] % 2);
    CHECK(vertex_of(stream(scene, Semantic::kPosition), corners.vertices[c]) == glm::vec4(x, y, 0, 1));
    CHECK(vertex_of(stream(scene, Semantic::kColor), corners.vertices[c]) == glm::vec4(x / 4, y / 2, 0, 1));
    const float side = c < 12 ? 1.0F : -1.0F;
    CHECK(vertex_of(stream(scene, Semantic::kTangent), corners.vertices[c]) == glm::vec4(side, 0, 0, side));
  }
}

TEST_CASE("gltf tangents: only what a normal map needs gets them") {
  const auto with = [](const std::string& materials) { return loaded({.materials = materials}); };
  CHECK_FALSE(has_tangents(with(R"("materials":[{}])")));
  CHECK_FALSE(has_tangents(with(R"("materials":[{"normalTexture":{"index":0,"texCoord":1}}])")));
  CHECK_FALSE(has_tangents(
      with(R"("materials":[{"normalTexture":{"index":0},"extensions":{"KHR_materials_unlit":{}}}])")));
  CHECK(has_tangents(with(
      R"("materials":[{"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0}}}}])")));
  CHECK_FALSE(has_tangents(with(
      R"("materials":[{"extensions":{"KHR_materials_clearcoat":{"clearcoatNormalTexture":{"index":0}}}}])")));
  // two maps at different coordinates would need two sets
  CHECK_FALSE(has_tangents(with(
      R"("materials":[{"normalTexture":{"index":0},"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,)"
      R"("clearcoatNormalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"rotation":1}}}}}}])")));
  CHECK_FALSE(has_tangents(loaded({.attributes = R"("TEXCOORD_0":2)"})));
  CHECK_FALSE(has_tangents(loaded({.primitive = R"("indices":3,"mode":1)"})));
  GltfChoice choice;
  choice.tangents = false;
  CHECK_FALSE(has_tangents(loaded({}, choice)));
  CHECK(stream(loaded({}, choice), Semantic::kPosition).count == 8);
}

TEST_CASE("gltf tangents: a texture transform turns them with the map") {
  // rotation by a quarter: u' = v, v' = -u (KHR_texture_transform), so u' grows downward
  const SceneData scene = loaded(
      {.materials =
           R"("materials":[{"normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"rotation":1.5707963267948966}}}}])"});
  const glm::vec4 tangent = vertex_of(stream(scene, Semantic::kTangent), 0);
  CHECK(tangent.y == Approx(-1));
  CHECK(tangent.w == 1);
}

TEST_CASE("gltf tangents: strips stay strips unless a vertex needs two, and need no indices") {
  // vertices 0..7 as a strip, without indices: the seam splits it
  const SceneData split = loaded({.primitive = R"("mode":5)"});
  CHECK(split.primitives[0].topology == traces::Topology::kTriangleList);
  CHECK(split.primitives[0].count == 18);
  CHECK(split.primitives[0].index_type == traces::IndexType::kUint16);
  CHECK(stream(split, Semantic::kPosition).count == 10);
  // scaled to nothing, the coordinates tell no vertex's tangents apart
  const SceneData whole = loaded(
      {.primitive = R"("mode":5)",
       .materials =
           R"("materials":[{"normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[0,0]}}}}])"});
  CHECK(whole.primitives[0].topology == traces::Topology::kTriangleStrip);
  CHECK(whole.primitives[0].indices == -1);
  CHECK(vertex_of(stream(whole, Semantic::kTangent), 3) == glm::vec4(1, 0, 0, 1));
}

TEST_CASE("gltf tangents: morph targets follow the split, and bend the tangents with the surface") {
  const SceneData scene = loaded(
      {.primitive = R"("indices":3,"targets":[{"POSITION":5,"NORMAL":6}])", .mesh = R"(,"weights":[1])"});
  const MorphTarget& target = scene.primitives[0].targets[0];
  const auto delta = [&](Semantic semantic) -> const Array& {
    return scene.arrays[static_cast<std::size_t>(target.deltas[at(semantic)])];
  };
  REQUIRE(target.deltas[at(Semantic::kTangent)] >= 0);
  for (std::uint32_t v = 0; v < 10; ++v) {
    const float x = vertex_of(stream(scene, Semantic::kPosition), v).x;
    CHECK(vertex_of(delta(Semantic::kPosition), v).z == x);
    CHECK(vertex_of(delta(Semantic::kNormal), v).x == -1);
    const glm::vec3 moved = glm::vec3(vertex_of(stream(scene, Semantic::kTangent), v)) +
                            glm::vec3(vertex_of(delta(Semantic::kTangent), v));
    const float side = vertex_of(stream(scene, Semantic::kTangent), v).w;
    CHECK(moved.x == Approx(side * std::sqrt(0.5)));
    CHECK(moved.z == Approx(side * std::sqrt(0.5)));
  }
}

TEST_CASE("gltf tangents: joints and weights follow the split") {
  const SceneData scene = loaded({.attributes = R"("NORMAL":1,"TEXCOORD_0":2,"JOINTS_0":7,"WEIGHTS_0":8)",
                                  .node = R"(,"skin":0)",
                                  .more = R"(,"skins":[{"joints":[0,0,0,0]}])"});
  const JointSet& set = scene.primitives[0].joint_sets[0];
  const Array& joints = scene.arrays[static_cast<std::size_t>(set.joints)];
  REQUIRE(joints.count == 10);
  REQUIRE(scene.arrays[static_cast<std::size_t>(set.weights)].count == 10);
  for (std::uint32_t v = 0; v < 10; ++v)
    CHECK(words_at(joints, v)[0] ==
          static_cast<std::uint32_t>(vertex_of(stream(scene, Semantic::kPosition), v).x));
}

TEST_CASE("gltf tangents: a frame reads them, and a shading without normal maps has the file's vertices") {
  GltfBuilder b;
  b.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  b.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  b.accessor<float>({0, 1, 1, 1, 0, 0, 1, 0}, "VEC2");
  const TempGltf file(b.text(fmt::format(
      R"("scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"material":0,"mode":5}}]}}],{},{})",
      kMapped, kImage)));
  const auto reads_tangents = [&](Shading shading) {
    SceneOptions options;
    options.shading = shading;
    const traces::CommandStream stream = load_scene(file.path(), options);
    return std::ranges::any_of(stream.buffers,
                               [](const traces::Buffer& buffer) { return buffer.name == "TANGENT"; });
  };
  CHECK(reads_tangents(Shading::kPbr));
  CHECK_FALSE(reads_tangents(Shading::kFlat));
  CHECK_FALSE(reads_tangents(Shading::kMinimal));
}

TEST_CASE("gltf tangents: primitives of one pool of vertices keep what they share, and take what they name") {
  // Two primitives name half of the vertices each or less; a third one names all, and needs no tangents.
  GltfBuilder b;
  std::vector<float> positions, normals, uvs;
  for (int i = 0; i < 8; ++i) {
    positions.insert(positions.end(), {column(static_cast<std::uint32_t>(i)), static_cast<float>(i % 2), 0});
    normals.insert(normals.end(), {0, 0, 1});
    uvs.insert(uvs.end(), {column(static_cast<std::uint32_t>(i)), 1 - static_cast<float>(i % 2)});
  }
  b.accessor(positions, "VEC3");
  b.accessor(normals, "VEC3");
  b.accessor(uvs, "VEC2");
  b.accessor<std::uint8_t>({0, 2, 1}, "SCALAR");
  b.accessor<std::uint8_t>({5, 4, 6, 5, 6, 7}, "SCALAR");
  const std::string attributes = R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2})";
  const TempGltf file(b.text(fmt::format(
      R"("scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{{0},"material":0,"indices":3}},)"
      R"({{{0},"material":0,"indices":3}},{{{0},"indices":4,"material":0}},{{{0}}}]}}],{1},{2})",
      attributes, kMapped, kImage)));
  const SceneData scene = load_gltf(file.path());
  const auto count = [&](std::size_t primitive) {
    return scene.arrays[static_cast<std::size_t>(scene.primitives[primitive].attributes[0])].count;
  };
  CHECK(count(0) == 3);
  CHECK(count(2) == 4);
  CHECK(count(3) == 8);
  CHECK(scene.primitives[0].attributes == scene.primitives[1].attributes);
  CHECK(scene.primitives[3].attributes[at(Semantic::kTangent)] == -1);
  const Corners corners = corners_of(scene, scene.primitives[2]);
  const Array& points = scene.arrays[static_cast<std::size_t>(scene.primitives[2].attributes[0])];
  const std::vector<std::uint32_t> before{5, 4, 6, 5, 6, 7};
  for (std::size_t c = 0; c < before.size(); ++c)
    CHECK(vertex_of(points, corners.vertices[c]).x == column(before[c]));
}

TEST_CASE("gltf tangents: what has too many triangles keeps a frame of its shader") {
  GltfChoice choice;
  choice.tangents = false;
  SceneData scene = loaded({}, choice);
  Primitive& primitive = scene.primitives[0];
  primitive.topology = traces::Topology::kTriangleStrip;
  primitive.count = kMostOfPrimitive + 1;
  Array& indices = scene.arrays[static_cast<std::size_t>(primitive.indices)];
  indices.count = primitive.count;
  indices.data.assign(indices.count, std::byte{0});
  CHECK(add_tangents(scene) == 1);
  CHECK_FALSE(has_tangents(scene));
  scene.primitives[0].count = 18;
  CHECK(add_tangents(scene) == 0);
  CHECK(has_tangents(scene));
}

namespace {

/// How the corners of a file's own tangents compare with those that are made without them.
struct Agreement {
  std::size_t corners = 0, within_a_degree = 0, within_ten = 0, same_side = 0;
  [[nodiscard]] double share(std::size_t count) const {
    return static_cast<double>(count) / static_cast<double>(corners);
  }
};

Agreement agreement(const std::string& path) {
  const SceneData own = load_gltf(path);
  SceneData made = own;
  for (Primitive& primitive : made.primitives) primitive.attributes[at(Semantic::kTangent)] = -1;
  CHECK(add_tangents(made) == 0);
  Agreement all;
  for (std::size_t p = 0; p < own.primitives.size(); ++p) {
    const auto tangents = [&](const SceneData& scene) -> const Array& {
      return scene.arrays[static_cast<std::size_t>(scene.primitives[p].attributes[at(Semantic::kTangent)])];
    };
    const Corners before = corners_of(own, own.primitives[p]), after = corners_of(made, made.primitives[p]);
    REQUIRE(before.vertices.size() == after.vertices.size());
    for (std::size_t c = 0; c < before.vertices.size(); ++c) {
      const glm::vec4 a = vertex_of(tangents(own), before.vertices[c]),
                      b = vertex_of(tangents(made), after.vertices[c]);
      const float cosine = glm::dot(glm::normalize(glm::vec3(a)), glm::vec3(b));
      ++all.corners;
      all.within_a_degree += cosine > std::cos(0.0174533F);
      all.within_ten += cosine > std::cos(0.174533F);
      all.same_side += a.w == b.w;
    }
  }
  return all;
}

}  // namespace

TEST_CASE("gltf tangents: they are near those that an exporter wrote") {
  const auto folder = scene_folder();
  if (!folder) {
    WARN("skipped: no folder of scenes");
    return;
  }
  // Its exporter averaged in another way: the reference implementation of MikkTSpace agrees with it as we do.
  const Agreement found = agreement((*folder / "FlightHelmet_512/FlightHelmet.gltf").string());
  CHECK(found.corners == 284166);
  CHECK(found.share(found.within_a_degree) > 0.738);
  CHECK(found.share(found.within_ten) > 0.988);
  CHECK(found.share(found.same_side) > 0.9999);
}
