/// The policies of the shader cores and of who feeds them. A new one is its file and its name here.
#include "hw/shader/distribution.h"
#include "hw/shader/simd_sharing.h"

namespace quadrille::hw {

PolicyList<DistributionPolicy>& distribution_policies() {
  static PolicyList<DistributionPolicy> all{&kRoundRobinDistribution, &kTileDistribution,
                                            &kLeastLoadedDistribution};
  return all;
}

PolicyList<SimdSharingPolicy>& simd_sharing_policies() {
  static PolicyList<SimdSharingPolicy> all{&kOldestSharing, &kRoundRobinSharing};
  return all;
}

}  // namespace quadrille::hw
