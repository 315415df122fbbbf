/// Fragment warps go to the core of their part of the screen, so that neighbours meet in one texture cache.
/// Batches of vertices have no place on the screen and go by load.
#include "hw/shader/distribution.h"

#include "models/memory/interleave.h"

namespace quadrille::hw {

namespace {

class TileDistribution final : public Distribution {
 public:
  explicit TileDistribution(const DistributionSetup& setup) : setup_(setup) {}
  [[nodiscard]] std::size_t choose(const Cores& cores) const override { return least_loaded(cores); }
  [[nodiscard]] bool by_place() const override { return true; }
  [[nodiscard]] std::size_t core_at(const FragmentWarpToken& warp) const override {
    // The squares are spread over the cores as tiles are over partitions.
    return models::partition_of(warp.tile_x / setup_.block_tiles, warp.tile_y / setup_.block_tiles,
                                setup_.cores)
        .index();
  }

 private:
  DistributionSetup setup_;
};

}  // namespace

constinit const DistributionPolicy kTileDistribution{
    "tile", "fragments by their part of the screen: neighbours share a texture cache, and a busy part waits",
    [](const DistributionSetup& setup) -> std::unique_ptr<Distribution> {
      return std::make_unique<TileDistribution>(setup);
    }};

}  // namespace quadrille::hw
