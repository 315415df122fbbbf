/// A row of tiles that spans are gathered in: what a rasteriser that walks edges holds until it has walked
/// all rows of the tiles.
#pragma once

#include "models/raster/edge_walk.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

/// By sample; quad-major bits.
using TileCoverage = std::array<std::uint64_t, kMaxSamples>;

class SpanTiles {
 public:
  struct Tile {
    std::int32_t tile_x = 0, tile_y = 0;
    bool full = false;  ///< all samples of its 64 pixels
    TileCoverage coverage{};
  };
  SpanTiles() = default;
  /// For a primitive within `bounds`. With `whole_pixels` a row holds for all samples of its pixels.
  SpanTiles(const PixelRect& bounds, int samples, bool whole_pixels);
  /// Adds a span to the row of tiles that it lies in; all spans between two `take` to the end lie in one.
  void add(const SampleRow& span);
  /// Takes out the next tile with a span, from the left; false at the end, and the row is empty again.
  bool take(Tile& tile);

 private:
  std::vector<TileCoverage> tiles_;  ///< from tile `left_` on
  std::int32_t left_ = 0, tile_y_ = 0;
  std::int32_t first_ = INT32_MAX, last_ = -1;  ///< tiles that hold spans lie between
  std::size_t samples_ = 1;
  bool whole_pixels_ = false;
};

}  // namespace quadrille::models
