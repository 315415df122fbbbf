/// The tiles of a surface that a warp's live pixels lie in.
#pragma once

#include "hw/frame/stores.h"
#include "hw/rop/surface_cache.h"
#include "models/raster/quad_place.h"

#include <array>
#include <cstdint>
#include <span>

namespace quadrille::hw {

/// Live pixels of a warp in one tile, of one sample.
struct TileTouch {
  std::uint32_t tile_x = 0, tile_y = 0, sample = 0;
  std::uint64_t pixels = 0;
  [[nodiscard]] SurfaceTile tile_of(std::size_t surface) const { return {surface, tile_x, tile_y, sample}; }
};

/// A warp's live quads by tile and sample; at most one entry a quad and sample.
class TouchedTiles {
 public:
  TouchedTiles(const WarpSlot& warp, int samples) {
    for (int s = 0; s < samples; ++s) {
      const std::size_t first = count_;
      for (int q = 0; q < warp.quads; ++q)
        add(warp.quad[static_cast<std::size_t>(q)], warp.lanes_of(q, samples, s), s, first);
    }
  }
  [[nodiscard]] std::span<const TileTouch> all() const { return std::span(tiles_).first(count_); }

 private:
  /// `first`: of the entries of this sample.
  void add(const WarpSlot::Quad& quad, models::LaneMask lanes, int sample, std::size_t first) {
    if (lanes == 0) return;
    const models::QuadPlace place = models::place_of_quad(quad.x, quad.y);
    std::size_t i = first;
    while (i < count_ && (tiles_[i].tile_x != place.tile_x || tiles_[i].tile_y != place.tile_y)) ++i;
    if (i == count_) tiles_[count_++] = {place.tile_x, place.tile_y, static_cast<std::uint32_t>(sample), {}};
    tiles_[i].pixels |= std::uint64_t{lanes} << place.first_pixel();
  }

  std::array<TileTouch, std::size_t{models::kWarpQuads} * models::kMaxSamples> tiles_;
  std::size_t count_ = 0;
};

}  // namespace quadrille::hw
