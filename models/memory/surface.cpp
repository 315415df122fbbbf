#include "models/memory/surface.h"

#include "models/base/error.h"

#include <algorithm>
#include <array>
#include <cstring>

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
        if (x < s.width && y < s.height)
          visit(std::size_t{y} * s.width + x, tile + std::uint64_t{s.pixel_bytes} * entry);
      }
    }
  }
}

}  // namespace

SurfaceLayout surface_layout(std::uint32_t width, std::uint32_t height, std::uint32_t samples,
                             std::uint32_t pixel_bytes) {
  QUADRILLE_CHECK(width > 0 && height > 0, "surface of {} x {} pixels", width, height);
  return {0, width, height, (width - 1) / 8 + 1, (height - 1) / 8 + 1, samples, pixel_bytes};
}

SurfaceLayout allocate_surface(DeviceMemory& memory, std::uint32_t width, std::uint32_t height,
                               std::uint32_t samples, std::uint32_t pixel_bytes) {
  SurfaceLayout surface = surface_layout(width, height, samples, pixel_bytes);
  surface.base = memory.allocate(surface.bytes(), kSurfaceAlignment);
  return surface;
}

void fill_pixels(std::span<std::byte> pixels, std::uint32_t pixel_bytes, const PixelCode& value) {
  const auto fill = [&]<class T>(T code) {
    auto* const first = reinterpret_cast<T*>(pixels.data());
    std::fill_n(first, pixels.size() / sizeof(T), code);
  };
  switch (pixel_bytes) {
    case 1: return fill(static_cast<std::uint8_t>(value.word[0]));
    case 2: return fill(static_cast<std::uint16_t>(value.word[0]));
    case 4: return fill(value.word[0]);
    case 8: return fill(std::array{value.word[0], value.word[1]});
    default: return fill(value.word);
  }
}

void fill_surface(DeviceMemory& memory, const SurfaceLayout& surface, const PixelCode& value) {
  fill_pixels(memory.write(surface.base, surface.bytes()), surface.pixel_bytes, value);
}

std::vector<PixelCode> detile_codes(const DeviceMemory& memory, const SurfaceLayout& surface) {
  const std::span<const std::byte> bytes = memory.read(surface.base, surface.bytes());
  std::vector<PixelCode> pixels(std::size_t{surface.width} * surface.height);
  for_each_pixel(surface, [&](std::size_t i, std::uint64_t address) {
    std::memcpy(&pixels[i], bytes.data() + (address - surface.base), surface.pixel_bytes);
  });
  return pixels;
}

std::vector<std::uint32_t> detile(const DeviceMemory& memory, const SurfaceLayout& surface) {
  const std::span<const std::byte> bytes = memory.read(surface.base, surface.bytes());
  QUADRILLE_CHECK(surface.pixel_bytes <= 4, "pixels of {} bytes", surface.pixel_bytes);
  std::vector<std::uint32_t> pixels(std::size_t{surface.width} * surface.height);
  for_each_pixel(surface, [&](std::size_t i, std::uint64_t address) {
    std::memcpy(&pixels[i], bytes.data() + (address - surface.base), surface.pixel_bytes);
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
    std::memcpy(bytes.data() + (address - surface.base), &pixels[i], surface.pixel_bytes);
  });
}

}  // namespace quadrille::models
