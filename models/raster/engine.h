/// Raster engines side by side: each sets up and rasterises what falls on its part of the screen.
///
/// Engine e of n has the screen partitions e, e + n, e + 2 n, ... So every tile has one engine, the fragments
/// of a partition come from one engine alone, and they stay in order. [P: Molnar 1994, sort-middle]
#pragma once

#include "models/memory/interleave.h"
#include "models/raster/viewport.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

[[nodiscard]] inline std::uint32_t engine_of_partition(PartitionId partition, std::uint32_t engines) {
  return partition.index() % engines;
}

/// How the screen is shared out.
struct ScreenShare {
  std::uint32_t partitions = 1;  ///< a multiple of `engines`
  std::uint32_t engines = 1;
  [[nodiscard]] std::uint32_t engine_of_tile(std::uint32_t tile_x, std::uint32_t tile_y) const {
    return engine_of_partition(partition_of(tile_x, tile_y, partitions), engines);
  }
};

/// Engines whose tiles a triangle may touch, a bit each: by the tiles of its bounding box where they are few,
/// else all. At least one: a triangle that touches no tile of the screen goes to engine `turn` of them.
/// `width` and `height` of the screen in pixels. `reach`: how far pixels may lie beyond the box, in units of
/// the grid.
[[nodiscard]] std::uint32_t engines_touched(const std::array<WindowVertex, 3>& triangle, std::int32_t reach,
                                            int subpixel_bits, std::uint32_t width, std::uint32_t height,
                                            const ScreenShare& share, std::uint32_t turn);

}  // namespace quadrille::models
