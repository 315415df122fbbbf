/// Coarse rasterisation: the 8x8-pixel tiles that a triangle, line or point touches, row by row, left to
/// right.
///
/// A tile is kept unless all its samples are outside one edge (exact for each edge, at the sample of the tile
/// that is deepest inside). Along a row the kept tiles are one interval, found by a division an edge; so the
/// walk costs what it keeps, however large the triangle. What the hardware is charged (`tests`) is the same
/// walk done by testing: every kept tile, and one failing tile where a row's interval ends short of the
/// bounding box on either side; a row without tiles costs one.
#pragma once

#include "models/raster/triangle_setup.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

struct TileHit {
  std::int32_t tile_x = 0, tile_y = 0;  ///< pixel position / 8
  bool fully_covered = false;  ///< all samples of its 64 pixels are inside the triangle and its bounds
};

class TileWalk {
 public:
  TileWalk() = default;
  /// Copies what it needs; the set-up need not outlive the walk.
  explicit TileWalk(const TriangleSetup& triangle, const SampleGrid& samples = {});
  /// The next tile; false at the end.
  bool next(TileHit& hit);
  /// Tile tests so far, the failing ones included.
  [[nodiscard]] std::uint64_t tests() const { return tests_; }

 private:
  void enter_row();

  std::size_t edge_count_ = 0;
  std::array<EdgeFunction, 4> edges_;  // stepped by tiles
  // what the best and the worst pixel of a tile add to its first one
  std::array<std::int64_t, 4> best_{}, worst_{};
  std::int32_t first_x_ = 0, last_x_ = -1, last_y_ = -1;  // tiles of the bounding box
  // tiles that lie wholly within the bounds
  std::int32_t full_x0_ = 0, full_y0_ = 0, full_x1_ = 0, full_y1_ = 0;
  std::int32_t x_ = 0, row_last_x_ = -1, y_ = 0;
  std::uint64_t tests_ = 0;
};

}  // namespace quadrille::models
