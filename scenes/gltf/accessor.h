/// Accessors: typed views into a file's buffers, with stride, normalization and sparse replacements. [glTF2.0
/// #accessors]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

enum class Component : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kUint32, kFloat };
/// Bytes of one component.
[[nodiscard]] std::size_t component_bytes(Component component);

/// The elements of an accessor, packed tightly in their own component type.
struct Elements {
  Component component = Component::kFloat;
  std::size_t components = 1;  ///< an element
  bool normalized = false;
  std::uint32_t count = 0;
  std::vector<std::byte> data;
};

/// Fetches accessor `index`: strides resolved, sparse values put in, zeros where it has no buffer view.
/// Throws `UserError` with `place` and `index` when anything about it is out of range, is a matrix other than
/// 4x4, or takes more than 1 GiB.
[[nodiscard]] Elements read_accessor(const GltfFile& file, int index, const std::string& place);

/// Component, number of components and normalization of accessor `index`, which must exist, without its
/// elements. Throws like `read_accessor`.
[[nodiscard]] Elements accessor_type(const GltfFile& file, int index, const std::string& place);

/// One component as a float; normalized integers by glTF's table. [glTF2.0 #animations: decoding of
/// normalized integers]
[[nodiscard]] float component_value(const Elements& elements, std::size_t element, std::size_t component);

/// Elements as a vertex stream for `semantic`, keeping 8- and 16-bit normalized components where a vertex
/// format has them. Throws `UserError` with `place` for a type that glTF does not allow there, or values that
/// are not finite. Not so for normals and tangents, which are directions: those that have none (of length
/// zero, not finite, or for a tangent without a side) become zero and are counted in `without_direction`;
/// floats of lengths whose squares leave the range of floats are brought to length one.
[[nodiscard]] Array to_vertex_array(const GltfFile& file, Elements elements, Semantic semantic,
                                    const std::string& place, std::uint32_t* without_direction = nullptr);

/// Bytes of the stream that `to_vertex_array` makes.
[[nodiscard]] std::uint64_t vertex_array_bytes(const Elements& elements, Semantic semantic);
/// Bytes of the elements as floats.
[[nodiscard]] std::uint64_t float_bytes(const Elements& elements);

/// Elements of `components` each as a stream of floats: what a morph target adds. Throws as
/// `to_vertex_array`.
[[nodiscard]] Array to_delta_array(const GltfFile& file, const Elements& elements, std::size_t components,
                                   const std::string& place);

}  // namespace quadrille::scenes
