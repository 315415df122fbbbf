/// The next core in turn gets the warp; one without room is passed over.
#include "hw/shader/distribution.h"

namespace quadrille::hw {

namespace {

class RoundRobinDistribution final : public Distribution {
 public:
  [[nodiscard]] std::size_t choose(const Cores& cores) const override {
    for (std::size_t i = 0; i < cores.loads.size(); ++i) {
      const std::size_t core = (cores.next + i) % cores.loads.size();
      if (cores.has_room(core)) return core;
    }
    return kNone;
  }
};

}  // namespace

constinit const DistributionPolicy kRoundRobinDistribution{
    "round_robin", "the next core in turn: it needs to know nothing of the cores",
    [](const DistributionSetup& /*setup*/) -> std::unique_ptr<Distribution> {
      return std::make_unique<RoundRobinDistribution>();
    }};

}  // namespace quadrille::hw
