/// What the depth and the colour unit share: a first-level cache over the surfaces of a pass (one for each
/// attachment) in 8x8 tiles, with fast clear.
///
/// A clear writes no memory: it marks tiles, and the first access to a marked tile finds all of it present.
/// What is still marked at a flush is written then, if anyone reads the surface after the pass. A surface
/// that is loaded begins without marks; one that is discarded leaves nothing to write. A tile is one line of
/// 128 bytes or up to eight, by the bytes of its pixels (models/memory/surface.h).
#pragma once

#include "hw/frame/frame.h"
#include "hw/memory/l1_cache.h"
#include "hw/rop/surface_encoder.h"
#include "models/memory/surface.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::hw {

/// A tile of one of the pass's surfaces; of several samples a pixel, its plane of one.
struct SurfaceTile {
  std::size_t surface = 0;
  std::uint32_t x = 0, y = 0;
  std::uint32_t sample = 0;
  friend bool operator==(const SurfaceTile&, const SurfaceTile&) = default;
};

/// Sectors of a tile, a bit each, by what will be done with them: read, written whole, or written in part.
struct SectorWishes {
  std::uint32_t read = 0, write = 0, part = 0;
};
/// Sectors that these pixels of a tile (a bit each, quad by quad) lie in.
[[nodiscard]] std::uint32_t sectors_of(std::uint64_t pixels, std::uint32_t pixel_bytes);
/// What a write of these pixels asks of their sectors. Caches know of words of 4 bytes who wrote them: where
/// smaller pixels fill some word in part, the rest of its sector is read first.
[[nodiscard]] SectorWishes wishes_of_write(std::uint64_t pixels, std::uint32_t pixel_bytes, bool reads_old);

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
[[nodiscard]] constexpr models::DeviceMemory::Owner surface_writer(SurfaceKind surface,
                                                                   PartitionId partition) {
  return static_cast<models::DeviceMemory::Owner>(1 + 2 * partition.index() +
                                                  (surface == SurfaceKind::kColor ? 1 : 0));
}

/// Lines of a tile, a bit each, that an access has got through with.
struct AcquiredLines {
  std::uint8_t materialized = 0, acquired = 0;
};

class SurfaceCache {
 public:
  SurfaceCache(StatGroup& stats, int lines, int ways, int misses, models::DeviceMemory& memory,
               models::DeviceMemory::Owner owner, const SurfaceCompression& compression = {});

  /// Begins a pass on these surfaces, of which this partition draws its tiles: what is not loaded is filled
  /// and marked. The attachments must outlive the pass.
  void begin_pass(std::span<const AttachmentState> surfaces, PartitionId partition, std::uint32_t partitions);
  /// A further surface of the pass, which begins as it is; returns its number.
  [[nodiscard]] std::size_t add_surface(const AttachmentState& surface);
  /// The same of one whose tiles are none of the screen.
  [[nodiscard]] std::size_t add_pool(const AttachmentState& surface);
  /// The same, which begins filled and marked as the surfaces of `begin_pass`.
  [[nodiscard]] std::size_t add_cleared(const AttachmentState& surface, PartitionId partition,
                                        std::uint32_t partitions);
  /// Nothing was drawn to the tile since the pass cleared it.
  [[nodiscard]] bool is_cleared(const SurfaceTile& tile) { return mark_of(tile); }
  /// The tile is cleared now, as far as memory is concerned: the caller writes the pixels. Nothing of it may
  /// be in the cache.
  void clear(const SurfaceTile& tile) {
    mark_of(tile) = true;
    ++stats_.cleared_tiles;
  }
  /// Asks for sectors of a tile: those in `read` with their contents, and a place for those in `write`, which
  /// will be overwritten whole, and in `part`. Adds what is not there yet to `missing` and tells `waiter` of
  /// each. False when there is no place now: try again after a fill, with the same `done`, which starts at 0
  /// and remembers what was asked for already, so that even a cache of one line gets through.
  bool acquire(const SurfaceTile& tile, const SectorWishes& wishes, std::uint32_t waiter, int& missing,
               AcquiredLines& done, MemoryPort& port);
  /// Pixels of a tile were written. Takes back a line that was evicted since it was acquired; false when
  /// there is no place for it now.
  bool write(const SurfaceTile& tile, std::uint64_t pixels, MemoryPort& port);
  /// Lines of later samples may be copies of those of the first.
  [[nodiscard]] bool keeps_copies() const { return encoder_.keeps_copies(); }
  /// The pixels of all writes so far are in memory.
  void pixels_written() { encoder_.pixels_written(); }
  template <class F>
  void fill(const MemoryResponse& response, F&& ready) {
    cache_.fill(response, [&](std::uint32_t waiter) {
      if (waiter != SurfaceEncoder::kNobody) ready(waiter);
    });
  }
  /// Ends the pass: queues for writing what is dirty in the surfaces that are stored, and what is still
  /// marked in those that someone reads later.
  void flush(MemoryPort& port);
  [[nodiscard]] bool full() const { return cache_.full(); }
  [[nodiscard]] bool idle() const { return cache_.idle(); }
  [[nodiscard]] const L1CacheStats& stats() const { return cache_.stats(); }
  void audit(Audit& audit, const Law& law, const MemoryPort& port) const {
    cache_.stats().audit(audit, law);
    encoder_.audit(audit, port);
  }

 private:
  struct Surface {
    const AttachmentState* state = nullptr;
    std::vector<bool> cleared;  ///< by plane of a tile
    bool on_screen = true;
  };
  [[nodiscard]] const models::SurfaceLayout& layout_of(const SurfaceTile& tile) const {
    return surfaces_[tile.surface].state->surface;
  }
  /// What is counted from here on is for this tile.
  void work_at(const SurfaceTile& tile) {
    if (surfaces_[tile.surface].on_screen) group_.working_at(tile.x, tile.y);
  }
  [[nodiscard]] std::uint32_t first_line_of(const SurfaceTile& tile) const {
    return static_cast<std::uint32_t>(layout_of(tile).tile_address(tile.x, tile.y, tile.sample) /
                                      models::kLineBytes);
  }
  [[nodiscard]] std::vector<bool>::reference mark_of(const SurfaceTile& tile) {
    Surface& surface = surfaces_[tile.surface];
    return surface.cleared[surface.state->surface.plane_number(tile.x, tile.y, tile.sample)];
  }
  void mark_cleared(Surface& surface, PartitionId partition, std::uint32_t partitions);
  /// What is asked for of a line so that an encoded one is fetched whole.
  struct LineWishes {
    std::uint32_t line = 0;  ///< the original of a copy
    std::uint8_t read = 0, write = 0;
    bool in_part = false;
  };
  [[nodiscard]] LineWishes line_wishes(const SurfaceTile& tile, std::uint32_t line,
                                       const SectorWishes& wishes) const;
  void write_marked(Surface& surface, MemoryPort& port);
  bool materialize(const SurfaceTile& tile, AcquiredLines& done, MemoryPort& port);

  L1Cache cache_;
  models::DeviceMemory& memory_;
  StatGroup& group_;
  SurfaceCacheStats stats_;
  EncodedReadStats read_stats_;
  SurfaceEncoder encoder_;
  /// attachments, what order-independent draws leave, and what the attachments are resolved to
  std::array<Surface, std::size_t{2} * models::kMaxColorAttachments> surfaces_;
  std::size_t count_ = 0;
};

}  // namespace quadrille::hw
