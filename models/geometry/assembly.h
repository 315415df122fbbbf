/// Primitive assembly: which vertices of a draw form its i-th triangle, line or point. [VK1.3
/// #drawing-primitive-topologies]
#pragma once

#include "models/base/pipeline_state.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

/// Primitives that `vertices` vertices of a draw form; left-over vertices form none.
[[nodiscard]] constexpr std::uint32_t primitive_count(Topology topology, std::uint32_t vertices) {
  switch (topology) {
    case Topology::kTriangleList: return vertices / 3;
    case Topology::kTriangleStrip:
    case Topology::kTriangleFan: return vertices < 3 ? 0 : vertices - 2;
    case Topology::kPointList: return vertices;
    case Topology::kLineList: return vertices / 2;
    case Topology::kLineStrip: return vertices < 2 ? 0 : vertices - 1;
  }
  return 0;
}

/// Positions within the draw (0-based) of the vertices of primitive `i`; a line or a point repeats its last
/// one. The first is the provoking vertex, and the order keeps the winding. [VK1.3 #drawing-point-lists,
/// #drawing-line-lists, #drawing-line-strips, #drawing-triangle-lists, #drawing-triangle-strips,
/// #drawing-triangle-fans]
[[nodiscard]] constexpr std::array<std::uint32_t, 3> primitive_vertices(Topology topology, std::uint32_t i) {
  switch (topology) {
    case Topology::kTriangleList: return {3 * i, 3 * i + 1, 3 * i + 2};
    case Topology::kTriangleStrip: return {i, i + 1 + i % 2, i + 2 - i % 2};
    case Topology::kTriangleFan: return {i + 1, i + 2, 0};
    case Topology::kPointList: return {i, i, i};
    case Topology::kLineList: return {2 * i, 2 * i + 1, 2 * i + 1};
    case Topology::kLineStrip: return {i, i + 1, i + 1};
  }
  return {};
}

}  // namespace quadrille::models
