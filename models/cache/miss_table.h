/// The lines of a cache that are under way, and who waits for them: its miss status holding registers.
/// [P: Kroft 1981]
///
/// A line that is under way has one entry, named by its tag, whatever number of requests for its sectors it
/// takes. All who ask for sectors of the line meanwhile join the entry; they are told together, when nothing
/// of the line is under way any more, and the entry is free again. Which sectors those are, the tags keep
/// (models/cache/tag_array.h).
#pragma once

#include "models/base/error.h"
#include "models/cache/tag_array.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille::models {

/// `Waiter` is what the cache wants to know of one who waits.
template <class Waiter>
class MissTable {
 public:
  /// `tags` are those of the cache and outlive the table; up to `entries` lines are under way.
  MissTable(TagArray& tags, std::size_t entries)
      : tags_(tags), entries_(entries), entry_of_slot_(static_cast<std::size_t>(tags.slots()), kNoEntry) {
    free_.reserve(entries);
    for (std::size_t i = entries; i-- > 0;) free_.push_back(static_cast<std::uint32_t>(i));
  }
  MissTable(const MissTable&) = delete;
  MissTable& operator=(const MissTable&) = delete;

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::size_t under_way() const { return entries_.size() - free_.size(); }
  /// No further line can be asked for.
  [[nodiscard]] bool full() const { return free_.empty(); }
  [[nodiscard]] bool idle() const { return under_way() == 0; }

  /// The line's entry, and which of its sectors nobody has asked for: the others are there, or on their way
  /// already.
  struct Asked {
    std::uint32_t tag = 0;
    SectorMask missing = 0;
  };
  /// Asks for sectors, not all of which are there, of the line in `slot`; if it has none (`TagArray::kNone`),
  /// `place()` gives it one, and kNone again if there is none now. Nothing, and nothing is changed, when the
  /// table is full or the line has no place.
  template <class Place>
  [[nodiscard]] std::optional<Asked> ask(int slot, SectorMask sectors, const Place& place) {
    const bool joins = slot != TagArray::kNone && entry_of(slot) != kNoEntry;
    if (!joins && full()) return {};
    if (slot == TagArray::kNone) slot = place();
    if (slot == TagArray::kNone) return {};
    if (!joins) open(slot);
    const TagArray::Line& held = tags_.at(slot);
    const auto missing = static_cast<SectorMask>(sectors & ~(held.valid | held.pending));
    tags_.mark_pending(slot, missing);
    return Asked{entry_of(slot), missing};
  }
  /// Who is told when the entry's line is there.
  void wait(std::uint32_t tag, const Waiter& waiter) { entries_[tag].waiters.push_back(waiter); }
  [[nodiscard]] int slot_of(std::uint32_t tag) const { return entries_[tag].slot; }

  /// Sectors of the entry's line arrive. True when no more of them are under way; then `release` the entry.
  [[nodiscard]] bool arrive(std::uint32_t tag, SectorMask sectors) {
    const int slot = slot_of(tag);
    tags_.fill(slot, sectors);
    return tags_.at(slot).pending == 0;
  }
  /// Calls `ready(waiter)` for all who wait, in the order in which they came, and frees the entry.
  template <class Ready>
  void release(std::uint32_t tag, const Ready& ready) {
    Entry& entry = entries_[tag];
    for (const Waiter& waiter : entry.waiters) ready(waiter);
    entry.waiters.clear();
    entry_of(entry.slot) = kNoEntry;
    free_.push_back(tag);
  }

 private:
  static constexpr std::uint32_t kNoEntry = 0xffffffffu;
  struct Entry {
    int slot = 0;
    std::vector<Waiter> waiters;
  };
  [[nodiscard]] std::uint32_t& entry_of(int slot) { return entry_of_slot_[static_cast<std::size_t>(slot)]; }
  void open(int slot) {
    entry_of(slot) = free_.back();
    entries_[free_.back()].slot = slot;
    free_.pop_back();
  }

  TagArray& tags_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> entry_of_slot_;
};

}  // namespace quadrille::models
