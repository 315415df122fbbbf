/// Resolves the colour attachments of a pass when it ends, in one partition: reads the samples of each tile
/// through the colour cache, where the latest ones still are, and writes their means there.
///
/// A tile that nothing was drawn to moves nothing: what it is resolved to counts as cleared too. The samples
/// are gone afterwards unless the attachment is stored.
#pragma once

#include "hw/base/waiting_queue.h"
#include "hw/frame/frame.h"
#include "hw/rop/surface_cache.h"

#include <vector>

namespace quadrille::hw {

class Resolve {
 public:
  /// Of the unit that has this cache and port, which outlive it.
  Resolve(models::DeviceMemory& memory, SurfaceCache& cache, MemoryPort& port)
      : memory_(memory), cache_(cache), port_(port) {}

  /// All that the pass drew is in the cache or in memory. Up to `in_flight` tiles wait for their samples.
  void begin(const PassState& pass, PartitionId partition, std::uint32_t partitions, int in_flight);
  [[nodiscard]] bool running() const { return running_; }
  /// When the next step can be done, `free` or later; kNever while it waits for memory.
  [[nodiscard]] Tick next(Tick free) const;
  /// What a step did: tiles resolved, those of them that nothing was drawn to, and the cost of the others.
  struct Done {
    int tiles = 0, cleared = 0, quads = 0;
  };
  /// Asks for the samples of another tile, and resolves one whose samples are there; when none is left, ends.
  Done step(Tick now);
  /// Is this one of its look-ups, by the number that the cache knows it by? Then it is answered.
  bool answer(std::uint32_t number, Tick now) {
    stalled_ = false;
    if ((number & kOwn) == 0) return false;
    tiles_.answer(number & ~kOwn, now);
    return true;
  }

 private:
  /// Marks its numbers among those of the unit.
  static constexpr std::uint32_t kOwn = 0x80000000u;
  struct Tile {
    std::size_t color = 0;
    std::uint32_t x = 0, y = 0;
    int missing = 0;
    Tick ready = 0;
    std::uint32_t parts = 0;  ///< samples, and then the tile itself, that are acquired
    AcquiredLines done{};     ///< of `SurfaceCache::acquire`, of the next one
  };
  [[nodiscard]] bool acquired(const Tile& tile) const {
    return tile.parts > static_cast<std::uint32_t>(pass_->samples);
  }
  /// The newest tile lacks something, or there is another one and room for it.
  [[nodiscard]] bool can_ask() const;
  [[nodiscard]] bool head_ready() const;
  [[nodiscard]] bool newest_acquired() const { return tiles_.empty() || acquired(tiles_[tiles_.size() - 1]); }
  /// Nothing was drawn to the next tile, and its turn has come.
  [[nodiscard]] bool next_is_cleared() const;
  void find_next();
  void advance();
  void ask(Tick now);
  [[nodiscard]] bool resolve(const Tile& tile);
  [[nodiscard]] SurfaceTile target_of(const Tile& tile) const {
    return {surface_[tile.color], tile.x, tile.y, 0};
  }

  models::DeviceMemory& memory_;
  SurfaceCache& cache_;
  MemoryPort& port_;
  const PassState* pass_ = nullptr;
  PartitionId partition_;
  std::uint32_t partitions_ = 1;
  std::size_t in_flight_ = 1;
  std::array<std::size_t, models::kMaxColorAttachments>
      surface_{};  ///< in the cache, of what it is resolved to
  Tile next_;      ///< the first that nothing was asked of; its `color` is the count when there is none
  WaitingQueue<Tile> tiles_;
  bool running_ = false;
  bool stalled_ = false;  ///< the cache had no place; an answer will make one
};

}  // namespace quadrille::hw
