/// Primitive assembly: which vertices of a draw form its i-th triangle. [VK1.3 #drawing-primitive-topologies]
#pragma once

#include "models/base/pipeline_state.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

/// Triangles that `vertices` vertices of a draw form; left-over vertices form none.
[[nodiscard]] constexpr std::uint32_t triangle_count(Topology topology, std::uint32_t vertices) {
  if (topology == Topology::kTriangleList) return vertices / 3;
  return vertices < 3 ? 0 : vertices - 2;
}

/// Positions within the draw (0-based) of the vertices of triangle `i`. The first is the provoking vertex,
/// and the order keeps the winding. [VK1.3 #drawing-triangle-lists, #drawing-triangle-strips,
/// #drawing-triangle-fans]
[[nodiscard]] constexpr std::array<std::uint32_t, 3> triangle_vertices(Topology topology, std::uint32_t i) {
  switch (topology) {
    case Topology::kTriangleList: return {3 * i, 3 * i + 1, 3 * i + 2};
    case Topology::kTriangleStrip: return {i, i + 1 + i % 2, i + 2 - i % 2};
    case Topology::kTriangleFan: return {i + 1, i + 2, 0};
  }
  return {};
}

}  // namespace quadrille::models
