/// The first-level caches (vertex fetch, texture, depth, colour): tags, misses under way, and who waits for
/// them.
///
/// A miss table (models/cache/miss_table.h) serves all who want sectors of a line that is under way. Data lie
/// in `DeviceMemory`; only presence is kept. A cache that writes names itself as the owner of its dirty lines
/// there, so that a read from below it is noticed.
///
/// A sector that is written in part is not read first: a mask keeps which of its words (of 4 bytes) were
/// written. It becomes whole when the others are written too, or when someone reads it and the rest is
/// fetched; else it leaves as it is, and the level below completes it.
///
/// Lines of surfaces may be stored encoded (models/memory/stored_lines.h). Such a line is fetched whole, by
/// the sectors of its encoding. The owner of the cache decides how a line is stored that leaves it.
///
/// Where that is asked for, each miss is told its kind (models/cache/miss_kinds.h).
///
/// In a unit that keeps a log of its work (hw/base/work_log.h), a line that is written back counts for whom
/// it was written last, whoever takes its place.
#pragma once

#include "hw/memory/memory_port.h"
#include "models/cache/miss_kinds.h"
#include "models/cache/miss_table.h"
#include "models/cache/tag_array.h"
#include "models/memory/device_memory.h"

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

namespace quadrille::hw {

struct L1CacheStats {
  explicit L1CacheStats(StatGroup& group)
      : requests{group, "cache_requests", "request", "Look-ups of a line in the first-level cache"},
        hits{group, "cache_hits", "request", "Look-ups that found all their sectors"},
        merged{group, "cache_merged", "request",
               "Look-ups that found all their sectors on their way already"},
        misses{group, "cache_misses", "request", "Look-ups that had to ask the L2 cache for a sector"} {}
  void audit(Audit& audit, const Law& law) const {
    audit.both(law, requests.value(), hits.value() + merged.value() + misses.value());
  }
  Counter requests, hits, merged, misses;
};

/// Of a cache whose lines may be stored encoded.
struct EncodedReadStats {
  explicit EncodedReadStats(StatGroup& group)
      : lines{group, "encoded_reads", "line", "Lines fetched by their encodings"},
        bytes{group, "encoded_read_bytes", "byte", "Bytes that those moved"} {}
  Counter lines, bytes;
};

/// Of a cache that fetches sectors in groups.
struct SectorStats {
  explicit SectorStats(StatGroup& group)
      : filled{group, "sectors_filled", "sector", "Sectors of 32 bytes that were fetched"},
        used{group, "sectors_used", "sector",
             "Those of them that some look-up asked for, each once for every time it is fetched"} {}
  Counter filled, used;
};

/// Look-ups of a cache by what its ideal companions say of them.
struct MissKindCounts {
  std::array<std::uint64_t, models::kMissKinds> misses{};  ///< of the cache, by kind
  /// Look-ups that an LRU cache of as many lines would have missed in which any line may lie anywhere.
  std::uint64_t associative_misses = 0;
};

class L1Cache {
 public:
  /// A line that was written leaves the cache.
  struct Leaving {
    std::uint32_t line = 0;
    std::uint8_t dirty = 0, present = 0;  ///< sectors
    std::uint8_t parts = 0;               ///< sectors that were written in part and are not whole
  };
  /// Decides how lines are stored that leave.
  class Store {
   public:
    virtual ~Store() = default;
    /// The sectors to be written of it, beside those that leave in part.
    virtual std::uint8_t store(const Leaving& leaving) = 0;
  };
  enum class Result : std::uint8_t {
    kHit,      ///< present
    kPending,  ///< the waiter will be told
    kStall     ///< no way or no miss entry is free: try again after the next fill
  };
  /// `lines` of 128 bytes, `ways` a set, up to `misses` lines under way.
  L1Cache(StatGroup& stats, int lines, int ways, int misses,
          const models::ReplacementPolicy& replacement = models::kLruReplacement);
  /// From here on the cache may write: it marks its dirty lines as `owner`'s.
  void own_dirty_lines(models::DeviceMemory& memory, models::DeviceMemory::Owner owner) {
    memory_ = &memory;
    owner_ = owner;
    parts_.assign(static_cast<std::size_t>(tags_.slots()), 0);
  }

  /// From here on lines may be stored encoded.
  void read_encoded(const models::StoredLines& lines, EncodedReadStats& stats) {
    stored_lines_ = &lines;
    read_stats_ = &stats;
    expands_.assign(misses_.size(), false);
  }
  /// From here on sectors are fetched in aligned groups of so many (1, 2 or 4), and what is used of them is
  /// counted. Of a cache that only reads.
  void fetch_groups(int sectors, SectorStats& stats) {
    group_sectors_ = sectors;
    sector_stats_ = &stats;
    used_.assign(static_cast<std::size_t>(tags_.slots()), 0);
  }
  /// From here on `store` decides what is written of lines that leave.
  void store_through(Store& store) { store_ = &store; }

  /// From here on the kinds of misses are counted. Before the first look-up, of a cache that only reads.
  void keep_miss_kinds() { kinds_ = std::make_unique<Kinds>(static_cast<std::size_t>(tags_.slots())); }
  /// Null unless they are kept.
  [[nodiscard]] const MissKindCounts* miss_kinds() const { return kinds_ ? &kinds_->counts : nullptr; }

