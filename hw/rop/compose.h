/// Puts what order-independent draws have left over the colours of their pass when it ends, in one
/// partition, tile by tile, before samples are resolved.
///
/// The layers of a k-buffer are read as planes. Lists are walked: the heads of a tile, then the first nodes
/// of all its pixels, a line a cycle, and with these the places of the next ones; a node is known when the
/// one before it has come. Up to as many tiles as warps wait for colours are walked at a time. Tiles without
/// nodes move nothing and take no time.
///
/// Time  a quad of a sample takes twice its path for its colours; a quad of entries or nodes takes four
///       turns to be read, in which it is sorted in and blended, or one for each of its samples if there are
///       more than four
#pragma once

#include "hw/base/waiting_queue.h"
#include "hw/rop/transparency_buffer.h"

#include <array>

namespace quadrille::hw {

class Compose {
 public:
  /// Of the unit that has these, which outlive it.
  Compose(models::DeviceMemory& memory, SurfaceCache& cache, MemoryPort& port, TransparencyBuffer& buffer)
      : memory_(memory), cache_(cache), port_(port), buffer_(buffer) {}

  /// All that the pass drew is in the cache or in memory. Up to `in_flight` tiles are under way.
  void begin(PartitionId partition, std::uint32_t partitions, int in_flight);
  [[nodiscard]] bool running() const { return running_; }
  /// When the next step can be done, `free` or later; kNever while it waits for memory.
  [[nodiscard]] Tick next(Tick free) const;
  /// Asks for one thing more, and composes the front tile if all of it is there; when none is left, ends.
  /// Returns what it takes, in turns of a quad.
  int step(Tick now);
  /// Is this one of its look-ups, by the number that the cache knows it by? Then it is answered.
  bool answer(std::uint32_t number, Tick now) {
    if ((number & kOwn) == 0) return false;
    tiles_.answer(number & ~kOwn, now);
    return true;
  }
  /// An answer has come, whoever's: there may be a place in the cache.
  void wake() { stalled_ = false; }

 private:
  /// Marks its numbers among those of the unit.
  static constexpr std::uint32_t kOwn = 0x80000000u;
  struct Tile {
    std::uint32_t x = 0, y = 0;
    int missing = 0;
    Tick ready = 0;
    std::uint32_t parts = 0;  ///< planes of nodes and colours that are acquired
    AcquiredLines done{};     ///< of `SurfaceCache::acquire`, of the next one
    bool walking = false;     ///< its heads are known
    std::uint64_t left = 0,
                  unasked = 0;  ///< pixels whose lists go on; those whose next node was not asked for
    std::array<std::uint32_t, models::kTilePixels> node{};  ///< the next one of each, from 1
  };
  [[nodiscard]] const PassState& pass() const { return buffer_.pass(); }
  /// Planes of heads or entries, all samples'.
  [[nodiscard]] std::uint32_t hidden_planes() const { return pass().transparency.hidden.surface.samples; }
  [[nodiscard]] bool acquired(const Tile& tile) const {
    return tile.parts == hidden_planes() + static_cast<std::uint32_t>(pass().samples);
  }
  [[nodiscard]] bool complete(const Tile& tile) const {
    return acquired(tile) && tile.missing == 0 &&
           (!pass().transparency.lists() || (tile.walking && tile.left == 0));
  }
  [[nodiscard]] bool has_next() const { return next_.y < pass().transparency.hidden.surface.tiles_y; }
  /// When a tile that is under way can ask for more or go on, `free` or later.
  [[nodiscard]] Tick tile_next(const Tile& tile, Tick free) const;
  void find_next();
  void ask(Tick now);
  void acquire(Tile& tile, std::uint32_t number, Tick now);
  void walk(Tile& tile, std::uint32_t number, Tick now);
  void follow(Tile& tile) const;
  [[nodiscard]] int compose(const Tile& tile);
  [[nodiscard]] int turns_of(const TileNodes& nodes) const;

  models::DeviceMemory& memory_;
  SurfaceCache& cache_;
  MemoryPort& port_;
  TransparencyBuffer& buffer_;
  PartitionId partition_;
  std::uint32_t partitions_ = 1;
  std::size_t in_flight_ = 1;
  Tile next_;  ///< the first that nothing was asked of
  WaitingQueue<Tile> tiles_;
  bool running_ = false;
  bool stalled_ = false;  ///< the cache had no place; an answer will make one
};

}  // namespace quadrille::hw
