/// What the streams and indices of a primitive hold, read by the host.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

/// The four components of a vertex as the vertex shader gets them: bits of floats or integers.
[[nodiscard]] std::array<std::uint32_t, 4> words_at(const Array& array, std::size_t vertex);
/// The same of a format that is read as floats.
[[nodiscard]] std::array<double, 4> values_at(const Array& array, std::size_t vertex);

/// The list of what a strip or fan is made of.
[[nodiscard]] traces::Topology list_of(traces::Topology topology);

/// A primitive's points, lines or triangles one by one, as primitive assembly makes them: strips and fans
/// are taken apart and indices followed.
struct Corners {
  std::size_t per_piece = 3;  ///< vertices of a point, line or triangle
  /// numbers of vertices; the first of a piece is its provoking one
  std::vector<std::uint32_t> vertices;
  [[nodiscard]] std::size_t pieces() const { return vertices.size() / per_piece; }
};
[[nodiscard]] Corners corners_of(const SceneData& scene, const Primitive& primitive);

}  // namespace quadrille::scenes
