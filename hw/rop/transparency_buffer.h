/// What a ROP keeps of order-independent draws until their pass ends: layers of entries or lists of nodes
/// (hw/frame/transparency.h), which are surfaces of its colour cache that no one sees.
///
/// The layers of a k-buffer are planes, read and written like samples. Of an A-buffer a pixel has a head;
/// nodes are appended at a counter of the partition, as GPUs append through an atomic counter of the L2
/// cache, so those of a warp lie side by side. Warps retire in order, so a pixel's list is in API order.
#pragma once

#include "hw/frame/transparency.h"
#include "hw/rop/surface_cache.h"
#include "hw/rop/touched_tiles.h"

namespace quadrille::hw {

struct TransparencyStats {
  explicit TransparencyStats(StatGroup& group)
      : nodes{group, "nodes", "node",
              "Fragments of order-independent draws that came to lists of nodes, or samples of them that "
              "came "
              "to layers"},
        merged{group, "nodes_merged", "node", "Of those that came to layers: two became one"},
        lost{group, "nodes_lost", "node", "Of those that came to lists: the pixel held as many as it may"},
        composed{group, "nodes_composed", "node", "Nodes put over the colours when a pass ended"},
        tiles{group, "composed_tiles", "tile", "Tiles that had nodes when a pass ended"},
        a_tile{group, "nodes_a_pixel", "node",
               "Most nodes of a pixel or sample, of each tile that had some"} {}
  Counter nodes, merged, lost, composed, tiles;
  Histogram a_tile;
};

class TransparencyBuffer {
 public:
  TransparencyBuffer(StatGroup& group, models::DeviceMemory& memory, SurfaceCache& cache, MemoryPort& port)
      : stats_(group), memory_(memory), cache_(cache), port_(port) {}

  /// After the cache began the pass.
  void begin_pass(const PassState& pass, PartitionId partition, std::uint32_t partitions);
  /// Calls `visit(tile of a surface, wishes)` for all that a warp reads and writes and that is known before
  /// it retires.
  template <class Visit>
  void visit_tiles(const WarpSlot& warp, int samples, const Visit& visit) const {
    const bool lists = pass_->transparency.lists();
    const std::uint32_t bytes = pass_->transparency.hidden.surface.pixel_bytes;
    const TouchedTiles touched(warp, lists ? 1 : samples);
    for (const TileTouch& touch : touched.all()) {
      const SectorWishes wishes = wishes_of_write(touch.pixels, bytes, true);
      for (std::uint32_t l = 0; l < planes(); ++l)
        visit(SurfaceTile{hidden_, touch.tile_x, touch.tile_y, touch.sample * planes() + l}, wishes);
    }
  }
  /// Takes the places of all that a warp writes; false when there is none now.
  bool claim(const WarpSlot& warp, int samples);
  /// Keeps the fragments of the warp that `claim` has just taken places for. Returns what that takes, in
  /// turns of a quad.
  int put(const DrawState& draw, const WarpSlot& warp);

  [[nodiscard]] const PassState& pass() const { return *pass_; }
  [[nodiscard]] SurfaceTile head_tile(std::uint32_t x, std::uint32_t y, std::uint32_t plane = 0) const {
    return {hidden_, x, y, plane};
  }
  /// The block of the pool that holds a node, by its number from 0.
  [[nodiscard]] SurfaceTile block_of(std::uint32_t node) const {
    return {pool_surface_, 0, node / models::kTilePixels, 0};
  }
  [[nodiscard]] TransparencyStats& stats() { return stats_; }
  void audit(Audit& audit) const;

  /// Turns in which a quad of nodes, or of entries, goes to or comes from the cache.
  static constexpr int kNodeTurns = models::kNodeBytes / 4;
  static constexpr int kHeadTurns = models::kListHeadBytes / 4;

 private:
  /// Of the hidden surface, for each sample.
  [[nodiscard]] std::uint32_t planes() const {
    return pass_->transparency.lists() ? 1u : static_cast<std::uint32_t>(pass_->transparency.layers);
  }
  int put_layers_of(const DrawState& draw, const WarpSlot& warp);

  TransparencyStats stats_;
  models::DeviceMemory& memory_;
  SurfaceCache& cache_;
  MemoryPort& port_;
  const PassState* pass_ = nullptr;
  std::size_t hidden_ = 0, pool_surface_ = 0;  ///< numbers in the cache
  NodePool pool_;
  AppendPlan plan_;  ///< of the warp that was claimed last
};

}  // namespace quadrille::hw
