/// The policies of the rasteriser. A new one is its file and its name here.
#include "hw/raster/traversal.h"

namespace quadrille::hw {

PolicyList<TraversalPolicy>& traversal_policies() {
  static PolicyList<TraversalPolicy> all{&kEdgeFunctions, &kEdgeWalking};
  return all;
}

}  // namespace quadrille::hw
