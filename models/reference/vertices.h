/// Vertex fetch and vertex shading of one instance of a draw. Internal to the reference.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "models/reference/draw_state.h"

namespace quadrille::models::reference {

/// Shader outputs of the distinct vertices that an instance uses, and which of them each position in the draw
/// is.
struct ShadedVertices {
  std::vector<std::array<double, 4>> clip;  ///< clip-space position, by distinct vertex
  /// cell bits, `ports` a vertex, in the order of the program's outputs
  std::vector<std::uint64_t> outputs;
  std::size_t ports = 0;
  std::vector<std::uint32_t> sequence;  ///< draw order -> distinct vertex
  std::vector<std::uint32_t> breaks;    ///< positions at which a strip or fan ends; in order
  std::vector<double> point_size;       ///< by distinct vertex; empty: none is written
  std::vector<std::uint32_t> viewport;  ///< likewise
  /// by distinct vertex: clip distances, then cull distances
  std::vector<std::vector<double>> distances;
  std::size_t clip_distances = 0;
};

/// An attribute's four components as the shader sees them; bytes beyond the buffer read as zero. [VK1.3
/// #fxvertex-input-extraction]
[[nodiscard]] std::array<double, 4> read_attribute(const traces::Buffer& buffer, std::uint64_t offset,
                                                   traces::Format format);

/// Shades the vertices of instance `instance` (from 0).
[[nodiscard]] ShadedVertices shade_vertices(const DrawState& state, const BoundShader& shader,
                                            std::uint32_t instance, int threads);

/// Positions within the draw of the vertices of its primitives, in Vulkan's order; a line or a point repeats
/// its last one. Strips and fans begin anew after each position in `breaks`. [VK1.3
/// #drawing-primitive-topologies]
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> assemble(traces::Topology topology,
                                                                 std::uint32_t vertices,
                                                                 std::span<const std::uint32_t> breaks = {});

}  // namespace quadrille::models::reference
