/// What Draco's encoder packs comes back within its quantisation; what nobody packed is refused before much
/// memory is taken.
#include "scenes/gltf/draco.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "scenes/gltf/loader.h"
#include "tests/scenes/compressed_gltf.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, int components,
                  const std::vector<float>& values) {
  draco::GeometryAttribute form;
  form.Init(type, nullptr, static_cast<std::uint8_t>(components), draco::DT_FLOAT32, false, 4 * components,
            0);
  const auto count = static_cast<std::uint32_t>(values.size() / static_cast<std::size_t>(components));
  const int id = mesh.AddAttribute(form, true, count);
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                          &values[i * static_cast<std::size_t>(components)]);
  return id;
}

/// Positions (id 0), normals (1) and texture coordinates (2), by the encoding method; then (3) an attribute
/// of `generic` components.
std::vector<std::byte> packed(const Grid& grid, int method, int bits, int generic = 0) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(grid.vertices()));
  for (std::size_t i = 0; i + 2 < grid.indices.size(); i += 3)
    mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                  draco::PointIndex(grid.indices[i + 2])});
  add_attribute(mesh, draco::GeometryAttribute::POSITION, 3, grid.positions);
  add_attribute(mesh, draco::GeometryAttribute::NORMAL, 3, grid.normals);
  add_attribute(mesh, draco::GeometryAttribute::TEX_COORD, 2, grid.uvs);
  if (generic > 0)
    add_attribute(mesh, draco::GeometryAttribute::GENERIC, generic,
                  std::vector<float>(grid.vertices() * static_cast<std::size_t>(generic), 1));
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
                          draco::GeometryAttribute::TEX_COORD})
    encoder.SetAttributeQuantization(type, bits);
  draco::EncoderBuffer buffer;
  REQUIRE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
  std::vector<std::byte> bytes(buffer.size());
  std::memcpy(bytes.data(), buffer.data(), bytes.size());
  return bytes;
}

/// Accessors without buffer views; only the extension has data.
std::string draco_gltf(const Grid& grid, const std::vector<std::byte>& bytes, const std::string& attributes) {
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"extensionsRequired":["KHR_draco_mesh_compression"],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3,)"
      R"("extensions":{{"KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{{4}}}}}}}}}]}}],"accessors":[)"
      R"({{"componentType":5126,"count":{0},"type":"VEC3"}},{{"componentType":5126,"count":{0},"type":"VEC3"}},)"
      R"({{"componentType":5126,"count":{0},"type":"VEC2"}},{{"componentType":5123,"count":{1},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{2}}}],"buffers":[{{"byteLength":{2},"uri":"{3}"}}]}})",
      grid.vertices(), grid.indices.size(), bytes.size(), data_uri(bytes), attributes);
}

const std::string kIds = R"("POSITION":0,"NORMAL":1,"TEXCOORD_0":2)";

SceneData load(const std::string& text) {
  const TempGltf file(text);
  return load_gltf(file.path());
}

std::vector<float> stream(const SceneData& scene, Semantic semantic) {
  const Array& array = scene.arrays[static_cast<std::size_t>(
      scene.primitives[0].attributes[static_cast<std::size_t>(semantic)])];
  std::vector<float> values(array.data.size() / 4);
  std::memcpy(values.data(), array.data.data(), array.data.size());
  return values;
}

/// The grid's vertex at these texture coordinates, which its vertices have each their own.
std::size_t nearest_vertex(const Grid& grid, float u, float v, int n) {
  const auto x = static_cast<std::size_t>(std::lround(u * static_cast<float>(n))),
             y = static_cast<std::size_t>(std::lround((1 - v) * static_cast<float>(n)));
  REQUIRE(y * static_cast<std::size_t>(n + 1) + x < grid.vertices());
  return y * static_cast<std::size_t>(n + 1) + x;
}

}  // namespace

TEST_CASE("draco: a mesh without buffer views comes back within its quantisation, by both methods") {
  constexpr int kSide = 20;
  const Grid grid = wavy_grid(kSide);
  for (const int method : {static_cast<int>(draco::MESH_SEQUENTIAL_ENCODING),
                           static_cast<int>(draco::MESH_EDGEBREAKER_ENCODING)}) {
    CAPTURE(method);
    const SceneData scene = load(draco_gltf(grid, packed(grid, method, 12), kIds));
    REQUIRE(scene.primitives[0].count == grid.indices.size());
    REQUIRE(scene.primitives[0].index_type == traces::IndexType::kUint16);
    const auto positions = stream(scene, Semantic::kPosition), normals = stream(scene, Semantic::kNormal),
               uvs = stream(scene, Semantic::kUv0);
    REQUIRE(positions.size() == grid.positions.size());
    for (std::size_t i = 0; i < grid.vertices(); ++i) {
      const std::size_t original = nearest_vertex(grid, uvs[2 * i], uvs[2 * i + 1], kSide);
      for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(std::abs(positions[3 * i + k] - grid.positions[3 * original + k]) < 1.0F / 4000);
        REQUIRE(std::abs(normals[3 * i + k] - grid.normals[3 * original + k]) < 1.0F / 500);
      }
    }
  }
}

