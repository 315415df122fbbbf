/// Textures of compressed blocks in memory, and the lines that a request for them looks up.
#include <catch2/catch.hpp>

#include <map>
#include <set>
#include <vector>

#include "models/texture/block/block_format.h"
#include "models/texture/sample.h"
#include "tests/models/random_source.h"

namespace quadrille::models {
namespace {

std::vector<std::byte> chance(RandomSource& random, std::size_t bytes) {
  std::vector<std::byte> all(bytes);
  for (std::byte& b : all) b = static_cast<std::byte>(random.bits() & 0xff);
  return all;
}

std::size_t chain_bytes(Format format, std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
  std::size_t bytes = 0;
  for (std::uint32_t l = 0; l < levels; ++l)
    bytes += format_area_bytes(format, std::max(1u, width >> l), std::max(1u, height >> l));
  return bytes;
}

/// A request of nearest samples at the centres of 8x4 texels.
TextureRequest texels_from(const TextureView& view, std::uint32_t x, std::uint32_t y) {
  TextureRequest request;
  request.op = Op::kTexLod;
  request.active = ~LaneMask{0};
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    const auto column = static_cast<float>(x + lane % 8), row = static_cast<float>(y + lane / 8);
    request.u[lane] = (column + 0.5f) / static_cast<float>(view.layout.width[0]);
    request.v[lane] = (row + 0.5f) / static_cast<float>(view.layout.height[0]);
    request.lod[lane] = 0;
  }
  return request;
}

constexpr SamplerState kNearest{Filter::kNearest, Filter::kNearest, Filter::kNearest};

}  // namespace

TEST_CASE("block layout: bytes of areas are those of whole blocks") {
  CHECK(format_area_bytes(Format::kBc1RgbaUnorm, 4, 4) == 8);
  CHECK(format_area_bytes(Format::kBc1RgbaUnorm, 1, 1) == 8);
  CHECK(format_area_bytes(Format::kBc7Unorm, 5, 4) == 32);
  CHECK(format_area_bytes(Format::kR8G8B8A8Unorm, 5, 4) == 80);
}

TEST_CASE("block layout: every block of every level has a place of its own within the chain") {
  for (const Format format : {Format::kBc1RgbaUnorm, Format::kBc7Unorm}) {
    for (const auto& [width, height, levels] :
         {std::tuple{1u, 1u, 1u}, {211u, 97u, 8u}, {1u, 70u, 7u}, {256u, 256u, 9u}, {130u, 5u, 3u}}) {
      const TextureLayout layout = make_texture_layout(format, width, height, levels);
      CHECK(layout.bytes % kLineBytes == 0);
      std::set<std::uint32_t> texels, blocks;
      std::size_t expected = 0;
      for (std::uint32_t level = 0; level < levels; ++level) {
        const auto w = static_cast<std::uint32_t>(layout.width[level]),
                   h = static_cast<std::uint32_t>(layout.height[level]);
        expected += std::size_t{(w + 3) / 4} * ((h + 3) / 4);
        for (std::uint32_t y = 0; y < h; ++y)
          for (std::uint32_t x = 0; x < w; ++x) {
            const std::uint32_t index = layout.texel_index(level, x, y);
            CHECK(texels.insert(index).second);
            CHECK((index & 15) == (x & 3) + 4 * (y & 3));
            blocks.insert(index >> 4);
          }
      }
      CHECK(blocks.size() == expected);
      CHECK(std::uint64_t{*blocks.rbegin()} * format_bytes(format) < layout.bytes);
    }
  }
}

TEST_CASE("block layout: nearest samples are the decoded texels, of every code and level") {
  RandomSource random(9);
  for (const Format format : {Format::kBc1RgbUnorm, Format::kBc3Unorm, Format::kBc7Unorm}) {
    DeviceMemory memory(1 << 20);
    const std::uint32_t width = 35, height = 22, levels = 6;
    const TextureView view = allocate_texture(memory, format, width, height, levels);
    const std::vector<std::byte> blocks = chance(random, chain_bytes(format, width, height, levels));
    tile_texture(memory, view, blocks);
    const std::vector<std::byte> texels = decode_blocks(
        format, width, height, std::span(blocks).first(format_area_bytes(format, width, height)));
    TexturePlan plan;
    std::array<LaneFloats, 4> rgba;
    for (std::uint32_t y = 0; y + 4 <= height; y += 3) {
      for (std::uint32_t x = 0; x + 8 <= width; x += 5) {
        plan_texture(view, kNearest, texels_from(view, x, y), {}, plan);
        filter_texture(plan, memory, rgba);
        for (std::size_t lane = 0; lane < kWarpLanes; ++lane)
          for (std::size_t c = 0; c < 4; ++c) {
            const std::size_t at = 4 * ((y + lane / 8) * width + x + lane % 8) + c;
            CHECK(rgba[c][lane] == static_cast<float>(texels[at]) / 255.0f);
          }
      }
    }
  }
}

TEST_CASE("block layout: a request names its blocks and lines once") {
  DeviceMemory memory(1 << 20);
  const TextureView view = allocate_texture(memory, Format::kBc1RgbaUnorm, 64, 64, 1);
  TexturePlan plan;
  plan_texture(view, kNearest, texels_from(view, 4, 8), {}, plan);
  CHECK(plan.block_count == 2);
  CHECK(plan.line_count == 1);
  CHECK(plan.bilinear_quads == 8);
  plan_texture(view, kNearest, texels_from(view, 6, 10), {}, plan);
  CHECK(plan.block_count == 6);
}

TEST_CASE("block layout: decoded lines of two textures never have the same number, nor sectors of others") {
  for (const Format format : {Format::kBc1RgbaUnorm, Format::kBc4Unorm, Format::kBc5Unorm,
                              Format::kBc6hUfloat, Format::kBc7Unorm}) {
    DeviceMemory memory(1 << 20);
    const TextureView first = allocate_texture(memory, format, 64, 64, 1),
                      second = allocate_texture(memory, format, 64, 64, 1);
    std::map<std::uint32_t, std::uint64_t> owner;
    for (const TextureView* view : {&first, &second}) {
      for (std::uint32_t y = 0; y < 64; y += 4) {
        for (std::uint32_t x = 0; x < 64; x += 8) {
          TexturePlan plan;
          plan_texture(*view, kNearest, texels_from(*view, x, y), {}, plan);
          std::vector<DecodedLine> lines;
          add_decoded_lines(plan, lines);
          REQUIRE_FALSE(lines.empty());
          for (const DecodedLine& line : lines) {
            CHECK(owner.try_emplace(line.line, view->base).first->second == view->base);
            const std::uint64_t from = std::uint64_t{line.from.line} * kLineBytes;
            CHECK(from >= view->base);
            CHECK(from < view->base + view->layout.bytes);
            CHECK(line.from.sectors != 0);
            CHECK(line.from.sectors < 16);
            CHECK(line.blocks * 16 * block_code_info(block_code(format)).decoded_bytes == kLineBytes);
          }
        }
      }
    }
  }
}

}  // namespace quadrille::models
