/// In which order the tiles of a triangle are rasterised, one file a policy (tile_order_*.cpp).
///
/// Tiles of one triangle share no pixel, so the order changes no picture: it changes which lines of textures,
/// depths and colours are asked for one after the other.
#pragma once

#include "models/base/policy.h"

#include <cstdint>

namespace quadrille::models {

class TileOrder {
 public:
  virtual ~TileOrder() = default;
  /// The order is that in which a walk over the triangle finds the tiles (models/raster/coarse.h), by rows.
  [[nodiscard]] virtual bool as_walked() const { return false; }
  /// Of two tiles the one with the smaller place comes first; no two tiles have one place. Tiles are below
  /// 65536 in both directions.
  [[nodiscard]] virtual std::uint64_t place(std::uint32_t tile_x, std::uint32_t tile_y) const = 0;
};

using TileOrderPolicy = Policy<TileOrder>;
/// What `coarse_raster.order` chooses from.
[[nodiscard]] PolicyList<TileOrderPolicy>& tile_order_policies();
extern const TileOrderPolicy kScanTileOrder, kMortonTileOrder, kHilbertTileOrder;

}  // namespace quadrille::models
