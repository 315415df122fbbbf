#include "models/cache/tag_array.h"

#include "models/base/error.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>

namespace quadrille::models {
namespace {

/// Tag of a way that holds nothing: beyond every line of a 512 GiB device.
constexpr std::uint32_t kFree = 0xffffffffu;
constexpr std::uint32_t kMostWays = 64;  // as many as a set of bits holds

}  // namespace

TagArray::TagArray(std::uint32_t lines, std::uint32_t ways, std::uint32_t slices,
                   const ReplacementPolicy& replacement)
    : sets_(ways == 0 ? 0 : lines / ways),
      ways_(ways),
      stride_((ways + 7) / 8 * 8),
      over_slices_(slices),
      over_sets_(std::max(sets_, 1u)) {
  QUADRILLE_CHECK(ways > 0 && ways <= kMostWays && lines >= ways && lines % ways == 0, "{} lines of {} ways",
                  lines, ways);
  tags_.assign(std::size_t{sets_} * stride_, kFree);
  lines_.assign(lines, Line{});
  replacement_ = replacement.make(sets_, ways_);
}

int TagArray::find(std::uint32_t line) const {
  const std::uint32_t set = set_of(line);
  const std::uint32_t* tags = tags_.data() + std::size_t{set} * stride_;
  const __m256i wanted = _mm256_set1_epi32(static_cast<int>(line));
  for (std::uint32_t way = 0; way < stride_; way += 8) {
    const __m256i equal =
        _mm256_cmpeq_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(tags + way)), wanted);
    const auto hits = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(equal)));
    if (hits != 0)
      return static_cast<int>(set * ways_ + way + static_cast<std::uint32_t>(std::countr_zero(hits)));
  }
  return kNone;
}

int TagArray::lookup(std::uint32_t line) {
  const int slot = find(line);
  if (slot != kNone) replacement_->used(static_cast<std::uint32_t>(slot));
  return slot;
}

std::uint32_t TagArray::way_for_new(std::uint32_t set) {
  const std::uint32_t* const tags = tags_.data() + std::size_t{set} * stride_;
  const Line* const lines = lines_.data() + std::size_t{set} * ways_;
  std::uint64_t open = 0;
  for (std::uint32_t way = 0; way < ways_; ++way) {
    if (lines[way].pending != 0) continue;
    if (tags[way] == kFree) return way;
    open |= std::uint64_t{1} << way;
  }
  return open == 0 ? ways_ : replacement_->victim(set, open);
}

TagArray::Allocation TagArray::allocate(std::uint32_t line) {
  QUADRILLE_CHECK(line != kFree && find(line) == kNone, "line {} is held already", line);
  const std::uint32_t set = set_of(line);
  const std::size_t first = std::size_t{set} * ways_;
  const std::uint32_t chosen = way_for_new(set);
  if (chosen == ways_) return {};
  std::uint32_t& tag = tags_[std::size_t{set} * stride_ + chosen];
  Line& held = lines_[first + chosen];
  const Allocation result{static_cast<int>(first + chosen),
                          {tag != kFree, held.line, held.dirty, held.valid}};
  tag = line;
  held = {line, 0, 0, 0};
  replacement_->placed(set * ways_ + chosen);
  return result;
}

void TagArray::fill(int slot, SectorMask sectors) {
  Line& line = state(slot);
  QUADRILLE_CHECK((sectors & ~line.pending) == 0, "sectors {:#x} of line {} arrive, {:#x} are pending",
                  sectors, line.line, line.pending);
  line.pending = static_cast<SectorMask>(line.pending & ~sectors);
  line.valid |= sectors;
}

void TagArray::mark_dirty(int slot, SectorMask sectors) {
  Line& line = state(slot);
  line.valid |= sectors;
  line.dirty |= sectors;
}

void TagArray::invalidate_all() {
  for (const Line& line : lines_)
    QUADRILLE_CHECK(line.dirty == 0 && line.pending == 0, "line {} is dirty {:#x} or pending {:#x}",
                    line.line, line.dirty, line.pending);
  std::ranges::fill(tags_, kFree);
  std::ranges::fill(lines_, Line{});
  replacement_->forget();
}

std::uint32_t TagArray::dirty_count() const {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(lines_, [](const Line& line) { return line.dirty != 0; }));
}

}  // namespace quadrille::models
