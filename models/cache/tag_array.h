/// Tags of a set-associative cache with sectored lines: which lines it holds, in what state. Data stay in
/// `DeviceMemory`.
///
/// A line (128 bytes) has four sectors of 32 bytes, each absent, pending (asked for), valid, or valid and
/// dirty. A line with a pending sector is never a victim. Lines are spread over any number of sets by
/// memory/interleave.h: consecutive lines go to consecutive sets, so that a stream evicts in the order in
/// which it came, and strides of powers of two use all sets.
#pragma once

#include "models/cache/replacement.h"
#include "models/memory/interleave.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace quadrille::models {

using SectorMask = std::uint8_t;  ///< bits 0..3

class TagArray {
 public:
  static constexpr int kNone = -1;

  struct Victim {
    bool valid = false;  ///< a line was evicted
    std::uint32_t line = 0;
    SectorMask dirty = 0;    ///< sectors that must be written back
    SectorMask present = 0;  ///< sectors that were there
  };
  struct Allocation {
    int slot = kNone;  ///< kNone: every way of the set is pending; try again later
    Victim victim;
  };
  struct Line {
    std::uint32_t line = 0;
    SectorMask valid = 0, dirty = 0, pending = 0;
  };

  /// `lines` in all, `ways` a set; `lines` is a multiple of `ways`. A cache that sees the lines of one slice
  /// of `slices` spreads them by their numbers within the slice.
  TagArray(std::uint32_t lines, std::uint32_t ways, std::uint32_t slices = 1,
           const ReplacementPolicy& replacement = kLruReplacement);

  /// Slot that holds the line, or kNone. Does not change the order of replacement.
  [[nodiscard]] int find(std::uint32_t line) const;
  /// The same, and counts as a use of it.
  int lookup(std::uint32_t line);
  /// Takes a slot for a line that is not held: a free way, or one without a pending sector that the
  /// replacement gives up. All its sectors are absent.
  Allocation allocate(std::uint32_t line);

  [[nodiscard]] const Line& at(int slot) const { return lines_[static_cast<std::size_t>(slot)]; }
  void mark_pending(int slot, SectorMask sectors) { state(slot).pending |= sectors; }
  /// Pending sectors arrive.
  void fill(int slot, SectorMask sectors);
  /// Sectors are written here: they become valid and dirty.
  void mark_dirty(int slot, SectorMask sectors);
  /// Dirty sectors were written back.
  void clean(int slot) { state(slot).dirty = 0; }
  /// Forgets all lines. None may be dirty or pending.
  void invalidate_all();

  [[nodiscard]] std::uint32_t sets() const { return sets_; }
  [[nodiscard]] std::uint32_t ways() const { return ways_; }
  /// Slots run from 0 to slots() - 1; a slot that holds no line has valid = dirty = pending = 0. For
  /// flushing.
  [[nodiscard]] int slots() const { return static_cast<int>(lines_.size()); }
  /// Lines with a dirty sector.
  [[nodiscard]] std::uint32_t dirty_count() const;

 private:
  [[nodiscard]] Line& state(int slot) { return lines_[static_cast<std::size_t>(slot)]; }
  /// A way of the set for a new line; ways() if all are pending.
  [[nodiscard]] std::uint32_t way_for_new(std::uint32_t set);
  [[nodiscard]] std::uint32_t set_of(std::uint32_t line) const {
    return over_sets_.member_of(over_slices_.index_of(line));
  }

  std::uint32_t sets_, ways_, stride_;  // stride: ways rounded up to a vector of tags
  Interleave over_slices_, over_sets_;
  std::vector<std::uint32_t> tags_;  // sets x stride; kFree where no line is held
  std::vector<Line> lines_;          // sets x ways
  std::unique_ptr<Replacement> replacement_;
};

}  // namespace quadrille::models
