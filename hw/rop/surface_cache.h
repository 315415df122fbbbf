/// What the depth and the colour unit share: a first-level cache over a surface of 8x8 tiles, with fast
/// clear.
///
/// A clear writes no memory: it marks tiles, and the first access to a marked tile finds all of it present.
/// What is still marked at a flush is written then (colour) or stays a mark (depth, which nobody reads after
/// the pass). A tile is two lines of 128 bytes, eight sectors of two quads each.
#pragma once

#include "hw/memory/l1_cache.h"
#include "models/memory/surface.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::hw {

/// Sectors (bits 0..7 of a tile) that a set of quads (bits 0..15) lies in.
[[nodiscard]] constexpr std::uint8_t sectors_of_quads(std::uint32_t quads) {
  std::uint32_t pairs = (quads | quads >> 1) & 0x5555u;
  pairs = (pairs | pairs >> 1) & 0x3333u;
  pairs = (pairs | pairs >> 2) & 0x0f0fu;
  return static_cast<std::uint8_t>((pairs | pairs >> 4) & 0xffu);
}

/// Pixels of a tile by sector: bit 0 to 3 those of its first quad, 4 to 7 of its second.
using SectorPixels = std::array<std::uint8_t, 8>;

/// Sectors of a tile, a bit each, by what will be done with them.
struct SectorWishes {
  std::uint8_t read = 0, write = 0, part = 0;
};

struct SurfaceCacheStats {
  explicit SurfaceCacheStats(StatGroup& group)
      : cleared_tiles{group, "fast_cleared_tiles", "tile",
                      "Tiles marked as cleared instead of being written"},
        clear_hits{group, "clear_hits", "tile", "First accesses to a marked tile, which fetch nothing"},
        clear_writes{group, "clear_writes", "tile", "Marked tiles written out by a flush"} {}
  Counter cleared_tiles, clear_hits, clear_writes;
};

/// The surfaces that a partition writes through a cache.
enum class SurfaceKind : std::uint8_t { kDepth, kColor };
/// Who may write a line of memory while it is dirty: the cache of that surface in that partition.
[[nodiscard]] constexpr models::DeviceMemory::Owner surface_writer(SurfaceKind surface, int partition) {
  return static_cast<models::DeviceMemory::Owner>(1 + 2 * partition +
                                                  (surface == SurfaceKind::kColor ? 1 : 0));
}

class SurfaceCache {
 public:
  SurfaceCache(StatGroup& stats, int lines, int ways, int misses, models::DeviceMemory& memory,
               models::DeviceMemory::Owner owner);

  /// Begins a pass on `surface`: fills this partition's tiles with `value` and marks them.
  void clear(const models::SurfaceLayout& surface, std::uint32_t value, std::uint32_t partition,
             std::uint32_t partitions);
  /// Asks for sectors of a tile: those in `read` with their contents, and a place for those in `write`, which
  /// will be overwritten whole, and in `part`. Adds what is not there yet to `missing` and tells `waiter` of
  /// each. False when there is no place now: try again after a fill, with the same `done`, which starts at 0
  /// and remembers what was asked for already, so that even a cache of one line gets through.
  bool acquire(std::uint32_t tile_x, std::uint32_t tile_y, const SectorWishes& wishes, std::uint32_t waiter,
               int& missing, std::uint8_t& done, MemoryPort& port);
  /// Pixels of a tile were written. Takes back a line that was evicted since it was acquired; false when
  /// there is no place for it now.
  bool write(std::uint32_t tile_x, std::uint32_t tile_y, const SectorPixels& pixels, MemoryPort& port);
  template <class F>
  void fill(const MemoryResponse& response, F&& ready) {
    cache_.fill(response, std::forward<F>(ready));
  }
  /// Queues everything dirty for writing; with `write_cleared` the tiles still marked too.
  void flush(MemoryPort& port, bool write_cleared);
  [[nodiscard]] bool full() const { return cache_.full(); }
  [[nodiscard]] bool idle() const { return cache_.idle(); }
  [[nodiscard]] const L1CacheStats& stats() const { return cache_.stats(); }

 private:
  [[nodiscard]] std::uint32_t line_of(std::uint32_t tile_x, std::uint32_t tile_y) const {
    return static_cast<std::uint32_t>(surface_.tile_address(tile_x, tile_y) / models::kLineBytes);
  }
  bool materialize(std::uint32_t tile_x, std::uint32_t tile_y, std::uint8_t& done, MemoryPort& port);

  L1Cache cache_;
  models::DeviceMemory& memory_;
  StatGroup& group_;
  SurfaceCacheStats stats_;
  models::SurfaceLayout surface_;
  std::vector<bool> cleared_;  ///< by tile
};

}  // namespace quadrille::hw
