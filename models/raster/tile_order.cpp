/// The orders of tiles. A new one is its file and its name here.
#include "models/raster/tile_order.h"

namespace quadrille::models {

PolicyList<TileOrderPolicy>& tile_order_policies() {
  static PolicyList<TileOrderPolicy> all{&kScanTileOrder, &kMortonTileOrder, &kHilbertTileOrder};
  return all;
}

}  // namespace quadrille::models
