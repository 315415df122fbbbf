/// The core with the fewest warps gets the next one.
#include "hw/shader/distribution.h"

namespace quadrille::hw {

namespace {

class LeastLoadedDistribution final : public Distribution {
 public:
  [[nodiscard]] std::size_t choose(const Cores& cores) const override { return least_loaded(cores); }
};

}  // namespace

std::size_t Distribution::least_loaded(const Cores& cores) {
  std::size_t best = kNone;
  for (std::size_t i = 0; i < cores.loads.size(); ++i) {
    const std::size_t core = (cores.next + i) % cores.loads.size();
    if (!cores.has_room(core)) continue;
    if (best == kNone || cores.loads[core] < cores.loads[best]) best = core;
  }
  return best;
}

constinit const DistributionPolicy kLeastLoadedDistribution{
    "least_loaded",
    "the core with the fewest warps, sent and not reported done: none is idle while others queue",
    [](const DistributionSetup& /*setup*/) -> std::unique_ptr<Distribution> {
      return std::make_unique<LeastLoadedDistribution>();
    }};

}  // namespace quadrille::hw
