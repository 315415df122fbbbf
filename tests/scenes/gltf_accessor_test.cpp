#include "scenes/gltf/accessor.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>

#include "models/base/error.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

template <class T>
void append(std::vector<unsigned char>& data, std::initializer_list<T> values) {
  for (const T value : values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
    data.insert(data.end(), bytes, bytes + sizeof(T));
  }
}

tinygltf::BufferView view(std::size_t offset, std::size_t length, std::size_t stride = 0) {
  tinygltf::BufferView v;
  v.buffer = 0;
  v.byteOffset = offset;
  v.byteLength = length;
  v.byteStride = stride;
  return v;
}

tinygltf::Accessor accessor(int buffer_view, int component, int type, std::size_t count,
                            bool normalized = false) {
  tinygltf::Accessor a;
  a.bufferView = buffer_view;
  a.componentType = component;
  a.type = type;
  a.count = count;
  a.normalized = normalized;
  return a;
}

GltfFile file_with(std::vector<unsigned char> data, std::vector<tinygltf::BufferView> views,
                   tinygltf::Accessor a) {
  GltfFile file;
  file.path = "t.gltf";
  file.model.buffers.resize(1);
  file.model.buffers[0].data = std::move(data);
  file.model.bufferViews = std::move(views);
  file.model.accessors = {std::move(a)};
  return file;
}

std::vector<float> values(const GltfFile& file) {
  const Elements e = read_accessor(file, 0, "here");
  std::vector<float> result;
  for (std::size_t i = 0; i < e.count; ++i) {
    for (std::size_t c = 0; c < e.components; ++c) result.push_back(component_value(e, i, c));
  }
  return result;
}

std::string refusal(const GltfFile& file, int index = 0) {
  try {
    (void)read_accessor(file, index, "here");
  } catch (const UserError& error) { return error.what(); }
  return "read";
}

}  // namespace

