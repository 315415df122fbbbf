/// Meshes that are drawn on simulated machines and on real devices alike, so that both are asked the same
/// question.
#pragma once

#include "studies/experiments/triangle_mesh.h"

namespace quadrille::studies::experiments {

/// One triangle that covers one pixel, named `times` times by the same three corners.
[[nodiscard]] TriangleMesh same_triangle(std::uint32_t width, std::uint32_t height, std::uint32_t times);

/// The mesh's triangles again and again, over the same corners.
[[nodiscard]] TriangleMesh repeated(TriangleMesh mesh, std::uint32_t times);

[[nodiscard]] TriangleMesh moved_right(TriangleMesh mesh, std::uint32_t pixels);

/// Equilateral triangles of `area` pixels, turned and placed by chance within the frame (the same on every
/// host), each with corners of its own: as many as cover 2^17 pixels together, at most 2^15.
[[nodiscard]] TriangleMesh scattered(std::uint32_t width, std::uint32_t height, double area);

/// Rectangles over the whole frame, one behind the other, the nearest drawn first or last. At most 19.
[[nodiscard]] TriangleMesh layers(std::uint32_t width, std::uint32_t height, std::uint32_t count,
                                  bool front_first);

/// The frame filled by tiles of 8x8 pixels, two triangles each, every triangle with corners of its own of
/// which `behind` (0 to 3) lie before the near plane, as far from it as the others: the plane halves the
/// edges that it cuts.
[[nodiscard]] TriangleMesh through_near_plane(std::uint32_t width, std::uint32_t height,
                                              std::uint32_t behind);

}  // namespace quadrille::studies::experiments