TEST_CASE("draco: attributes that do not exist and data that is none are refused with their place") {
  const Grid grid = wavy_grid(4);
  const auto good = packed(grid, draco::MESH_EDGEBREAKER_ENCODING, 10);
  REQUIRE(load_result(draco_gltf(grid, good, kIds)) == "loaded");
  REQUIRE_THAT(load_result(draco_gltf(grid, good, R"("POSITION":7)")),
               Contains("attributes.POSITION: Draco's data has no attribute 7"));
  REQUIRE_THAT(load_result(draco_gltf(grid, good, R"("POSITION":2)")),
               Contains("2 components in Draco's data, 3 in the accessor"));
  REQUIRE_THAT(load_result(draco_gltf(grid, good, R"("COLOR_0":0)")),
               Contains("the primitive has no such attribute"));
  auto bad = good;
  bad[0] = std::byte{'X'};
  REQUIRE_THAT(
      load_result(draco_gltf(grid, bad, kIds)),
      Contains("meshes[0].primitives[0].KHR_draco_mesh_compression.bufferView: its data is not Draco's"));
  bad = good;
  bad[6] = std::byte{1};
  REQUIRE_THAT(load_result(draco_gltf(grid, bad, kIds)), Contains("bitstream 2.1; 2.2 is read"));
  bad.assign(good.begin(), good.begin() + 14);
  REQUIRE_THAT(load_result(draco_gltf(grid, bad, kIds)), Contains("bufferView: "));
}

TEST_CASE("draco: counts that the data claims are bounded before memory is taken") {
  const Grid grid = wavy_grid(4);
  auto bytes = packed(grid, draco::MESH_SEQUENTIAL_ENCODING, 10);
  // Header: 11 bytes; then the number of triangles as a variable-length integer. Four billion of them:
  bytes.erase(bytes.begin() + 11);
  for (const int b : {0x0f, 0xff, 0xff, 0xff, 0xff})
    bytes.insert(bytes.begin() + 11, static_cast<std::byte>(b));
  REQUIRE_THAT(load_result(draco_gltf(grid, bytes, kIds)), Contains("triangles of") && Contains("are read"));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  REQUIRE(usage.ru_maxrss < 1024 * 1024);  // KiB
}

TEST_CASE("draco: random damage to the packed bytes is decoded or refused") {
  const Grid grid = wavy_grid(8);
  std::mt19937 dice(6);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    auto bytes =
        packed(grid, i % 2 == 0 ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING, 10);
    for (unsigned k = 0; k < 1 + dice() % 4; ++k)
      bytes[dice() % bytes.size()] = static_cast<std::byte>(dice() % 256);
    if (dice() % 3 == 0) bytes.resize(1 + dice() % bytes.size());
    const std::string result = load_result(draco_gltf(grid, bytes, kIds));
    REQUIRE(result.find('\n') == std::string::npos);
    refused += result == "loaded" ? 0 : 1;
  }
  REQUIRE(refused > 100);
}

TEST_CASE(
    "draco: an attribute of more components than a vertex attribute has is refused before it is converted") {
  const Grid grid = wavy_grid(4);
  const auto bytes = packed(grid, draco::MESH_SEQUENTIAL_ENCODING, 10, 16);
  REQUIRE(load_result(draco_gltf(grid, bytes, kIds)) == "loaded");
  std::string text = draco_gltf(grid, bytes, kIds + R"(,"_MATRIX":3)");
  const std::string uvs = R"("TEXCOORD_0":2},"indices")", accessors = R"(}],"bufferViews")";
  text.replace(text.find(uvs), uvs.size(), R"("TEXCOORD_0":2,"_MATRIX":4},"indices")");
  text.insert(text.find(accessors) + 1,
              fmt::format(R"(,{{"componentType":5126,"count":{},"type":"MAT4"}})", grid.vertices()));
  REQUIRE_THAT(load_result(text), Contains("KHR_draco_mesh_compression.attributes._MATRIX: 16 components; "
                                           "Draco's attributes are read with at most 4"));
}
