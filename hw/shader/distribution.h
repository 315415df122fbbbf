/// Which core gets a warp, one file a policy (distribution_*.cpp).
#pragma once

#include "hw/frame/tokens.h"
#include "models/base/policy.h"

#include <cstdint>
#include <span>

namespace quadrille::hw {

class Distribution {
 public:
  /// What the work distributor knows of its cores.
  struct Cores {
    std::span<const int> loads;   ///< warps sent and not reported done
    std::uint64_t with_room = 0;  ///< a bit for each core that can take a warp now
    std::size_t next = 0;         ///< whose turn it is: the one after the latest to get a warp
    [[nodiscard]] bool has_room(std::size_t core) const { return (with_room >> core & 1) != 0; }
  };
  static constexpr std::size_t kNone = ~std::size_t{0};

  virtual ~Distribution() = default;
  /// Of the cores with room the one that gets a warp of any kind; kNone where none has room.
  [[nodiscard]] virtual std::size_t choose(const Cores& cores) const = 0;
  /// Do fragment warps go to the core of their place on the screen, and wait while it has no room?
  [[nodiscard]] virtual bool by_place() const { return false; }
  /// That core; asked only of a policy that goes `by_place`.
  [[nodiscard]] virtual std::size_t core_at(const FragmentWarpToken& /*warp*/) const { return 0; }

 protected:
  /// The core with the fewest warps of those with room; of equals the next in turn.
  [[nodiscard]] static std::size_t least_loaded(const Cores& cores);
};

struct DistributionSetup {
  std::uint32_t cores = 1;
  std::uint32_t block_tiles = 1;  ///< `tile`: side of the squares of tiles whose warps go to one core
};
using DistributionPolicy = Policy<Distribution, const DistributionSetup&>;
/// What `work_distributor.policy` chooses from.
[[nodiscard]] PolicyList<DistributionPolicy>& distribution_policies();
extern const DistributionPolicy kRoundRobinDistribution, kTileDistribution, kLeastLoadedDistribution;

}  // namespace quadrille::hw
