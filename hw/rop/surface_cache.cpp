#include "hw/rop/surface_cache.h"

#include "models/memory/interleave.h"

#include <bit>

namespace quadrille::hw {

namespace {

/// Bits 0 to count - 1.
constexpr std::uint64_t low_bits(std::uint32_t count) {
  return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// Words of a line that hold some of these pixels, of which bit 0 is the line's first.
std::uint32_t words_of(std::uint64_t pixels, std::uint32_t pixel_bytes) {
  if (pixel_bytes == 4) return static_cast<std::uint32_t>(pixels);
  std::uint32_t words = 0;
  for (; pixels != 0; pixels &= pixels - 1) {
    const auto first = static_cast<std::uint32_t>(std::countr_zero(pixels)) * pixel_bytes;
    const std::uint32_t count = (first + pixel_bytes - 1) / 4 - first / 4 + 1;
    words |= static_cast<std::uint32_t>(low_bits(count)) << first / 4;
  }
  return words;
}

std::uint8_t line_part(std::uint32_t sectors, std::uint32_t line) {
  return static_cast<std::uint8_t>(sectors >> 4 * line & 0xf);
}

}  // namespace

std::uint32_t sectors_of(std::uint64_t pixels, std::uint32_t pixel_bytes) {
  const SectorWishes wishes = wishes_of_write(pixels, pixel_bytes, true);
  return wishes.read;
}

SectorWishes wishes_of_write(std::uint64_t pixels, std::uint32_t pixel_bytes, bool reads_old) {
  const std::uint32_t per_sector = models::kSectorBytes / pixel_bytes, per_word = 4 / pixel_bytes;
  const std::uint64_t sector_mask = low_bits(per_sector);
  SectorWishes wishes;
  for (std::uint32_t s = 0; pixels != 0; ++s, pixels = per_sector < 64 ? pixels >> per_sector : 0) {
    const std::uint64_t in_sector = pixels & sector_mask;
    if (in_sector == 0) continue;
    bool splits_word = false;
    for (std::uint32_t p = 0; per_word > 1 && p < per_sector; p += per_word) {
      const std::uint64_t in_word = in_sector >> p & low_bits(per_word);
      splits_word |= in_word != 0 && in_word != low_bits(per_word);
    }
    std::uint32_t& wish = reads_old || splits_word   ? wishes.read
                          : in_sector == sector_mask ? wishes.write
                                                     : wishes.part;
    wish |= 1u << s;
  }
  return wishes;
}

SurfaceCache::SurfaceCache(StatGroup& stats, int lines, int ways, int misses, models::DeviceMemory& memory,
                           models::DeviceMemory::Owner owner, const SurfaceCompression& compression)
    : cache_(stats, lines, ways, misses),
      memory_(memory),
      group_(stats),
      stats_(stats),
      read_stats_(stats),
      encoder_(stats, cache_, memory, compression) {
  cache_.own_dirty_lines(memory, owner);
  cache_.read_encoded(memory.stored_lines(), read_stats_);
}

void SurfaceCache::begin_pass(std::span<const AttachmentState> surfaces, PartitionId partition,
                              std::uint32_t partitions) {
  count_ = surfaces.size();
  encoder_.begin_pass();
  for (std::size_t i = 0; i < count_; ++i) {
    surfaces_[i].state = &surfaces[i];
    const models::SurfaceLayout& layout = surfaces[i].surface;
    surfaces_[i].cleared.assign(layout.planes(), false);
    surfaces_[i].on_screen = true;
    encoder_.add(surfaces[i]);
    if (!surfaces[i].loads()) mark_cleared(surfaces_[i], partition, partitions);
  }
}

std::size_t SurfaceCache::add_surface(const AttachmentState& surface) {
  surfaces_[count_].state = &surface;
  surfaces_[count_].cleared.assign(surface.surface.planes(), false);
  surfaces_[count_].on_screen = true;
  encoder_.add(surface);
  return count_++;
}

std::size_t SurfaceCache::add_pool(const AttachmentState& surface) {
  const std::size_t number = add_surface(surface);
  surfaces_[number].on_screen = false;
  return number;
}

std::size_t SurfaceCache::add_cleared(const AttachmentState& surface, PartitionId partition,
                                      std::uint32_t partitions) {
  const std::size_t number = add_surface(surface);
  mark_cleared(surfaces_[number], partition, partitions);
  return number;
}

void SurfaceCache::mark_cleared(Surface& surface, PartitionId partition, std::uint32_t partitions) {
  const models::SurfaceLayout& layout = surface.state->surface;
  for (std::uint32_t y = 0; y < layout.tiles_y; ++y) {
    for (std::uint32_t x = 0; x < layout.tiles_x; ++x) {
      if (models::partition_of(x, y, partitions) != partition) continue;
      models::fill_pixels(
          memory_.write(layout.tile_address(x, y), std::uint64_t{layout.samples} * layout.plane_stride()),
          layout.pixel_bytes, surface.state->clear);
      for (std::uint32_t s = 0; s < layout.samples; ++s) surface.cleared[layout.plane_number(x, y, s)] = true;
      const auto line = static_cast<std::uint32_t>(layout.tile_address(x, y) / models::kLineBytes);
      for (std::uint32_t l = 0; encoder_.on() && l < layout.samples * layout.plane_lines(); ++l)
        encoder_.forget(line + l);
      stats_.cleared_tiles += layout.samples;
    }
  }
}

bool SurfaceCache::materialize(const SurfaceTile& tile, AcquiredLines& done, MemoryPort& port) {
  const models::SurfaceLayout& layout = layout_of(tile);
  const auto words = static_cast<std::uint32_t>(low_bits(layout.plane_bytes() / 4));
  for (std::uint32_t i = 0; i < layout.plane_lines(); ++i) {
    if ((done.materialized >> i & 1u) != 0) continue;
    const std::uint32_t line = first_line_of(tile) + i;
    if (!cache_.claim(line, layout.line_sectors(), port)) return false;
    cache_.write(line, words);
    done.materialized = static_cast<std::uint8_t>(done.materialized | 1u << i);
  }
  mark_of(tile) = false;
  ++stats_.clear_hits;
  return true;
}

bool SurfaceCache::acquire(const SurfaceTile& tile, const SectorWishes& wishes, std::uint32_t waiter,
                           int& missing, AcquiredLines& done, MemoryPort& port) {
  work_at(tile);
  if (mark_of(tile) && !materialize(tile, done, port)) return false;
  for (std::uint32_t i = 0; i < layout_of(tile).plane_lines(); ++i) {
    if ((done.acquired >> i & 1u) != 0) continue;
    const LineWishes line = line_wishes(tile, i, wishes);
    if ((line.write != 0 || line.in_part) && !cache_.claim(line.line, line.write, port)) return false;
    if (line.read != 0) {
      const L1Cache::Result result = cache_.access(line.line, line.read, waiter, port);
      if (result == L1Cache::Result::kStall) return false;
      if (result == L1Cache::Result::kPending) ++missing;
    }
    done.acquired = static_cast<std::uint8_t>(done.acquired | 1u << i);
  }
  return true;
}

SurfaceCache::LineWishes SurfaceCache::line_wishes(const SurfaceTile& tile, std::uint32_t line,
                                                   const SectorWishes& wishes) const {
  const std::uint8_t read = line_part(wishes.read, line);
  LineWishes of{first_line_of(tile) + line, read,
                static_cast<std::uint8_t>(line_part(wishes.write, line) & ~read),
                line_part(wishes.part, line) != 0};
  if (!encoder_.lines().is_encoded(of.line) || cache_.has_place(of.line)) return of;
  const std::uint8_t all = layout_of(tile).line_sectors();
  const bool is_copy = encoder_.lines().is_copy(of.line);
  const bool old_needed = of.read != 0 || of.in_part || (of.write != 0 && of.write != all);
  const std::uint32_t stored = is_copy ? encoder_.lines().original_of(of.line) : of.line;
  if (old_needed) return {stored, all};
  // A copy that is overwritten whole becomes a line of its own with the write.
  return is_copy ? LineWishes{stored} : of;
}

bool SurfaceCache::write(const SurfaceTile& tile, std::uint64_t pixels, MemoryPort& port) {
  work_at(tile);
  const models::SurfaceLayout& layout = layout_of(tile);
  const std::uint32_t per_line = models::kLineBytes / layout.pixel_bytes;
  for (std::uint32_t i = 0; i < layout.plane_lines(); ++i) {
    const std::uint32_t line = first_line_of(tile) + i;
    const std::uint32_t words = words_of(pixels >> i * per_line & low_bits(per_line), layout.pixel_bytes);
    if (words == 0) continue;
    if (encoder_.on() && !encoder_.prepare_write(line, words, port)) return false;
    if (!cache_.has_place(line) && !cache_.claim(line, 0, port)) return false;
    cache_.write(line, words);
  }
  return true;
}

void SurfaceCache::write_marked(Surface& surface, MemoryPort& port) {
  const models::SurfaceLayout& layout = surface.state->surface;
  for (std::size_t i = 0; i < surface.cleared.size(); ++i) {
    if (!surface.cleared[i]) continue;
    const auto line =
        static_cast<std::uint32_t>((layout.base + i * layout.plane_stride()) / models::kLineBytes);
    const std::size_t first = i - i % layout.samples;
    for (std::uint32_t l = 0; l < layout.plane_lines(); ++l) {
      const std::uint8_t sectors =
          encoder_.on() ? encoder_.store_cleared(line + l, surface.cleared[first]) : layout.line_sectors();
      if (sectors != 0) port.write(line + l, sectors);
    }
    ++stats_.clear_writes;
  }
}

void SurfaceCache::flush(MemoryPort& port) {
  for (std::size_t i = 0; i < count_; ++i) {
    const models::SurfaceLayout& layout = surfaces_[i].state->surface;
    if (surfaces_[i].state->store == models::StoreOp::kDiscard)
      cache_.discard(static_cast<std::uint32_t>(layout.base / models::kLineBytes),
                     static_cast<std::uint32_t>((layout.base + layout.bytes()) / models::kLineBytes));
  }
  cache_.flush(port);
  for (std::size_t i = 0; i < count_; ++i) {
    const AttachmentState& state = *surfaces_[i].state;
    if (state.store == models::StoreOp::kStore && state.read_later) write_marked(surfaces_[i], port);
  }
  count_ = 0;
}

}  // namespace quadrille::hw
