/// DDS and KTX2 files with blocks and levels: what is read, what is refused, and files that lie.
#include <zstd.h>
#include <catch2/catch.hpp>

#include <cstring>

#include "models/base/error.h"
#include "models/texture/block/block_format.h"
#include "scenes/image/texture_file.h"

namespace quadrille::scenes {
namespace {

using Bytes = std::vector<std::byte>;
using traces::Format;

void put(Bytes& bytes, std::size_t at, std::uint64_t value, std::size_t count = 4) {
  std::memcpy(bytes.data() + at, &value, count);
}

/// Levels of chance: finest first.
Bytes levels_of(Format format, std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
  Bytes all;
  std::uint32_t state = 1;
  for (std::uint32_t l = 0; l < levels; ++l) {
    const auto bytes = models::format_area_bytes(format, std::max(1u, width >> l), std::max(1u, height >> l));
    for (std::uint64_t i = 0; i < bytes; ++i) {
      state = state * 1664525u + 1013904223u;
      all.push_back(static_cast<std::byte>(state >> 24));
    }
  }
  return all;
}

/// `dxgi` 0: by the code of four letters.
Bytes dds(const char* code, std::uint32_t dxgi, std::uint32_t width, std::uint32_t height,
          std::uint32_t levels, const Bytes& texels) {
  Bytes file(dxgi == 0 ? 128 : 148);
  std::memcpy(file.data(), "DDS ", 4);
  put(file, 4, 124);
  put(file, 12, height);
  put(file, 16, width);
  put(file, 28, levels);
  put(file, 76, 32);
  put(file, 80, 4);
  std::memcpy(file.data() + 84, code, 4);
  if (dxgi != 0) {
    put(file, 128, dxgi);
    put(file, 132, 3);
    put(file, 140, 1);
  }
  file.insert(file.end(), texels.begin(), texels.end());
  return file;
}

struct Ktx {
  std::uint32_t vk_format = 133, width = 20, height = 12, levels = 5, scheme = 0, depth = 0, layers = 0,
                faces = 1, color_model = 0;
};
/// Levels lie coarsest first, as the format asks.
Bytes ktx2(const Ktx& k, Format format, const Bytes& texels) {
  constexpr std::uint8_t kMagic[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
  const std::size_t descriptor = 80 + std::size_t{24} * k.levels;
  Bytes file(descriptor + 44);
  std::memcpy(file.data(), kMagic, sizeof kMagic);
  const std::uint32_t fields[] = {
      k.vk_format, 1,       k.width,  k.height, k.depth,
      k.layers,    k.faces, k.levels, k.scheme, static_cast<std::uint32_t>(descriptor),
      44};
  for (std::size_t i = 0; i < std::size(fields); ++i) put(file, 12 + 4 * i, fields[i]);
  put(file, descriptor + 12, k.color_model, 1);
  std::vector<Bytes> parts;
  std::size_t at = 0;
  for (std::uint32_t l = 0; l < k.levels; ++l) {
    const auto bytes =
        models::format_area_bytes(format, std::max(1u, k.width >> l), std::max(1u, k.height >> l));
    parts.emplace_back(texels.begin() + static_cast<std::ptrdiff_t>(at),
                       texels.begin() + static_cast<std::ptrdiff_t>(at + bytes));
    put(file, 80 + 24 * l + 16, bytes, 8);
    at += bytes;
  }
  for (std::uint32_t l = k.levels; l-- > 0;) {
    Bytes stored = parts[l];
    if (k.scheme == 2) {
      stored.resize(ZSTD_compressBound(parts[l].size()));
      stored.resize(ZSTD_compress(stored.data(), stored.size(), parts[l].data(), parts[l].size(), 1));
    }
    put(file, 80 + 24 * l, file.size(), 8);
    put(file, 80 + 24 * l + 8, stored.size(), 8);
    file.insert(file.end(), stored.begin(), stored.end());
  }
  return file;
}

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
  const std::tuple<const char*, std::uint32_t, Format> codes[] = {
      {"DXT1", 0, Format::kBc1RgbaUnorm}, {"DXT3", 0, Format::kBc2Unorm},    {"DXT5", 0, Format::kBc3Unorm},
      {"ATI1", 0, Format::kBc4Unorm},     {"ATI2", 0, Format::kBc5Unorm},    {"BC4S", 0, Format::kBc4Snorm},
      {"DX10", 72, Format::kBc1RgbaSrgb}, {"DX10", 95, Format::kBc6hUfloat}, {"DX10", 98, Format::kBc7Unorm},
      {"DX10", 99, Format::kBc7Srgb}};
  for (const auto& [code, dxgi, format] : codes) {
    const Bytes texels = levels_of(format, 37, 18, 6);
    const Bytes file = dds(code, dxgi, 37, 18, 6, texels);
    INFO(code << ' ' << dxgi);
    REQUIRE(is_texture_file(file));
    const TextureFile read = read_texture_file(file, "a.dds");
    CHECK(read.format == format);
    CHECK(read.width == 37);
    CHECK(read.height == 18);
    CHECK(read.levels == 6);
    CHECK(read.texels == texels);
  }
}

TEST_CASE("texture_file: DDS of one level, of pixels, and cube maps are pictures as before") {
  const Bytes texels = levels_of(Format::kBc1RgbaUnorm, 16, 16, 5);
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
  for (const auto& [number, format] : {std::pair{133u, Format::kBc1RgbaUnorm},
                                       {146u, Format::kBc7Srgb},
                                       {37u, Format::kR8G8B8A8Unorm},
                                       {9u, Format::kR8Unorm}}) {
    const Bytes texels = levels_of(format, 20, 12, 5);
    for (const std::uint32_t scheme : {0u, 2u}) {
      const TextureFile read =
          read_texture_file(ktx2({.vk_format = number, .scheme = scheme}, format, texels), "a.ktx2");
      CHECK(read.format == format);
      CHECK(read.width == 20);
      CHECK(read.height == 12);
      CHECK(read.levels == 5);
      CHECK(read.texels == texels);
    }
  }
}

TEST_CASE("texture_file: what KTX2 may hold and is not supported is refused by its name") {
  const Format bc1 = Format::kBc1RgbaUnorm;
  const Bytes texels = levels_of(bc1, 20, 12, 5);
  CHECK_THAT(refusal(ktx2({.scheme = 1}, bc1, texels)), Catch::Contains("BasisLZ"));
  CHECK_THAT(refusal(ktx2({.vk_format = 0, .color_model = 166}, bc1, texels)), Catch::Contains("UASTC"));
  CHECK_THAT(refusal(ktx2({.vk_format = 0, .color_model = 163}, bc1, texels)), Catch::Contains("BasisLZ"));
  CHECK_THAT(refusal(ktx2({.scheme = 3}, bc1, texels)), Catch::Contains("ZLIB"));
  CHECK_THAT(refusal(ktx2({.vk_format = 157}, bc1, texels)), Catch::Contains("VkFormat 157"));
  CHECK_THAT(refusal(ktx2({.faces = 6}, bc1, texels)), Catch::Contains("6 faces"));
  CHECK_THAT(refusal(ktx2({.layers = 2}, bc1, texels)), Catch::Contains("2 layers"));
}

TEST_CASE("texture_file: sizes and levels that the files cannot have are refused") {
  const Format bc1 = Format::kBc1RgbaUnorm;
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
  const Bytes texels = levels_of(Format::kBc1RgbaUnorm, 20, 12, 5);
  const Bytes files[] = {ktx2({}, Format::kBc1RgbaUnorm, texels),
                         ktx2({.scheme = 2}, Format::kBc1RgbaUnorm, texels),
                         dds("DXT1", 0, 20, 12, 5, texels), dds("DX10", 71, 20, 12, 5, texels)};
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

TEST_CASE("texture_file: a role's encoding chooses between twins, and pictures are the decoded level") {
  CHECK(with_encoding(Format::kBc7Unorm, true) == Format::kBc7Srgb);
  CHECK(with_encoding(Format::kBc7Srgb, false) == Format::kBc7Unorm);
  CHECK(with_encoding(Format::kBc5Unorm, true) == Format::kBc5Unorm);
  const Bytes texels = levels_of(Format::kBc3Srgb, 20, 12, 5);
  const TextureFile read = read_texture_file(ktx2({.vk_format = 138}, Format::kBc3Srgb, texels), "a.ktx2");
  const Rgba8Image picture = finest_level(read);
  const Bytes decoded = models::decode_blocks(
      Format::kBc3Srgb, 20, 12, std::span(texels).first(models::format_area_bytes(Format::kBc3Srgb, 20, 12)));
  REQUIRE(picture.pixels.size() == decoded.size());
  CHECK(std::memcmp(picture.pixels.data(), decoded.data(), decoded.size()) == 0);
}

}  // namespace quadrille::scenes
