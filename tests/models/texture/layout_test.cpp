#include "models/texture/layout.h"

#include "models/base/error.h"

#include <catch2/catch.hpp>

#include <set>
#include <vector>

using namespace quadrille::models;

TEST_CASE("texture layout: texels of a chain have their own places within it") {
  for (const auto& [width, height, levels] : {std::tuple{1u, 1u, 1u},
                                              {211u, 211u, 8u},
                                              {1u, 70u, 7u},
                                              {70u, 1u, 7u},
                                              {64u, 32u, 7u},
                                              {33u, 5u, 2u}}) {
    const TextureLayout layout = make_texture_layout(width, height, levels);
    CHECK(layout.bytes % kLineBytes == 0);
    std::set<std::uint32_t> seen;
    std::size_t texels = 0;
    for (std::uint32_t level = 0; level < levels; ++level) {
      CHECK(layout.first[level] % 32 == 0);
      for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(layout.height[level]); ++y) {
        for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(layout.width[level]); ++x, ++texels)
          seen.insert(layout.texel_index(level, x, y));
      }
    }
    CHECK(seen.size() == texels);
    CHECK(*seen.rbegin() < layout.bytes / 4);
    CHECK(*seen.rbegin() >= layout.bytes / 4 - 32);  // no line more than needed at the end
  }
}

TEST_CASE("texture layout: a sector is 4x2 texels and a line 8x4 and a tile 32x32") {
  const TextureLayout layout = make_texture_layout(256, 256, 9);
  for (std::uint32_t y = 0; y < 256; ++y) {
    for (std::uint32_t x = 0; x < 256; ++x) {
      const std::uint32_t i = layout.texel_index(0, x, y);
      if (i / 8 != layout.texel_index(0, x / 4 * 4, y / 2 * 2) / 8 ||
          i / 32 != layout.texel_index(0, x / 8 * 8, y / 4 * 4) / 32 || i / 1024 != (y / 32) * 8 + x / 32) {
        FAIL("texel " << x << "," << y);
      }
    }
  }
  SUCCEED();
}

TEST_CASE("texture layout: upload puts each texel where its address says") {
  DeviceMemory memory;
  (void)memory.allocate(1000);
  std::vector<std::byte> texels;
  for (std::uint32_t level = 0; level < 6; ++level) {
    const std::uint32_t w = std::max(50u >> level, 1u), h = std::max(37u >> level, 1u);
    for (std::uint32_t y = 0; y < h; ++y) {
      for (std::uint32_t x = 0; x < w; ++x) {
        for (const std::uint32_t v : {x, y, level, 7u}) texels.push_back(static_cast<std::byte>(v));
      }
    }
  }
  const TextureView view = allocate_texture(memory, Format::kR8G8B8A8Srgb, 50, 37, 6);
  tile_texture(memory, view, texels);
  CHECK(view.base % kLineBytes == 0);
  for (std::uint32_t level = 0; level < 6; ++level) {
    for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(view.layout.height[level]); ++y) {
      for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(view.layout.width[level]); ++x) {
        if (memory.load<std::uint32_t>(view.texel_address(level, x, y)) !=
            (x | y << 8 | level << 16 | 7u << 24))
          FAIL("level " << level);
      }
    }
  }
  texels.pop_back();
  CHECK_THROWS_AS(tile_texture(memory, view, texels), quadrille::UserError);
}

TEST_CASE("texture layout: impossible sizes are the user's error") {
  CHECK_THROWS_AS(make_texture_layout(0, 1, 1), quadrille::UserError);
  CHECK_THROWS_AS(make_texture_layout(1, 16385, 1), quadrille::UserError);
  CHECK_THROWS_AS(make_texture_layout(8, 8, 5), quadrille::UserError);
  CHECK_THROWS_AS(make_texture_layout(8, 8, 0), quadrille::UserError);
  CHECK(make_texture_layout(16384, 16384, 15).bytes < std::uint64_t{1} << 31);
  CHECK(make_texture_layout(1, 1, 1).bytes == 128);
}
