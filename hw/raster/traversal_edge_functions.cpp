/// Tiles are tested against the edges, and what the edges cut is left to the fine rasteriser. The engine is
/// charged for the tests of its own tiles and for its share of those that failed.
#include "hw/raster/traversal.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace quadrille::hw {
namespace {

class EdgeFunctions final : public Traversal {
 public:
  explicit EdgeFunctions(const TraversalSetup& setup) : setup_(setup), order_(setup.order.make()) {}

  std::int64_t begin(const models::TriangleSetup& triangle, const models::SampleGrid& samples) override {
    walk_ = models::TileWalk(triangle, samples);
    taken_tests_ = touched_ = owned_ = 0;
    if (!order_->as_walked()) sort_tiles();
    return 0;
  }

  bool next(Tile& tile) override {
    tile.walked = false;
    tile.next_row_clk = Tile::kNoRow;
    while (next_touched(tile.hit)) {
      ++touched_;
      if (!setup_.owns(tile.hit.tile_x, tile.hit.tile_y)) continue;
      ++owned_;
      return true;
    }
    return false;
  }

  Work take_work() override {
    const std::uint64_t kept = order_->as_walked() ? touched_ : sorted_.size();
    const std::uint64_t tests = owned_ + (walk_.tests() - kept) / setup_.screen.engines;
    return {.tests = tests - std::exchange(taken_tests_, tests)};
  }

  [[nodiscard]] std::string_view limited_by() const override { return "tests_per_clk"; }

 private:
  /// In the machine's order.
  bool next_touched(models::TileHit& tile) {
    if (order_->as_walked()) return walk_.next(tile);
    if (next_sorted_ == sorted_.size()) return false;
    tile = sorted_[next_sorted_++].second;
    return true;
  }

  void sort_tiles() {
    sorted_.clear();
    next_sorted_ = 0;
    models::TileHit tile;
    while (walk_.next(tile))
      sorted_.emplace_back(
          order_->place(static_cast<std::uint32_t>(tile.tile_x), static_cast<std::uint32_t>(tile.tile_y)),
          tile);
    std::ranges::sort(sorted_, {}, [](const auto& entry) { return entry.first; });
  }

  const TraversalSetup setup_;
  std::unique_ptr<models::TileOrder> order_;
  models::TileWalk walk_;
  /// of the walk, where they do not go on as they are found; with their places
  std::vector<std::pair<std::uint64_t, models::TileHit>> sorted_;
  std::size_t next_sorted_ = 0;
  std::uint64_t taken_tests_ = 0;          ///< of this walk
  std::uint64_t touched_ = 0, owned_ = 0;  ///< tiles of this walk, and those of them that are the engine's
};

}  // namespace

constinit const TraversalPolicy kEdgeFunctions{
    "edge_functions",
    "blocks of pixels, then pixels, are tested against the edges: all of a block at a time, in any order",
    [](const TraversalSetup& setup) -> std::unique_ptr<Traversal> {
      return std::make_unique<EdgeFunctions>(setup);
    }};

}  // namespace quadrille::hw