TEST_CASE("accessor: tightly packed and interleaved elements are the same elements") {
  std::vector<unsigned char> packed, interleaved;
  append<float>(packed, {1, 2, 3, 4, 5, 6});
  append<float>(interleaved, {1, 2, 99, 3, 4, 99, 5, 6});  // the last element may end before its stride does
  const auto a = accessor(0, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, 3);
  REQUIRE(values(file_with(packed, {view(0, 24)}, a)) == std::vector<float>{1, 2, 3, 4, 5, 6});
  REQUIRE(values(file_with(interleaved, {view(0, 32, 12)}, a)) == std::vector<float>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("accessor: normalized integers end at exactly one and minus one") {
  std::vector<unsigned char> data;
  append<std::int8_t>(data, {-128, -127, 0, 127});
  REQUIRE(values(file_with(data, {view(0, 4)},
                           accessor(0, TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_TYPE_SCALAR, 4, true))) ==
          std::vector<float>{-1, -1, 0, 1});
  data.clear();
  append<std::uint16_t>(data, {0, 65535, 257});
  REQUIRE(values(file_with(data, {view(0, 6)},
                           accessor(0, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, 3,
                                    true))) == std::vector<float>{0, 1, 257.0F / 65535});
  REQUIRE(values(file_with(data, {view(0, 6)},
                           accessor(0, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, 3))) ==
          std::vector<float>{0, 65535, 257});
}

TEST_CASE("accessor: without a buffer view it is zeros, and sparse values replace elements") {
  std::vector<unsigned char> data;
  append<std::uint16_t>(data, {1, 3});
  append<float>(data, {10, 30});
  auto a = accessor(-1, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 4);
  REQUIRE(values(file_with(data, {}, a)) == std::vector<float>{0, 0, 0, 0});
  a.sparse.isSparse = true;
  a.sparse.count = 2;
  a.sparse.indices = {0, 0, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT};
  a.sparse.values = {1, 0};
  const std::vector<tinygltf::BufferView> views{view(0, 4), view(4, 8)};
  REQUIRE(values(file_with(data, views, a)) == std::vector<float>{0, 10, 0, 30});
  a.count = 3;
  REQUIRE_THAT(refusal(file_with(data, views, a)), Catch::Contains("index 3 is beyond 3 elements"));
  a.sparse.count = 4;
  REQUIRE_THAT(refusal(file_with(data, views, a)), Catch::Contains("sparse.count 4"));
  a.sparse.count = 3;
  REQUIRE_THAT(refusal(file_with(data, views, a)), Catch::Contains("sparse.indices: 3 elements"));
}

TEST_CASE("accessor: whatever reaches beyond its bytes is refused with file, place and number") {
  const std::vector<unsigned char> data(24);
  const auto a = accessor(0, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 2);
  REQUIRE(refusal(file_with(data, {view(0, 24)}, a)) == "read");
  REQUIRE_THAT(refusal(file_with(data, {view(0, 23)}, a)),
               Catch::StartsWith("t.gltf: here: accessor 0: 2 elements"));
  REQUIRE_THAT(refusal(file_with(data, {view(1, 24)}, a)),
               Catch::Contains("bufferViews[0]: bytes 1+24 reach beyond"));
  REQUIRE_THAT(refusal(file_with(data, {view(SIZE_MAX, 24)}, a)), Catch::Contains("reach beyond"));
  REQUIRE_THAT(refusal(file_with(data, {view(0, 24, 13)}, a)),
               Catch::Contains("2 elements of 12 bytes, 13 apart"));
  REQUIRE_THAT(refusal(file_with(data, {view(0, 24, 8)}, a)), Catch::Contains("byteStride 8"));
  REQUIRE_THAT(refusal(file_with(data, {}, a)), Catch::Contains("bufferView 0 does not exist"));
  REQUIRE_THAT(refusal(file_with(data, {view(0, 24)}, a), 1), Catch::Contains("accessor 1: does not exist"));
  REQUIRE_THAT(refusal(file_with(data, {view(0, 24)}, a), -2),
               Catch::Contains("accessor -2: does not exist"));
  auto shifted = a;
  shifted.byteOffset = SIZE_MAX - 3;
  REQUIRE_THAT(refusal(file_with(data, {view(0, 24)}, shifted)), Catch::Contains("reach beyond"));
}

TEST_CASE("accessor: counts that would take gigabytes are refused before allocation") {
  auto a = accessor(-1, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4, std::size_t{1} << 60);
  REQUIRE_THAT(refusal(file_with({}, {}, a)), Catch::Contains("count 1152921504606846976 is not 1.."));
  a.count = 0;
  REQUIRE_THAT(refusal(file_with({}, {}, a)), Catch::Contains("count 0"));
}

TEST_CASE("vertex array: colours keep their 8 and 16 bits, three components get an alpha of one") {
  std::vector<unsigned char> data;
  append<std::uint8_t>(data, {1, 2, 3, 250, 251, 252});
  const GltfFile file = file_with(
      data, {view(0, 6)}, accessor(0, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC3, 2, true));
  const Array array = to_vertex_array(file, read_accessor(file, 0, "c"), Semantic::kColor, "c");
  REQUIRE(array.format == traces::Format::kR8G8B8A8UnormVertex);
  REQUIRE(array.data == std::vector<std::byte>{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{255},
                                               std::byte{250}, std::byte{251}, std::byte{252},
                                               std::byte{255}});
}

TEST_CASE("vertex array: a type that glTF does not allow, and values that are not finite, are refused") {
  std::vector<unsigned char> data;
  append<float>(data, {0, 1, std::numeric_limits<float>::quiet_NaN()});
  const GltfFile file =
      file_with(data, {view(0, 12)}, accessor(0, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 1));
  const Elements elements = read_accessor(file, 0, "p");
  REQUIRE_THROWS_WITH(to_vertex_array(file, elements, Semantic::kPosition, "p"),
                      "t.gltf: p: element 0 is not finite");
  REQUIRE_THROWS_WITH(to_vertex_array(file, elements, Semantic::kUv0, "p"),
                      Catch::Contains("not allowed for TEXCOORD_0"));
}
