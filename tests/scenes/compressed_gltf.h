/// glTF files with a curved grid as their only mesh, plain or compressed by the encoders of the libraries
/// that the product decodes with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::scenes {

/// A height field of (n + 1)^2 vertices and 2 n^2 triangles.
struct Grid {
  std::vector<float> positions, normals, uvs;  ///< 3, 3 and 2 numbers a vertex
  std::vector<std::uint32_t> indices;
  [[nodiscard]] std::size_t vertices() const { return positions.size() / 3; }
};
[[nodiscard]] Grid wavy_grid(int n);

/// One buffer view: the bytes as they lie in the file, and how long they are expanded.
struct View {
  std::vector<std::byte> bytes;
  std::size_t expanded = 0;
  /// of EXT_meshopt_compression without buffer, byteOffset and byteLength; empty: plain
  std::string extension;
};

/// A file whose mesh has the views as accessors: positions, normals, texture coordinates, indices. `normals`
/// describes the second accessor's type.
[[nodiscard]] std::string grid_gltf(const Grid& grid, const std::vector<View>& views,
                                    const std::string& normals = R"("componentType":5126)");

/// The grid's four streams as plain views.
[[nodiscard]] std::vector<View> plain_views(const Grid& grid);

}  // namespace quadrille::scenes
