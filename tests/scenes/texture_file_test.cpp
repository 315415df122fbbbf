/// DDS and KTX2 files with blocks and levels: what is read, what is refused, and files that lie.
#include "scenes/image/texture_file.h"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include "models/base/error.h"
#include "tests/scenes/texture_files.h"

namespace quadrille::scenes {
namespace {

using Bytes = FileBytes;
using models::BlockCode;
using Code = BlockCodeOrNone;

std::string refusal(const Bytes& file) {
  try {
    static_cast<void>(read_texture_file(file, "a.file"));
  } catch (const UserError& error) { return error.what(); }
  return "";
}

/// Reading ends well, or with an error that starts with the name.
void check_survives(const Bytes& file) {
  if (!is_texture_file(file)) return;
  try {
    const TextureFile read = read_texture_file(file, "a.file");
    CHECK(read.levels >= 1);
  } catch (const UserError& error) { CHECK_THAT(error.what(), Catch::StartsWith("a.file: ")); }
}

}  // namespace

TEST_CASE("texture_file: DDS of every code brings its levels as they are") {
  const std::tuple<const char*, std::uint32_t, BlockCode> codes[] = {
      {"DXT1", 0, BlockCode::kBc1Rgba},  {"DXT3", 0, BlockCode::kBc2},
      {"DXT5", 0, BlockCode::kBc3},      {"ATI1", 0, BlockCode::kBc4Unorm},
      {"ATI2", 0, BlockCode::kBc5Unorm}, {"BC4S", 0, BlockCode::kBc4Snorm},
      {"DX10", 72, BlockCode::kBc1Rgba}, {"DX10", 95, BlockCode::kBc6hUfloat},
      {"DX10", 98, BlockCode::kBc7},     {"DX10", 99, BlockCode::kBc7}};
  for (const auto& [letters, dxgi, code] : codes) {
    const Bytes texels = levels_of(code, 37, 18, 6);
    const Bytes file = dds(letters, dxgi, 37, 18, 6, texels);
    INFO(letters << ' ' << dxgi);
    REQUIRE(is_texture_file(file));
    const TextureFile read = read_texture_file(file, "a.dds");
    CHECK(read.code == code);
    CHECK(read.width == 37);
    CHECK(read.height == 18);
    CHECK(read.levels == 6);
    CHECK(read.bytes == texels);
  }
}

TEST_CASE("texture_file: DDS of one level, of pixels, and cube maps are pictures as before") {
  const Bytes texels = levels_of(BlockCode::kBc1Rgba, 16, 16, 5);
  CHECK_FALSE(is_texture_file(dds("DXT1", 0, 16, 16, 1, texels)));
  CHECK_FALSE(is_texture_file(dds("RGBG", 0, 16, 16, 5, texels)));
  Bytes cube = dds("DXT1", 0, 16, 16, 5, texels);
  put(cube, 112, 0x200);
  CHECK_FALSE(is_texture_file(cube));
  Bytes cube10 = dds("DX10", 71, 16, 16, 5, texels);
  put(cube10, 136, 4);
  CHECK_FALSE(is_texture_file(cube10));
}

TEST_CASE("texture_file: KTX2 brings its levels, plain or packed by Zstandard") {
  for (const auto& [number, code] : {std::pair{133u, Code(BlockCode::kBc1Rgba)},
                                     {146u, Code(BlockCode::kBc7)},
                                     {147u, Code(BlockCode::kEtc2Rgb8)},
                                     {150u, Code(BlockCode::kEtc2Rgb8A1)},
                                     {152u, Code(BlockCode::kEtc2Rgba8)},
                                     {153u, Code(BlockCode::kEacR11Unorm)},
                                     {156u, Code(BlockCode::kEacR11G11Snorm)},
                                     {157u, Code(BlockCode::kAstc4x4Unorm)},
                                     {160u, Code(BlockCode::kAstc5x4Srgb)},
                                     {165u, Code(BlockCode::kAstc6x6Unorm)},
                                     {184u, Code(BlockCode::kAstc12x12Srgb)},
                                     {37u, Code()},
                                     {43u, Code()}}) {
    const Bytes texels = levels_of(code, 20, 12, 5);
    for (const std::uint32_t scheme : {0u, 2u}) {
      const TextureFile read =
          read_texture_file(ktx2({.vk_format = number, .scheme = scheme}, code, texels), "a.ktx2");
      CHECK(read.code == code);
      CHECK(read.width == 20);
      CHECK(read.height == 12);
      CHECK(read.levels == 5);
      CHECK(read.bytes == texels);
    }
  }
}

TEST_CASE("texture_file: what KTX2 may hold and is not supported is refused by its name") {
  const Code bc1 = BlockCode::kBc1Rgba;
  const Bytes texels = levels_of(bc1, 20, 12, 5);
  CHECK_THAT(refusal(ktx2({.scheme = 1}, bc1, texels)), Catch::Contains("BasisLZ"));
  CHECK_THAT(refusal(ktx2({.vk_format = 0, .color_model = 166}, bc1, texels)), Catch::Contains("UASTC"));
  CHECK_THAT(refusal(ktx2({.vk_format = 0, .color_model = 163}, bc1, texels)), Catch::Contains("BasisLZ"));
  CHECK_THAT(refusal(ktx2({.scheme = 3}, bc1, texels)), Catch::Contains("ZLIB"));
  CHECK_THAT(refusal(ktx2({.vk_format = 185}, bc1, texels)), Catch::Contains("VkFormat 185"));
  constexpr std::uint32_t kAstcOfHalves = 1000066000;
  CHECK_THAT(refusal(ktx2({.vk_format = kAstcOfHalves}, bc1, texels)), Catch::Contains("1000066000"));
  CHECK_THAT(refusal(ktx2({.faces = 6}, bc1, texels)), Catch::Contains("6 faces"));
  CHECK_THAT(refusal(ktx2({.layers = 2}, bc1, texels)), Catch::Contains("2 layers"));
}

TEST_CASE("texture_file: sizes and levels that the files cannot have are refused") {
  const Code bc1 = BlockCode::kBc1Rgba;
  const Bytes texels = levels_of(bc1, 20, 12, 5);
  Bytes file = ktx2({}, bc1, texels);
  put(file, 40, 6);
  CHECK_THAT(refusal(file), Catch::Contains("6 levels"));
  file = ktx2({}, bc1, texels);
  put(file, 20, 70000);
  CHECK_THAT(refusal(file), Catch::Contains("70000x12"));
  file = ktx2({}, bc1, texels);
  put(file, 80, ~std::uint64_t{0}, 8);
  CHECK_THAT(refusal(file), Catch::Contains("level 0 lies beyond the end"));
  file = ktx2({.scheme = 2}, bc1, texels);
  std::uint64_t first = 0;  // the mark of a Zstandard frame
  std::memcpy(&first, file.data() + 80, sizeof first);
  put(file, first, 0);
  CHECK_THAT(refusal(file), Catch::StartsWith("a.file: level "));
  CHECK_THAT(refusal(dds("DXT1", 0, 16, 16, 6, texels)), Catch::Contains("6 levels"));
  CHECK_THAT(refusal(dds("DXT1", 0, 64, 64, 5, texels)), Catch::Contains("bytes of levels"));
}

TEST_CASE("texture_file: cut anywhere, or with any byte of the header changed, a file is read or refused") {
  const Bytes texels = levels_of(BlockCode::kBc1Rgba, 20, 12, 5);
  const Bytes astc = levels_of(BlockCode::kAstc10x6Unorm, 20, 12, 5);
  const Bytes files[] = {ktx2({}, BlockCode::kBc1Rgba, texels),
                         ktx2({.vk_format = 175}, BlockCode::kAstc10x6Unorm, astc),
                         ktx2({.scheme = 2}, BlockCode::kBc1Rgba, texels), dds("DXT1", 0, 20, 12, 5, texels),
                         dds("DX10", 71, 20, 12, 5, texels)};
  for (const Bytes& whole : files) {
    for (std::size_t size = 0; size < whole.size(); ++size)
      check_survives(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    for (std::size_t at = 12; at < 250; ++at) {
      for (const unsigned bits : {0x01u, 0x80u, 0xffu}) {
        Bytes changed = whole;
        changed[at] = static_cast<std::byte>(static_cast<unsigned>(changed[at]) ^ bits);
        check_survives(changed);
      }
    }
  }
}

TEST_CASE("texture_file: a level is the texels of its blocks, without those that lie beyond it") {
  const Bytes blocks = levels_of(BlockCode::kBc3, 18, 7, 2);
  const TextureFile file{BlockCode::kBc3, 18, 7, 2, blocks};
  const Rgba8Image finest = decoded_level(file, 0), second = decoded_level(file, 1);
  REQUIRE(finest.pixels.size() == 4 * 18 * 7);
  REQUIRE(second.width == 9);
  REQUIRE(second.height == 3);
  models::BlockTexels block;
  // The block at (16, 4) has two columns and three rows inside; the last of the second level one column.
  models::decode_block(BlockCode::kBc3, std::span(blocks).subspan(16 * (5 + 4), 16), block);
  for (std::size_t y = 0; y < 3; ++y)
    CHECK(std::memcmp(&finest.pixels[4 * ((4 + y) * 18 + 16)], &block.bytes[16 * y], 8) == 0);
  models::decode_block(BlockCode::kBc3, std::span(blocks).subspan(16 * (10 + 2), 16), block);
  for (std::size_t y = 0; y < 3; ++y)
    CHECK(std::memcmp(&second.pixels[4 * (y * 9 + 8)], &block.bytes[16 * y], 4) == 0);
}

TEST_CASE("texture_file: levels of every code are decoded, whatever their size leaves of the last blocks") {
  for (int c = 0; c <= static_cast<int>(models::kLastBlockCode); ++c) {
    const auto code = static_cast<BlockCode>(c);
    const models::BlockCodeInfo& info = models::block_code_info(code);
    const TextureFile file{code, 25, 13, 5, levels_of(code, 25, 13, 5)};
    INFO(info.name);
    std::size_t at = 0;
    for (std::uint32_t level = 0; level < 5; ++level) {
      const Rgba8Image picture = decoded_level(file, level);
      REQUIRE(picture.pixels.size() == std::size_t{4} * picture.width * picture.height);
      if (info.decoded == models::DecodedTexels::kRgba8) {
        models::BlockTexels block;
        models::decode_block(code, std::span(file.bytes).subspan(at, info.bytes), block);
        for (std::size_t y = 0; y < std::min<std::size_t>(info.height, picture.height); ++y)
          CHECK(std::memcmp(&picture.pixels[4 * y * picture.width], &block.bytes[4 * y * info.width],
                            4 * std::min<std::size_t>(info.width, picture.width)) == 0);
      }
      at += std::size_t{info.bytes} * ((picture.width + info.width - 1) / info.width) *
            ((picture.height + info.height - 1) / info.height);
    }
    CHECK(at == file.bytes.size());
  }
}

TEST_CASE("texture_file: a file of a size that its levels do not have, or of none at all, is refused") {
  const Bytes texels = levels_of(BlockCode::kAstc8x5Unorm, 20, 12, 5);
  for (const auto& [width, height] : {std::pair{0u, 12u}, {20u, 0u}, {0xffffffffu, 1u}, {16385u, 1u}}) {
    Bytes file = ktx2({.vk_format = 167}, BlockCode::kAstc8x5Unorm, texels);
    put(file, 20, width);
    put(file, 24, height);
    CHECK_THAT(refusal(file), Catch::Contains("legal are 1x1 to 16384x16384"));
  }
  Bytes file = ktx2({.vk_format = 167}, BlockCode::kAstc8x5Unorm, texels);
  put(file, 20, 25);
  CHECK_THAT(refusal(file), Catch::Contains("bytes where"));
}

TEST_CASE(
    "texture_file: components that a code lacks are 0, alpha 1, and numbers beyond 0 to 1 are clamped") {
  const auto texel = [](BlockCode code, const Bytes& block) {
    const Rgba8Image picture = decoded_level({code, 4, 4, 1, block}, 0);
    return std::array<int, 4>{picture.pixels[0], picture.pixels[1], picture.pixels[2], picture.pixels[3]};
  };
  Bytes block(16);
  put(block, 0, 200, 1);
  put(block, 8, 100, 1);
  CHECK(texel(BlockCode::kBc5Unorm, block) == std::array{200, 100, 0, 255});
  CHECK(texel(BlockCode::kBc5Snorm, block) == std::array{0, 201, 0, 255});  // 200 is -56
  block.resize(8);
  CHECK(texel(BlockCode::kBc4Unorm, block) == std::array{200, 0, 0, 255});
  // EAC: a base of 200, a multiplier of 0, and the first modifier of the first table: 1601 of 2047.
  CHECK(texel(BlockCode::kEacR11Unorm, block) == std::array{199, 0, 0, 255});
  CHECK(texel(BlockCode::kEacR11Snorm, block) == std::array{0, 0, 0, 255});  // 200 is -56
  // BC6H in the mode of two ends of ten bits, all indices 0: red the largest half, green one half, blue zero.
  Bytes halves(16);
  put(halves, 0, 3ull | 1023ull << 5 | 462ull << 15, 8);
  const auto color = texel(BlockCode::kBc6hUfloat, halves);
  CHECK(color[0] == 255);
  CHECK(std::abs(color[1] - 128) <= 1);
  CHECK(color[2] == 0);
  CHECK(color[3] == 255);
}

}  // namespace quadrille::scenes
