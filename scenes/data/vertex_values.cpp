#include "scenes/data/vertex_values.h"

#include <bit>
#include <cstring>

#include "models/geometry/assembly.h"
#include "models/geometry/attribute_format.h"

namespace quadrille::scenes {
namespace {

template <class T>
std::vector<std::uint32_t> indices_as(const Array& array, std::uint32_t count, bool restarts) {
  std::vector<std::uint32_t> indices;
  indices.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    T index = 0;
    std::memcpy(&index, &array.data[i * sizeof(T)], sizeof(T));
    indices.push_back(restarts && index == static_cast<T>(~T{0}) ? ~std::uint32_t{0} : index);
  }
  return indices;
}

/// One a vertex of the draw. The special index that ends a strip, where there is one, is all ones of 32 bits,
/// whatever the type.
std::vector<std::uint32_t> indices_of(const SceneData& scene, const Primitive& primitive) {
  if (primitive.indices < 0) {
    std::vector<std::uint32_t> indices(primitive.count);
    for (std::uint32_t i = 0; i < primitive.count; ++i) indices[i] = i;
    return indices;
  }
  const Array& array = scene.arrays[static_cast<std::size_t>(primitive.indices)];
  switch (primitive.index_type) {
    case traces::IndexType::kUint8:
      return indices_as<std::uint8_t>(array, primitive.count, primitive.restarts);
    case traces::IndexType::kUint16:
      return indices_as<std::uint16_t>(array, primitive.count, primitive.restarts);
    case traces::IndexType::kUint32: break;
  }
  return indices_as<std::uint32_t>(array, primitive.count, primitive.restarts);
}

std::size_t vertices_of_piece(traces::Topology list) {
  return list == traces::Topology::kPointList ? 1 : list == traces::Topology::kLineList ? 2 : 3;
}

}  // namespace

std::array<std::uint32_t, 4> words_at(const Array& array, std::size_t vertex) {
  std::array<std::uint32_t, 4> words{};
  models::decode_attribute(static_cast<models::Format>(array.format),
                           &array.data[vertex * traces::format_bytes(array.format)], words.data());
  return words;
}

std::array<double, 4> values_at(const Array& array, std::size_t vertex) {
  std::array<double, 4> values{};
  const auto words = words_at(array, vertex);
  for (std::size_t c = 0; c < 4; ++c) values[c] = static_cast<double>(std::bit_cast<float>(words[c]));
  return values;
}

traces::Topology list_of(traces::Topology topology) {
  switch (topology) {
    case traces::Topology::kPointList: return traces::Topology::kPointList;
    case traces::Topology::kLineList:
    case traces::Topology::kLineStrip: return traces::Topology::kLineList;
    case traces::Topology::kTriangleList:
    case traces::Topology::kTriangleStrip:
    case traces::Topology::kTriangleFan: break;
  }
  return traces::Topology::kTriangleList;
}

Corners corners_of(const SceneData& scene, const Primitive& primitive) {
  Corners corners;
  corners.per_piece = vertices_of_piece(list_of(primitive.topology));
  const std::vector<std::uint32_t> indices = indices_of(scene, primitive);
  const auto count = static_cast<std::uint32_t>(indices.size());
  for (std::uint32_t begin = 0; begin < count;) {
    std::uint32_t end = begin;
    while (end < count && !(primitive.restarts && indices[end] == ~std::uint32_t{0})) ++end;
    for (std::uint32_t i = 0; i < models::primitive_count(primitive.topology, end - begin); ++i) {
      const std::array<std::uint32_t, 3> at = models::primitive_vertices(primitive.topology, i);
      for (std::size_t c = 0; c < corners.per_piece; ++c) corners.vertices.push_back(indices[begin + at[c]]);
    }
    begin = end + 1;
  }
  return corners;
}

}  // namespace quadrille::scenes
