/// Trials of coverage: each triangle of a mesh against the exact oracle, and all of them together exactly
/// once.
///
/// A triangle is set up as the machine does it, from positions in float, and covered in both ways of
/// traversal. Each must give the oracle's samples. Then the triangles of the mesh are counted at each
/// sample, those that rounding turned round with -1. The counts must be those that the oracle finds from the
/// mesh's outline alone: 1 within it and 0 outside. Only where rounding folds a mesh over do its triangles
/// overlap; there too the counts are those of the outline.
#pragma once

#include "models/raster/triangle_setup.h"
#include "tests/models/raster/coverage_meshes.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::models {

/// A way to cover a triangle: sets the bits of its samples in the window. The masks are empty before.
struct CoverageMethod {
  std::string name;
  /// Returns false if a sample is covered twice, or a tile that is said to be full is not.
  std::function<bool(const TriangleSetup&, const SampleGrid&, const CoverageWindow&, WindowMasks&)> cover;
};
/// By edge functions, and by walking edges.
[[nodiscard]] std::span<const CoverageMethod> coverage_methods();

/// What trials have seen.
struct CoverageTally {
  std::int64_t meshes = 0, triangles = 0;
  std::int64_t kept = 0;      ///< triangles that were set up: they have an area, and reach the window
  std::int64_t covering = 0;  ///< triangles that cover a sample
  std::int64_t covered = 0;   ///< samples, summed over triangles
  std::int64_t ties = 0;      ///< places where an edge crosses a row exactly at a sample
  std::int64_t folded = 0;    ///< meshes that rounding folded over, so that triangles overlap
  std::int64_t failed = 0;    ///< meshes
  std::string first_failure;  ///< one line; empty if there is none
  void add(const CoverageTally& other);
};

/// Holds a mesh against the oracle.
[[nodiscard]] CoverageTally try_mesh(const CoverageMesh& mesh, const CoverageWindow& window,
                                     std::span<const CoverageMethod> methods = coverage_methods());
/// Mesh `number` of those that `seed` stands for. The same on every machine, whatever came before it.
[[nodiscard]] CoverageTally try_mesh_number(std::uint32_t seed, std::uint32_t number, MeshKind& kind);

}  // namespace quadrille::models
