#include "models/memory/surface.h"

#include <catch2/catch.hpp>

#include <set>

using namespace quadrille::models;

TEST_CASE("surface: rows survive tiling for any size") {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {8u, 8u}, {9u, 7u}, {33u, 65u}, {640u, 3u}}) {
    DeviceMemory memory;
    (void)memory.allocate(100);
    const SurfaceLayout s = allocate_surface(memory, width, height);
    CHECK(s.base % 256 == 0);
    CHECK(memory.size() == s.base + s.bytes());
    std::vector<std::uint32_t> pixels(std::size_t{width} * height);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint32_t>(i * 2654435761u);
    entile(memory, s, pixels);
    CHECK(detile(memory, s) == pixels);
    const auto bytes = detile_rgba8(memory, s);
    CHECK(bytes[1] == (pixels[0] >> 8 & 0xff));
    std::set<std::uint64_t> addresses;
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        addresses.insert(s.pixel_address(x, y));
        if (memory.load<std::uint32_t>(s.pixel_address(x, y)) != pixels[std::size_t{y} * width + x])
          FAIL("pixel " << x << "," << y);
      }
    }
    CHECK(addresses.size() == pixels.size());
  }
}

TEST_CASE("surface: filling reaches the padding of edge tiles too") {
  DeviceMemory memory;
  const SurfaceLayout s = allocate_surface(memory, 9, 9);
  fill_surface(memory, s, {{0x3f800000}});
  CHECK(s.bytes() == 4 * 256);
  for (std::uint64_t a = 0; a < s.bytes(); a += 4) CHECK(memory.load<float>(s.base + a) == 1.0f);
}

TEST_CASE("surface: a tile is quad-major") {
  DeviceMemory memory;
  const SurfaceLayout s = allocate_surface(memory, 32, 16);
  CHECK(s.tile_address(1, 1) == s.base + 5 * 256);
  CHECK(s.pixel_address(8, 8) == s.tile_address(1, 1));
  CHECK(s.pixel_address(9, 8) == s.tile_address(1, 1) + 4);
  CHECK(s.pixel_address(8, 9) == s.tile_address(1, 1) + 8);
  CHECK(s.pixel_address(10, 8) == s.tile_address(1, 1) + 16);
  CHECK(s.pixel_address(8, 10) == s.tile_address(1, 1) + 64);
}
