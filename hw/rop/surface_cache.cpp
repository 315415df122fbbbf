#include "hw/rop/surface_cache.h"

#include "models/memory/interleave.h"

#include <algorithm>

namespace quadrille::hw {

namespace {
// Bits of `done`, for the upper half of the tile; the lower half's are one to the left.
constexpr unsigned kMaterialized = 1, kAcquired = 4;
}  // namespace

SurfaceCache::SurfaceCache(StatGroup& stats, int lines, int ways, int misses, models::DeviceMemory& memory,
                           models::DeviceMemory::Owner owner)
    : cache_(stats, lines, ways, misses), memory_(memory), group_(stats), stats_(stats) {
  cache_.own_dirty_lines(memory, owner);
}

void SurfaceCache::begin_pass(std::span<const AttachmentState> surfaces, PartitionId partition,
                              std::uint32_t partitions) {
  count_ = surfaces.size();
  for (std::size_t i = 0; i < count_; ++i) {
    surfaces_[i].state = &surfaces[i];
    const models::SurfaceLayout& layout = surfaces[i].surface;
    surfaces_[i].cleared.assign(layout.planes(), false);
    if (!surfaces[i].loads()) mark_cleared(surfaces_[i], partition, partitions);
  }
}

std::size_t SurfaceCache::add_surface(const AttachmentState& surface) {
  surfaces_[count_].state = &surface;
  surfaces_[count_].cleared.assign(surface.surface.planes(), false);
  return count_++;
}

void SurfaceCache::mark_cleared(Surface& surface, PartitionId partition, std::uint32_t partitions) {
  const models::SurfaceLayout& layout = surface.state->surface;
  for (std::uint32_t y = 0; y < layout.tiles_y; ++y) {
    for (std::uint32_t x = 0; x < layout.tiles_x; ++x) {
      if (models::partition_of(x, y, partitions) != partition) continue;
      auto* const pixels = reinterpret_cast<std::uint32_t*>(
          memory_.write(layout.tile_address(x, y), std::uint64_t{layout.samples} * models::kTileBytes)
              .data());
      std::fill_n(pixels, std::size_t{layout.samples} * models::kTilePixels, surface.state->clear);
      for (std::uint32_t s = 0; s < layout.samples; ++s) surface.cleared[layout.plane_number(x, y, s)] = true;
      stats_.cleared_tiles += layout.samples;
    }
  }
}

bool SurfaceCache::materialize(const SurfaceTile& tile, std::uint8_t& done, MemoryPort& port) {
  for (int half = 0; half < 2; ++half) {
    const std::uint32_t line = line_of(tile) + static_cast<std::uint32_t>(half);
    if ((done & (kMaterialized << half)) != 0) continue;
    if (!cache_.claim(line, 0xf, port)) return false;
    cache_.write(line, 0xffffffffu);
    done = static_cast<std::uint8_t>(done | kMaterialized << half);
  }
  mark_of(tile) = false;
  ++stats_.clear_hits;
  return true;
}

bool SurfaceCache::acquire(const SurfaceTile& tile, const SectorWishes& wishes, std::uint32_t waiter,
                           int& missing, std::uint8_t& done, MemoryPort& port) {
  group_.working_at(tile.x, tile.y);
  if (mark_of(tile) && !materialize(tile, done, port)) return false;
  for (int half = 0; half < 2; ++half) {
    if ((done & (kAcquired << half)) != 0) continue;
    const std::uint32_t line = line_of(tile) + static_cast<std::uint32_t>(half);
    const auto wanted = static_cast<std::uint8_t>((wishes.read >> (4 * half)) & 0xf);
    const auto written = static_cast<std::uint8_t>((wishes.write >> (4 * half)) & 0xf & ~wanted);
    const bool in_part = ((wishes.part >> (4 * half)) & 0xf) != 0;
    if ((written != 0 || in_part) && !cache_.claim(line, written, port)) return false;
    if (wanted != 0) {
      const L1Cache::Result result = cache_.access(line, wanted, waiter, port);
      if (result == L1Cache::Result::kStall) return false;
      if (result == L1Cache::Result::kPending) ++missing;
    }
    done = static_cast<std::uint8_t>(done | kAcquired << half);
  }
  return true;
}

bool SurfaceCache::write(const SurfaceTile& tile, const SectorPixels& pixels, MemoryPort& port) {
  group_.working_at(tile.x, tile.y);
  for (std::size_t half = 0; half < 2; ++half) {
    const std::uint32_t line = line_of(tile) + static_cast<std::uint32_t>(half);
    std::uint32_t words = 0;  // a pixel is one
    for (std::size_t s = 0; s < 4; ++s) words |= std::uint32_t{pixels[4 * half + s]} << 8 * s;
    if (words == 0) continue;
    if (!cache_.has_place(line) && !cache_.claim(line, 0, port)) return false;
    cache_.write(line, words);
  }
  return true;
}

void SurfaceCache::write_marked(Surface& surface, MemoryPort& port) {
  const models::SurfaceLayout& layout = surface.state->surface;
  for (std::size_t i = 0; i < surface.cleared.size(); ++i) {
    if (!surface.cleared[i]) continue;
    const auto line = static_cast<std::uint32_t>((layout.base + i * models::kTileBytes) / models::kLineBytes);
    port.write(line, 0xf);
    port.write(line + 1, 0xf);
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
