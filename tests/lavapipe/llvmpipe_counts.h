/// What llvmpipe's statistics mean, as functions of the mesh alone, where Vulkan leaves the meaning to the
/// driver [M: lavapipe statistics].
#pragma once

#include <cstdint>

#include "studies/experiments/triangle_mesh.h"

namespace quadrille::lavapipe {

/// Vertices shaded. Indices are taken in runs of at most 1023, whole triangles; in a run, an index is shaded
/// unless the last one with the same remainder by 256 was the same index.
[[nodiscard]] std::uint64_t llvmpipe_vertex_invocations(const studies::experiments::TriangleMesh& mesh);

/// Fragment invocations: 16 for each block of 4x4 pixels of which a triangle covers a centre, hidden or not.
/// No corner may lie outside the frame.
[[nodiscard]] std::uint64_t llvmpipe_fragment_invocations(const studies::experiments::TriangleMesh& mesh);

}  // namespace quadrille::lavapipe
