#include "models/texture/layout.h"

#include "models/base/error.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>
#include <tuple>
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

namespace {

constexpr Tiling kTextureTilings[] = {Tiling::kTiled, Tiling::kLinear, Tiling::kMorton, Tiling::kWilliams};

/// The bytes that a texel has in the chain, first component first.
std::vector<std::uint64_t> texel_places(const TextureLayout& layout, std::uint32_t bytes, std::uint32_t level,
                                        std::uint32_t x, std::uint32_t y, std::uint32_t slice) {
  const std::uint32_t index = layout.texel_index(level, x, y, slice);
  std::vector<std::uint64_t> places(bytes);
  for (std::uint32_t i = 0; i < bytes; ++i)
    places[i] = layout.tiling == Tiling::kWilliams ? plane_index(index, layout.plane_row_shift(), i)
                                                   : std::uint64_t{bytes} * index + i;
  return places;
}

}  // namespace

TEST_CASE("texture layout: in every order each byte of a chain has its own place, and holds what was given") {
  for (const Tiling tiling : kTextureTilings) {
    for (const auto& [format, extent, levels] :
         {std::tuple{Format::kR8G8B8A8Srgb, TextureExtent{50, 37}, 6u},
          {Format::kR8G8B8A8Unorm, TextureExtent{1, 1}, 1u},
          {Format::kR8G8B8A8Unorm, TextureExtent{64, 64, 1, 6}, 7u},
          {Format::kR8G8B8A8Unorm, TextureExtent{16, 31, 9}, 5u},
          {Format::kR8G8B8A8Unorm, TextureExtent{3, 300}, 9u},
          {Format::kR8Unorm, TextureExtent{70, 5}, 3u},
          {Format::kR32G32B32A32Float, TextureExtent{33, 65, 1, 2}, 7u}}) {
      DeviceMemory memory;
      const TextureView view = allocate_texture(memory, format, extent, levels, tiling);
      INFO(format_info(format).name << " " << extent.width << "x" << extent.height << ", order "
                                    << static_cast<int>(tiling));
      const std::uint32_t bytes = format_bytes(format);
      std::vector<std::byte> texels;
      std::set<std::uint64_t> places;
      std::vector<std::uint64_t> in_order;
      for (std::uint32_t level = 0; level < levels; ++level)
        for (std::uint32_t slice = 0; slice < static_cast<std::uint32_t>(view.layout.slices[level]); ++slice)
          for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(view.layout.height[level]); ++y)
            for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(view.layout.width[level]); ++x)
              for (const std::uint64_t place : texel_places(view.layout, bytes, level, x, y, slice)) {
                places.insert(place);
                in_order.push_back(place);
                texels.push_back(static_cast<std::byte>(in_order.size() * 2654435761u >> 13));
              }
      CHECK(places.size() == in_order.size());
      CHECK(*places.rbegin() < view.layout.bytes);
      CHECK(view.layout.bytes % kLineBytes == 0);
      tile_texture(memory, view, texels);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < texels.size(); ++i)
        wrong += memory.load<std::byte>(view.base + in_order[i]) == texels[i] ? 0 : 1;
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("texture layout: rows, Morton order and Williams' quadrants are where they are said to be") {
  const TextureExtent extent{32, 16};
  const TextureLayout rows = make_texture_layout(Format::kR8G8B8A8Unorm, extent, 6, Tiling::kLinear);
  CHECK(rows.texel_index(0, 5, 3) == 3 * 32 + 5);
  CHECK(rows.texel_index(0, 0, 0) + 32 * 16 == rows.texel_index(1, 0, 0));
  CHECK(rows.texel_index(4, 1, 0) + 7 < rows.texel_index(5, 0, 0));  // from a line to a line
  const TextureLayout morton = make_texture_layout(Format::kR8G8B8A8Unorm, extent, 6, Tiling::kMorton);
  CHECK(morton.texel_index(0, 1, 0) == 1);
  CHECK(morton.texel_index(0, 0, 1) == 2);
  CHECK(morton.texel_index(0, 2, 3) == 0b1110);
  CHECK(morton.texel_index(0, 15, 15) == 255);
  CHECK(morton.texel_index(0, 16, 0) == 256);  // the next square
  const TextureLayout pyramid = make_texture_layout(Format::kR8G8B8A8Unorm, extent, 6, Tiling::kWilliams);
  CHECK(pyramid.plane_row_shift() == 6);
  const auto place = [&](std::uint32_t level, std::uint32_t x, std::uint32_t y, std::uint32_t component) {
    const std::uint32_t at = plane_index(pyramid.texel_index(level, x, y), 6, component);
    return std::pair{at % 64, at / 64};
  };
  using Place = std::pair<std::uint32_t, std::uint32_t>;
  CHECK(place(0, 3, 5, 0) == Place{35, 5});
  CHECK(place(0, 3, 5, 1) == Place{35, 37});
  CHECK(place(0, 3, 5, 2) == Place{3, 37});
  CHECK(place(0, 3, 5, 3) == Place{35, 64 + 5});
  CHECK(place(2, 3, 2, 0) == Place{11, 2});
  CHECK(place(2, 3, 2, 1) == Place{11, 10});
  CHECK(place(2, 3, 2, 2) == Place{3, 10});
  CHECK(place(5, 0, 0, 0) == Place{1, 0});
  // What Williams' layout is not for is tiled.
  for (const auto& [format, other] : {std::pair{Format::kR8G8B8A8Unorm, TextureExtent{64, 16}},
                                      {Format::kR8Unorm, TextureExtent{64, 64}},
                                      {Format::kBc1RgbUnorm, TextureExtent{64, 64}},
                                      {Format::kR16G16Float, TextureExtent{64, 64}}})
    CHECK(make_texture_layout(format, other, 1, Tiling::kWilliams).tiling == Tiling::kTiled);
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

TEST_CASE("texture layout: texels of blocks of every size have their own places, with those of their block") {
  for (int f = static_cast<int>(Format::kEtc2Rgb8Unorm); f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    const FormatInfo& info = format_info(format);
    INFO(info.name);
    for (const auto& [width, height, levels] :
         {std::tuple{1u, 1u, 1u}, {47u, 101u, 7u}, {400u, 13u, 9u}, {1u, 70u, 7u}, {12u, 12u, 4u}}) {
      const auto tiling = static_cast<Tiling>(f % 3);
      const TextureLayout layout = make_texture_layout(format, TextureExtent{width, height}, levels, tiling);
      CHECK(layout.bytes % kLineBytes == 0);
      std::set<std::uint32_t> texels, blocks;
      std::size_t count = 0, block_count = 0;
      for (std::uint32_t level = 0; level < levels; ++level) {
        const auto w = static_cast<std::uint32_t>(layout.width[level]),
                   h = static_cast<std::uint32_t>(layout.height[level]);
        block_count += format_area_bytes(format, w, h) / info.bytes;
        for (std::uint32_t y = 0; y < h; ++y) {
          for (std::uint32_t x = 0; x < w; ++x, ++count) {
            const std::uint32_t at = layout.texel_index(level, x, y);
            const std::uint32_t first = layout.texel_index(level, x / info.block_width * info.block_width,
                                                           y / info.block_height * info.block_height);
            texels.insert(at);
            blocks.insert(at >> layout.blocks.place_bits);
            if (at - first != y % info.block_height * info.block_width + x % info.block_width)
              FAIL("texel " << x << "," << y << " of level " << level);
          }
        }
      }
      CHECK(texels.size() == count);
      CHECK(blocks.size() == block_count);
      CHECK((std::uint64_t{*blocks.rbegin()} + 1) * info.bytes <= layout.bytes);
    }
  }
}

TEST_CASE("texture layout: the largest texture of blocks of any size has its chain below 2^31 places") {
  for (int f = static_cast<int>(Format::kBc1RgbUnorm); f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    const std::uint64_t blocks = format_area_bytes(format, 16384, 16384) / format_bytes(format);
    const TextureLayout layout = make_texture_layout(format, TextureExtent{16384, 16384}, 15);
    CHECK(layout.bytes < 2 * blocks * format_bytes(format));
  }
}

TEST_CASE("texture layout: upload puts each block where the address of its texels says") {
  for (const Format format : {Format::kAstc5x4Unorm, Format::kAstc8x6Unorm, Format::kAstc12x12Srgb}) {
    DeviceMemory memory;
    (void)memory.allocate(1000);
    const TextureView view = allocate_texture(memory, format, 50, 37, 6);
    std::vector<std::byte> blocks;
    std::vector<std::uint32_t> firsts;
    for (std::uint32_t level = 0, number = 1; level < 6; ++level) {
      firsts.push_back(number);
      const std::uint64_t bytes =
          format_area_bytes(format, std::max(50u >> level, 1u), std::max(37u >> level, 1u));
      for (std::uint64_t at = 0; at < bytes; at += 16, ++number)
        for (std::uint32_t i = 0; i < 16; ++i)
          blocks.push_back(static_cast<std::byte>(number >> 8 * (i % 4) & 255));
    }
    tile_texture(memory, view, blocks);
    const FormatInfo& info = format_info(format);
    for (std::uint32_t level = 0; level < 6; ++level) {
      const auto w = static_cast<std::uint32_t>(view.layout.width[level]),
                 h = static_cast<std::uint32_t>(view.layout.height[level]);
      const std::uint32_t columns = (w + info.block_width - 1) / info.block_width;
      for (std::uint32_t y = 0; y < h; y += info.block_height)
        for (std::uint32_t x = 0; x < w; x += info.block_width)
          CHECK(memory.load<std::uint32_t>(view.texel_address(level, x, y)) ==
                firsts[level] + y / info.block_height * columns + x / info.block_width);
    }
  }
}
