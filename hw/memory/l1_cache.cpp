#include "hw/memory/l1_cache.h"

namespace quadrille::hw {

L1Cache::L1Cache(StatGroup& stats, int lines, int ways, int misses)
    : tags_(static_cast<std::uint32_t>(lines), static_cast<std::uint32_t>(ways)),
      misses_(static_cast<std::size_t>(misses)),
      miss_of_slot_(static_cast<std::size_t>(tags_.slots()), -1),
      stats_(stats) {
  for (std::size_t i = misses_.size(); i-- > 0;) free_.push_back(static_cast<std::uint32_t>(i));
}

L1Cache::Result L1Cache::access(std::uint32_t line, std::uint8_t sectors, std::uint32_t waiter, MemoryPort& port) {
  int slot = tags_.lookup(line);
  if (slot != models::TagArray::kNone && (tags_.at(slot).valid & sectors) == sectors) {
    ++stats_.requests;
    ++stats_.hits;
    return Result::kHit;
  }
  const bool under_way = slot != models::TagArray::kNone && miss_of_slot_[static_cast<std::size_t>(slot)] >= 0;
  if (!under_way && free_.empty()) return Result::kStall;
  if (slot == models::TagArray::kNone) {
    slot = place(line, port);
    if (slot == models::TagArray::kNone) return Result::kStall;
  }
  if (!under_way) {
    miss_of_slot_[static_cast<std::size_t>(slot)] = static_cast<int>(free_.back());
    misses_[free_.back()].slot = slot;
    misses_[free_.back()].outstanding = 0;
    free_.pop_back();
  }
  const auto tag = static_cast<std::uint32_t>(miss_of_slot_[static_cast<std::size_t>(slot)]);
  const models::TagArray::Line& held = tags_.at(slot);
  const auto missing = static_cast<std::uint8_t>(sectors & ~(held.valid | held.pending));
  ++stats_.requests;
  ++(missing != 0 ? stats_.misses : stats_.merged);
  if (missing != 0) {
    tags_.mark_pending(slot, missing);
    ++misses_[tag].outstanding;
    port.read(line, missing, tag);
  }
  misses_[tag].waiters.push_back(waiter);
  return Result::kPending;
}

int L1Cache::place(std::uint32_t line, MemoryPort& port) {
  const models::TagArray::Allocation got = tags_.allocate(line);
  if (got.victim.valid && got.victim.dirty != 0) write_back(got.victim.line, got.victim.dirty, port);
  return got.slot;
}

void L1Cache::write_back(std::uint32_t line, std::uint8_t sectors, MemoryPort& port) {
  port.write(line, sectors);
  memory_->mark_clean(line);
}

bool L1Cache::claim(std::uint32_t line, std::uint8_t sectors, MemoryPort& port) {
  int slot = tags_.lookup(line);
  if (slot == models::TagArray::kNone) slot = place(line, port);
  if (slot == models::TagArray::kNone) return false;
  ++stats_.requests;
  ++stats_.hits;
  const auto absent = static_cast<models::SectorMask>(sectors & ~(tags_.at(slot).pending | tags_.at(slot).valid));
  tags_.mark_pending(slot, absent);
  tags_.fill(slot, absent);
  return true;
}

bool L1Cache::holds(std::uint32_t line, std::uint8_t sectors) const {
  const int slot = tags_.find(line);
  return slot != models::TagArray::kNone && (tags_.at(slot).valid & sectors) == sectors;
}

void L1Cache::mark_dirty(std::uint32_t line, std::uint8_t sectors) {
  const int slot = tags_.find(line);
  QUADRILLE_CHECK(slot != models::TagArray::kNone, "line {} is written but not held", line);
  if (tags_.at(slot).dirty == 0) memory_->mark_dirty(line, owner_);
  tags_.mark_dirty(slot, sectors);
}

void L1Cache::flush(MemoryPort& port) {
  QUADRILLE_CHECK(idle(), "flush with {} misses under way", misses_.size() - free_.size());
  for (int slot = 0; slot < tags_.slots(); ++slot) {
    const models::TagArray::Line& held = tags_.at(slot);
    if (held.dirty == 0) continue;
    write_back(held.line, held.dirty, port);
    tags_.clean(slot);
  }
  tags_.invalidate_all();
}

}  // namespace quadrille::hw
