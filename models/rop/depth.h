/// Depth test of a tile, and the bound that Hi-Z is told of one. [VK1.3 #fragops-depth]
#pragma once

#include "models/base/pipeline_state.h"

#include <cstdint>

namespace quadrille::models {

/// Pixels of `mask` for which `incoming op stored` holds; arrays and mask are quad-major (raster/tile.h).
/// NaN compares as unordered: it fails all but kNotEqual and kAlways.
[[nodiscard]] std::uint64_t depth_test(CompareOp op, const float stored[64], const float incoming[64],
                                       std::uint64_t mask);

/// Writes `incoming` where `mask` is set.
void depth_write(float stored[64], const float incoming[64], std::uint64_t mask);

/// Greatest depth of a tile. A NaN, which only a shader can write, counts as +infinity, so that the bound
/// stays conservative.
[[nodiscard]] float tile_max(const float depths[64]);

}  // namespace quadrille::models
