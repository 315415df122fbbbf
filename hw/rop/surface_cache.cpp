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

void SurfaceCache::clear(const models::SurfaceLayout& surface, std::uint32_t value, std::uint32_t partition,
                         std::uint32_t partitions) {
  surface_ = surface;
  cleared_.assign(std::size_t{surface.tiles_x} * surface.tiles_y, false);
  for (std::uint32_t y = 0; y < surface.tiles_y; ++y) {
    for (std::uint32_t x = 0; x < surface.tiles_x; ++x) {
      if (models::partition_of(x, y, partitions) != partition) continue;
      auto* const pixels = reinterpret_cast<std::uint32_t*>(
          memory_.write(surface.tile_address(x, y), models::kTileBytes).data());
      std::fill_n(pixels, models::kTilePixels, value);
      cleared_[std::size_t{y} * surface.tiles_x + x] = true;
      ++stats_.cleared_tiles;
    }
  }
}

bool SurfaceCache::materialize(std::uint32_t tile_x, std::uint32_t tile_y, std::uint8_t& done,
                               MemoryPort& port) {
  for (int half = 0; half < 2; ++half) {
    const std::uint32_t line = line_of(tile_x, tile_y) + static_cast<std::uint32_t>(half);
    if ((done & (kMaterialized << half)) != 0) continue;
    if (!cache_.claim(line, 0xf, port)) return false;
    cache_.write(line, 0xffffffffu);
    done = static_cast<std::uint8_t>(done | kMaterialized << half);
  }
  cleared_[std::size_t{tile_y} * surface_.tiles_x + tile_x] = false;
  ++stats_.clear_hits;
  return true;
}

bool SurfaceCache::acquire(std::uint32_t tile_x, std::uint32_t tile_y, const SectorWishes& wishes,
                           std::uint32_t waiter, int& missing, std::uint8_t& done, MemoryPort& port) {
  group_.working_at(tile_x, tile_y);
  if (cleared_[std::size_t{tile_y} * surface_.tiles_x + tile_x] && !materialize(tile_x, tile_y, done, port))
    return false;
  for (int half = 0; half < 2; ++half) {
    if ((done & (kAcquired << half)) != 0) continue;
    const std::uint32_t line = line_of(tile_x, tile_y) + static_cast<std::uint32_t>(half);
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

bool SurfaceCache::write(std::uint32_t tile_x, std::uint32_t tile_y, const SectorPixels& pixels,
                         MemoryPort& port) {
  group_.working_at(tile_x, tile_y);
  for (std::size_t half = 0; half < 2; ++half) {
    const std::uint32_t line = line_of(tile_x, tile_y) + static_cast<std::uint32_t>(half);
    std::uint32_t words = 0;  // a pixel is one
    for (std::size_t s = 0; s < 4; ++s) words |= std::uint32_t{pixels[4 * half + s]} << 8 * s;
    if (words == 0) continue;
    if (!cache_.has_place(line) && !cache_.claim(line, 0, port)) return false;
    cache_.write(line, words);
  }
  return true;
}

void SurfaceCache::flush(MemoryPort& port, bool write_cleared) {
  cache_.flush(port);
  for (std::size_t i = 0; i < cleared_.size(); ++i) {
    if (!cleared_[i]) continue;
    if (write_cleared) {
      const auto line =
          static_cast<std::uint32_t>((surface_.base + i * models::kTileBytes) / models::kLineBytes);
      port.write(line, 0xf);
      port.write(line + 1, 0xf);
      ++stats_.clear_writes;
    }
    cleared_[i] = false;
  }
}

}  // namespace quadrille::hw
