/// What meshoptimizer's encoders pack is unpacked bit for bit; what nobody packed is refused.
#include "scenes/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "scenes/gltf/loader.h"
#include "tests/scenes/compressed_gltf.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/meshopt_views.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

/// Triangles as sorted triples of corners: the triangle codec may turn each.
std::vector<std::array<std::uint32_t, 3>> turned(const Array& indices) {
  std::vector<std::array<std::uint32_t, 3>> result(indices.count / 3);
  std::memcpy(result.data(), indices.data.data(), indices.data.size());
  for (auto& t : result) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return result;
}

}  // namespace

TEST_CASE("meshopt: packed attributes and triangles are the plain ones, bit for bit") {
  const Grid grid = wavy_grid(33);
  const SceneData plain = load_text(grid_gltf(grid, plain_views(grid))),
                  packed = load_text(grid_gltf(grid, packed_views(grid)));
  for (const Semantic semantic : {Semantic::kPosition, Semantic::kNormal, Semantic::kUv0})
    REQUIRE(stream(packed, semantic).data == stream(plain, semantic).data);
  const auto index = [](const SceneData& s) -> const Array& {
    return s.arrays[static_cast<std::size_t>(s.primitives[0].indices)];
  };
  REQUIRE(turned(index(packed)) == turned(index(plain)));
}

TEST_CASE("meshopt: an index sequence keeps every index in its place") {
  const Grid grid = wavy_grid(9);
  std::vector<View> views = packed_views(grid);
  views[3] = sequence_view(grid);
  const SceneData scene = load_text(grid_gltf(grid, views));
  const Array& indices = scene.arrays[static_cast<std::size_t>(scene.primitives[0].indices)];
  REQUIRE(std::memcmp(indices.data.data(), grid.indices.data(), indices.data.size()) == 0);
}

TEST_CASE("meshopt: the octahedral filter gives unit normals within its bits") {
  const Grid grid = wavy_grid(9);
  std::vector<float> four;
  for (std::size_t i = 0; i < grid.vertices(); ++i)
    four.insert(four.end(), {grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2], 0});
  std::vector<std::int16_t> filtered(four.size());
  meshopt_encodeFilterOct(filtered.data(), grid.vertices(), 8, 16, four.data());
  std::vector<View> views = packed_views(grid);
  views[1] = attributes_view(filtered.data(), grid.vertices(), 8, "OCTAHEDRAL");
  std::string text = grid_gltf(grid, views, R"("componentType":5122,"normalized":true)");
  text.replace(text.find(fmt::format(R"("byteLength":{},"ext)", 8 * grid.vertices())), 0,
               R"("byteStride":8,)");
  const SceneData scene = load_text(text);
  const Array& normals = stream(scene, Semantic::kNormal);
  for (std::size_t i = 0; i < grid.vertices(); ++i) {
    std::array<std::int16_t, 4> n{};
    std::memcpy(n.data(), &normals.data[8 * i], 8);
    for (std::size_t k = 0; k < 3; ++k)
      REQUIRE(std::abs(static_cast<float>(n[k]) / 32767 - grid.normals[3 * i + k]) < 2e-4F);
  }
}

TEST_CASE(
    "meshopt: the exponential filter keeps floats within its bits, and quaternions come back by their "
    "filter") {
  const Grid grid = wavy_grid(9);
  std::vector<std::uint32_t> filtered(grid.positions.size());
  meshopt_encodeFilterExp(filtered.data(), grid.vertices(), 12, 15, grid.positions.data());
  std::vector<View> views = packed_views(grid);
  views[0] = attributes_view(filtered.data(), grid.vertices(), 12, "EXPONENTIAL");
  const SceneData scene = load_text(grid_gltf(grid, views));
  std::vector<float> positions(grid.positions.size());
  std::memcpy(positions.data(), stream(scene, Semantic::kPosition).data.data(), 4 * positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    REQUIRE(std::abs(positions[i] - grid.positions[i]) < 1e-4F);

  std::vector<float> quaternions;
  for (std::size_t i = 0; i < 64; ++i)
    quaternions.insert(quaternions.end(), {0.6F, 0, 0, i % 2 == 0 ? 0.8F : -0.8F});
  std::vector<std::int16_t> packed(quaternions.size());
  meshopt_encodeFilterQuat(packed.data(), 64, 8, 12, quaternions.data());
  views.push_back(attributes_view(packed.data(), 64, 8, "QUATERNION"));
  GltfFile file;
  {
    const TempGltf text(grid_gltf(grid, views));
    file = read_gltf_file(text.path());
  }
  const auto bytes = buffer_view_bytes(file, 4, "test");
  for (std::size_t i = 0; i < 64; ++i) {
    std::array<std::int16_t, 4> q{};
    std::memcpy(q.data(), &bytes[8 * i], 8);
    float dot = 0;
    for (std::size_t k = 0; k < 4; ++k) dot += static_cast<float>(q[k]) / 32767 * quaternions[4 * i + k];
    REQUIRE(std::abs(dot) > 0.999F);
  }
}

TEST_CASE("meshopt: counts, strides, modes and lengths that do not fit are refused with their place") {
  const Grid grid = wavy_grid(9);
  const auto result = [&](const std::string& extension) {
    std::vector<View> views = packed_views(grid);
    views[0].extension = extension;
    return load_result(grid_gltf(grid, views));
  };
  REQUIRE_THAT(result(R"("byteStride":12,"count":99,"mode":"ATTRIBUTES")"),
               Contains("bufferViews[0].EXT_meshopt_compression.count: 99 elements"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":2000000000,"mode":"ATTRIBUTES")"),
               Contains("cannot lie in"));
  REQUIRE_THAT(result(R"("byteStride":13,"count":100,"mode":"ATTRIBUTES")"),
               Contains("byteStride: 13 is not a stride"));
  REQUIRE_THAT(result(R"("byteStride":0,"count":100,"mode":"ATTRIBUTES")"),
               Contains("byteStride: 0 is not a stride"));
  REQUIRE_THAT(result(R"("byteStride":4,"count":301,"mode":"TRIANGLES")"),
               Contains("301 indices are not triangles"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":100,"mode":"ZIP")"), Contains("mode: it is not ATTRIBUTES"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":100,"mode":"ATTRIBUTES","filter":"OCTAHEDRAL")"),
               Contains("byteStride: 12"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":-1,"mode":"ATTRIBUTES")"),
               Contains("count: a non-negative integer is due"));
  REQUIRE_THAT(result(R"("byteStride":4,"count":300,"mode":"TRIANGLES")"),
               Contains("buffer: its data cannot be decoded"));
}

TEST_CASE("meshopt: random damage to the packed bytes is decoded or refused") {
  const Grid grid = wavy_grid(9);
  std::mt19937 dice(5);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<View> views = packed_views(grid);
    auto& bytes = views[dice() % 4].bytes;
    for (unsigned k = 0; k < 1 + dice() % 4; ++k)
      bytes[dice() % bytes.size()] = static_cast<std::byte>(dice() % 256);
    if (dice() % 3 == 0) bytes.resize(1 + dice() % bytes.size());
    const std::string result = load_result(grid_gltf(grid, views));
    REQUIRE(result.find('\n') == std::string::npos);
    refused += result == "loaded" ? 0 : 1;
  }
  REQUIRE(refused > 50);
}
