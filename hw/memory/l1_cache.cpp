#include "hw/memory/l1_cache.h"

#include <algorithm>
#include <utility>

namespace quadrille::hw {
namespace {

constexpr std::uint32_t kWordsOfSector = 0xff;
constexpr std::uint8_t kAllSectors = 0xf;

std::uint32_t words_of(std::uint8_t sectors) {
  std::uint32_t words = 0;
  for (unsigned s = 0; s < 4; ++s) words |= (sectors >> s & 1u) * kWordsOfSector << 8 * s;
  return words;
}
/// Sectors of which at least one of the words is set, or every one.
std::uint8_t sectors_with_any(std::uint32_t words) {
  std::uint8_t sectors = 0;
  for (unsigned s = 0; s < 4; ++s)
    sectors = static_cast<std::uint8_t>(sectors | ((words >> 8 * s & kWordsOfSector) != 0) << s);
  return sectors;
}
std::uint8_t sectors_with_all(std::uint32_t words) {
  return static_cast<std::uint8_t>(~sectors_with_any(~words) & 0xf);
}

}  // namespace

L1Cache::L1Cache(StatGroup& stats, int lines, int ways, int misses,
                 const models::ReplacementPolicy& replacement)
    : tags_(static_cast<std::uint32_t>(lines), static_cast<std::uint32_t>(ways), 1, replacement),
      misses_(tags_, static_cast<std::size_t>(misses)),
      group_(stats),
      stats_(stats) {}

std::uint8_t L1Cache::groups_of(std::uint8_t sectors) const {
  if (group_sectors_ == 1) return sectors;
  if (group_sectors_ == 4) return kAllSectors;
  const unsigned pairs = (sectors | sectors >> 1) & 0b0101u;
  return static_cast<std::uint8_t>(pairs | pairs << 1);
}

void L1Cache::note_kind(std::uint32_t line, std::uint8_t sectors, std::uint8_t brought, bool missed) {
  const models::MissKind kind = kinds_->ideal.look_up(line, sectors, brought);
  if (kind != models::MissKind::kConflict) ++kinds_->counts.associative_misses;
  if (missed) ++kinds_->counts.misses[static_cast<std::size_t>(kind)];
}

L1Cache::Result L1Cache::hit(std::uint32_t line, std::uint8_t sectors, std::uint8_t brought) {
  ++stats_.requests;
  ++stats_.hits;
  if (kinds_ != nullptr) [[unlikely]]
    note_kind(line, sectors, brought, false);
  return Result::kHit;
}

L1Cache::Result L1Cache::access(std::uint32_t line, std::uint8_t sectors, std::uint32_t waiter,
                                MemoryPort& port) {
  const int slot = tags_.lookup(line);
  const bool there = slot != models::TagArray::kNone && (tags_.at(slot).valid & sectors) == sectors;
  if (there && !used_.empty()) note_used(slot, sectors);
  const std::uint8_t brought = groups_of(sectors);
  if (there && kinds_ == nullptr) return hit(line, sectors, brought);
  if (stored_lines_ == nullptr || !stored_lines_->is_encoded(line))
    return there ? hit(line, sectors, brought) : ask(slot, line, sectors, brought, waiter, port, nullptr);
  if (there) return hit(line, sectors, kAllSectors);
  const models::StoredLines::Place place = stored_lines_->place_of(line);
  const std::uint64_t misses = stats_.misses.value();
  const Result result = ask(slot, line, sectors, kAllSectors, waiter, port, &place);
  if (stats_.misses.value() == misses) return result;
  ++read_stats_->lines;
  read_stats_->bytes += models::sector_bytes(place.sectors);
  return result;
}

L1Cache::Result L1Cache::access_made(std::uint32_t line, const models::StoredLines::Place& from,
                                     std::uint32_t waiter, MemoryPort& port) {
  const int slot = tags_.lookup(line);
  if (slot != models::TagArray::kNone && tags_.at(slot).valid == kAllSectors) {
    if (!used_.empty()) note_used(slot, kAllSectors);
    return hit(line, kAllSectors, kAllSectors);
  }
  return ask(slot, line, kAllSectors, kAllSectors, waiter, port, &from);
}

L1Cache::Result L1Cache::ask(int slot, std::uint32_t line, std::uint8_t sectors, std::uint8_t brought,
                             std::uint32_t waiter, MemoryPort& port,
                             const models::StoredLines::Place* whole_from) {
  const auto asked = misses_.ask(slot, brought, [&] { return place(line, port); });
  if (!asked) return Result::kStall;
  ++stats_.requests;
  ++(asked->missing != 0 ? stats_.misses : stats_.merged);
  if (kinds_ != nullptr) [[unlikely]]
    note_kind(line, sectors, brought, asked->missing != 0);
  if (!used_.empty()) {
    sector_stats_->filled += static_cast<std::uint64_t>(std::popcount(asked->missing));
    note_used(misses_.slot_of(asked->tag), sectors);
  }
  if (asked->missing != 0) fetch(line, asked->missing, asked->tag, port, whole_from);
  misses_.wait(asked->tag, waiter);
  return Result::kPending;
}

void L1Cache::fetch(std::uint32_t line, std::uint8_t missing, std::uint32_t tag, MemoryPort& port,
                    const models::StoredLines::Place* whole_from) {
  if (whole_from == nullptr) return port.read(line, missing, tag);
  expands_[tag] = true;
  port.read(whole_from->line, whole_from->sectors, tag);
}

std::uint8_t L1Cache::arrived(const MemoryResponse& response) {
  if (expands_.empty() || !expands_[response.tag]) return response.sectors;
  expands_[response.tag] = false;
  return tags_.at(misses_.slot_of(response.tag)).pending;
}

int L1Cache::place(std::uint32_t line, MemoryPort& port) {
  const models::TagArray::Allocation got = tags_.allocate(line);
  if (got.slot != models::TagArray::kNone && !used_.empty()) used_[static_cast<std::size_t>(got.slot)] = 0;
  if (got.slot == models::TagArray::kNone || parts_.empty()) return got.slot;
  write_back(got.slot, {got.victim.line, got.victim.dirty, got.victim.present}, port);
  return got.slot;
}

void L1Cache::write_back(int slot, Leaving leaving, MemoryPort& port) {
  if (!parts_.empty())
    leaving.parts = sectors_with_any(std::exchange(parts_[static_cast<std::size_t>(slot)], 0));
  if (leaving.dirty == 0 && leaving.parts == 0) return;
  WorkLog* const log = group_.log();
  if (log == nullptr) return send_back(leaving, port);
  const Work now = log->now();
  log->turn_to(writers_[static_cast<std::size_t>(slot)]);
  send_back(leaving, port);
  log->turn_to(now);
}

void L1Cache::note_writer(int slot) {
  writers_.resize(static_cast<std::size_t>(tags_.slots()));
  writers_[static_cast<std::size_t>(slot)] = group_.log()->now();
}

void L1Cache::send_back(const Leaving& leaving, MemoryPort& port) {
  const std::uint8_t sectors = store_ != nullptr ? store_->store(leaving) : leaving.dirty;
  if (sectors != 0) port.write(leaving.line, sectors);
  if (leaving.parts != 0) port.write_part(leaving.line, leaving.parts);
  memory_->mark_clean(leaving.line);
}

void L1Cache::complete(int slot, std::uint8_t sectors) {
  if (parts_.empty()) return;
  std::uint32_t& parts = parts_[static_cast<std::size_t>(slot)];
  tags_.mark_dirty(slot, static_cast<models::SectorMask>(sectors_with_any(parts) & sectors));
  parts &= ~words_of(sectors);
}

bool L1Cache::claim(std::uint32_t line, std::uint8_t sectors, MemoryPort& port) {
  int slot = tags_.lookup(line);
  if (slot == models::TagArray::kNone) slot = place(line, port);
  if (slot == models::TagArray::kNone) return false;
  ++stats_.requests;
  ++stats_.hits;
  const auto absent =
      static_cast<models::SectorMask>(sectors & ~(tags_.at(slot).pending | tags_.at(slot).valid));
  tags_.mark_pending(slot, absent);
  tags_.fill(slot, absent);
  complete(slot, absent);
  return true;
}

void L1Cache::write(std::uint32_t line, std::uint32_t words) {
  const int slot = tags_.find(line);
  QUADRILLE_CHECK(slot != models::TagArray::kNone, "line {} is written but has no place", line);
  const models::TagArray::Line& held = tags_.at(slot);
  std::uint32_t& parts = parts_[static_cast<std::size_t>(slot)];
  if (held.dirty == 0 && parts == 0) memory_->mark_dirty(line, owner_);
  if (group_.log() != nullptr) [[unlikely]]
    note_writer(slot);
  parts |= words;
  // Those under way become whole when they arrive.
  const auto whole = static_cast<std::uint8_t>((held.valid | sectors_with_all(parts)) & ~held.pending);
  complete(slot, whole);
}

void L1Cache::forget() {
  QUADRILLE_CHECK(idle() && parts_.empty(), "a cache is emptied with {} misses under way",
                  misses_.under_way());
  tags_.invalidate_all();
  std::ranges::fill(used_, std::uint8_t{0});
  if (kinds_ != nullptr) kinds_->ideal.forget();
}

void L1Cache::clean(std::uint32_t line) {
  const int slot = tags_.find(line);
  tags_.clean(slot);
  memory_->mark_clean(line);
}

void L1Cache::discard(std::uint32_t first, std::uint32_t end) {
  QUADRILLE_CHECK(idle(), "lines are discarded with {} misses under way", misses_.under_way());
  for (int slot = 0; slot < tags_.slots(); ++slot) {
    const models::TagArray::Line& held = tags_.at(slot);
    if (held.line < first || held.line >= end) continue;
    if (held.dirty != 0 || parts_[static_cast<std::size_t>(slot)] != 0) memory_->mark_clean(held.line);
    parts_[static_cast<std::size_t>(slot)] = 0;
    tags_.clean(slot);
  }
}

void L1Cache::flush(MemoryPort& port) {
  QUADRILLE_CHECK(idle(), "flush with {} misses under way", misses_.under_way());
  for (int slot = 0; slot < tags_.slots(); ++slot) {
    const models::TagArray::Line& held = tags_.at(slot);
    write_back(slot, {held.line, held.dirty, held.valid}, port);
    tags_.clean(slot);
  }
  tags_.invalidate_all();
}

}  // namespace quadrille::hw
