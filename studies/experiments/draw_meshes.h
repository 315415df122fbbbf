/// The meshes of a command stream as its draws name them: corners in the order in which vertex fetch reads
/// them.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>
#include <vector>

namespace quadrille::studies::experiments {

struct DrawMesh {
  /// vertices of the triangles, three a triangle, numbered from 0 in order of their first use
  std::vector<std::uint32_t> corners;
  std::uint32_t vertices = 0;  ///< distinct ones
  std::uint32_t instances = 1;
};

/// One a draw that has triangles.
[[nodiscard]] std::vector<DrawMesh> draw_meshes(const traces::CommandStream& stream);

/// Vertices that meshoptimizer's analyser counts for a mesh, over all instances: a FIFO of `cache`, emptied
/// with every warp of `warp` vertices or `group` triangles (0: never).
[[nodiscard]] std::uint64_t analysed_vertices(const DrawMesh& mesh, unsigned cache, unsigned warp,
                                              unsigned group);

}  // namespace quadrille::studies::experiments
