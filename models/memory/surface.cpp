#include "models/memory/surface.h"

#include "models/base/error.h"

#include <algorithm>

namespace quadrille::models {
namespace {

/// Calls visit(x, y, address) for every pixel, tile by tile.
template <class Visit>
void for_each_pixel(const SurfaceLayout& s, Visit visit) {
  for (std::uint32_t ty = 0; ty < s.tiles_y; ++ty) {
    for (std::uint32_t tx = 0; tx < s.tiles_x; ++tx) {
      const std::uint64_t tile = s.tile_address(tx, ty);
      for (std::uint32_t entry = 0; entry < kTilePixels; ++entry) {
        const std::uint32_t x = 8 * tx + static_cast<std::uint32_t>(entry_x(static_cast<int>(entry)));
        const std::uint32_t y = 8 * ty + static_cast<std::uint32_t>(entry_y(static_cast<int>(entry)));
        if (x < s.width && y < s.height) visit(std::size_t{y} * s.width + x, tile + 4 * std::uint64_t{entry});
      }
    }
  }
}

}  // namespace

SurfaceLayout allocate_surface(DeviceMemory& memory, std::uint32_t width, std::uint32_t height,
                               std::uint32_t samples) {
  QUADRILLE_CHECK(width > 0 && height > 0, "surface of {} x {} pixels", width, height);
  SurfaceLayout surface{0, width, height, (width - 1) / 8 + 1, (height - 1) / 8 + 1, samples};
  surface.base = memory.allocate(surface.bytes(), kTileBytes);
  return surface;
}

void fill_surface(DeviceMemory& memory, const SurfaceLayout& surface, std::uint32_t value) {
  const std::span<std::byte> bytes = memory.write(surface.base, surface.bytes());
  for (std::size_t i = 0; i < bytes.size(); i += sizeof value)
    std::memcpy(bytes.data() + i, &value, sizeof value);
}

std::vector<std::uint32_t> detile(const DeviceMemory& memory, const SurfaceLayout& surface) {
  const std::span<const std::byte> bytes = memory.read(surface.base, surface.bytes());
  std::vector<std::uint32_t> pixels(std::size_t{surface.width} * surface.height);
  for_each_pixel(surface, [&](std::size_t i, std::uint64_t address) {
    std::memcpy(&pixels[i], bytes.data() + (address - surface.base), 4);
  });
  return pixels;
}

std::vector<std::uint8_t> detile_rgba8(const DeviceMemory& memory, const SurfaceLayout& surface) {
  const std::vector<std::uint32_t> pixels = detile(memory, surface);
  std::vector<std::uint8_t> bytes(pixels.size() * 4);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(pixels[i / 4] >> (8 * (i % 4)));
  return bytes;
}

void entile(DeviceMemory& memory, const SurfaceLayout& surface, std::span<const std::uint32_t> pixels) {
  QUADRILLE_CHECK(pixels.size() == std::size_t{surface.width} * surface.height,
                  "{} pixels for a surface of {} x {}", pixels.size(), surface.width, surface.height);
  const std::span<std::byte> bytes = memory.write(surface.base, surface.bytes());
  for_each_pixel(surface, [&](std::size_t i, std::uint64_t address) {
    std::memcpy(bytes.data() + (address - surface.base), &pixels[i], 4);
  });
}

}  // namespace quadrille::models
