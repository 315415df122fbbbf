/// Meshes whose triangles share edges and vertices, of every kind that is hard to cover exactly once.
///
/// A mesh is 1e-3 to 1e5 pixels across, and some point of it lies in the window that is looked at, however
/// large it is. Slivers are 1 to 1/65536 pixel thin. In some meshes vertices lie on samples.
#pragma once

#include "tests/models/random_source.h"
#include "tests/models/raster/coverage_oracle.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::models {

enum class MeshKind : std::uint8_t { kFan, kStrip, kGrid, kSliverFan, kSliverStrip };
inline constexpr std::array<const char*, 5> kMeshKindNames{"fan", "strip", "grid", "sliver fan",
                                                           "sliver strip"};

/// Positions in pixels of the window, and triangles as three of them. Where no position is rounded across
/// another, all triangles run the same way round.
struct CoverageMesh {
  MeshKind kind = MeshKind::kFan;
  std::vector<glm::vec2> at;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A window somewhere in a target of 16384 pixels; often near its first pixel, where floats hold 1/65536
/// pixel.
[[nodiscard]] CoverageWindow random_window(RandomSource& random);
/// A mesh of which a part lies in the window.
[[nodiscard]] CoverageMesh random_mesh(RandomSource& random, const CoverageWindow& window);

}  // namespace quadrille::models