  /// Looks up sectors of a line; asks for what is missing through `port`.
  Result access(std::uint32_t line, std::uint8_t sectors, std::uint32_t waiter, MemoryPort& port);
  /// The same for a whole line whose contents are made of some sectors of another, as decoded texels are of
  /// compressed ones. Such lines have numbers of their own (`kMadeLines` and up). Needs `read_encoded`.
  Result access_made(std::uint32_t line, const models::StoredLines::Place& from, std::uint32_t waiter,
                     MemoryPort& port);
  static constexpr std::uint32_t kMadeLines = 0x80000000u;
  /// Takes an answer in; calls `ready(waiter)` once for each pending access that is now complete.
  template <class F>
  void fill(const MemoryResponse& response, F&& ready) {
    const std::uint8_t sectors = arrived(response);
    const bool all = misses_.arrive(response.tag, sectors);
    complete(misses_.slot_of(response.tag), sectors);
    if (all) misses_.release(response.tag, ready);
  }
  /// Gives the line a place and makes sectors (there may be none) present without fetching them, because they
  /// are about to be overwritten whole. False when no way is free: try again after a fill.
  bool claim(std::uint32_t line, std::uint8_t sectors, MemoryPort& port);
  [[nodiscard]] bool has_place(std::uint32_t line) const {
    return tags_.find(line) != models::TagArray::kNone;
  }
  /// These sectors are there, and nothing of the line is under way.
  [[nodiscard]] bool holds(std::uint32_t line, std::uint8_t sectors) const {
    const int slot = tags_.find(line);
    if (slot == models::TagArray::kNone) return false;
    return (tags_.at(slot).valid & sectors) == sectors && tags_.at(slot).pending == 0;
  }
  [[nodiscard]] std::uint8_t dirty_sectors(std::uint32_t line) const {
    const int slot = tags_.find(line);
    return slot == models::TagArray::kNone ? models::SectorMask{0} : tags_.at(slot).dirty;
  }
  /// Words (bit 0 the first of 32) of a line that has a place were written.
  void write(std::uint32_t line, std::uint32_t words);
  /// Forgets all lines of a cache that does not write; nothing may be under way.
  void forget();
  /// Nothing of this line, which is there, has to be written.
  void clean(std::uint32_t line);
  /// Forgets what was written to lines `first` to before `end`: nobody will read it.
  void discard(std::uint32_t first, std::uint32_t end);
  /// Queues all dirty sectors for writing and forgets all lines; nothing may be under way.
  void flush(MemoryPort& port);
  /// No more lines may be asked for.
  [[nodiscard]] bool full() const { return misses_.full(); }
  [[nodiscard]] bool idle() const { return misses_.idle(); }
  [[nodiscard]] const L1CacheStats& stats() const { return stats_; }

 private:
  struct Kinds {
    explicit Kinds(std::size_t lines) : ideal(lines) {}
    models::MissKinds ideal;
    MissKindCounts counts;
  };
  /// A look-up was counted, of which a miss brings `brought`.
  void note_kind(std::uint32_t line, std::uint8_t sectors, std::uint8_t brought, bool missed);
  Result hit(std::uint32_t line, std::uint8_t sectors, std::uint8_t brought);
  int place(std::uint32_t line, MemoryPort& port);
  /// Sectors became whole: what was written of them in parts is in them now.
  void complete(int slot, std::uint8_t sectors);
  void write_back(int slot, Leaving leaving, MemoryPort& port);
  void send_back(const Leaving& leaving, MemoryPort& port);
  /// `sectors` are wanted, and `brought` asked for.
  Result ask(int slot, std::uint32_t line, std::uint8_t sectors, std::uint8_t brought, std::uint32_t waiter,
             MemoryPort& port, const models::StoredLines::Place* whole_from);
  void fetch(std::uint32_t line, std::uint8_t missing, std::uint32_t tag, MemoryPort& port,
             const models::StoredLines::Place* whole_from);
  /// The sectors that an answer brings: all of the line if its encoding was asked for.
  [[nodiscard]] std::uint8_t arrived(const MemoryResponse& response);
  void note_writer(int slot);
  /// The groups that these sectors lie in.
  [[nodiscard]] std::uint8_t groups_of(std::uint8_t sectors) const;
  void note_used(int slot, std::uint8_t sectors) {
    std::uint8_t& used = used_[static_cast<std::size_t>(slot)];
    const auto fresh = static_cast<std::uint8_t>(sectors & ~used);
    if (fresh == 0) return;
    used |= fresh;
    sector_stats_->used += static_cast<std::uint64_t>(std::popcount(fresh));
  }

  models::TagArray tags_;
  models::MissTable<std::uint32_t> misses_;
  models::DeviceMemory* memory_ = nullptr;
  models::DeviceMemory::Owner owner_ = models::DeviceMemory::kClean;
  StatGroup& group_;
  /// by slot: for whom a dirty line was written last, while the unit keeps a log
  std::vector<Work> writers_;
  /// by slot: words written of sectors that are not whole; empty in a cache that does not write
  std::vector<std::uint32_t> parts_;
  const models::StoredLines* stored_lines_ = nullptr;  ///< null: all lines are plain
  EncodedReadStats* read_stats_ = nullptr;
  Store* store_ = nullptr;  ///< null: dirty sectors are written
  int group_sectors_ = 1;
  SectorStats* sector_stats_ = nullptr;  ///< null: what is used of sectors is not counted
  std::vector<std::uint8_t> used_;       ///< by slot: sectors that were asked for; empty if it is not counted
  std::vector<bool> expands_;            ///< by tag: what was asked for is the line's encoding
  std::unique_ptr<Kinds> kinds_;         ///< null: nobody asks for kinds of misses
  L1CacheStats stats_;
};

}  // namespace quadrille::hw
