/// Textures compressed on load: sizes, formats, what stays as it is, and the error.
#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include "models/texture/block/block_format.h"
#include "scenes/image/compress.h"

namespace quadrille::scenes {
namespace {

using traces::Format;

/// Smooth, with alpha that falls to the right.
std::vector<std::byte> gradient(std::uint32_t width, std::uint32_t height) {
  std::vector<std::byte> rgba;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (const std::uint32_t value : {255 * x / width, 255 * y / height, 128u, 255 - 255 * x / width})
        rgba.push_back(static_cast<std::byte>(value));
  return rgba;
}

double psnr(std::span<const std::byte> a, std::span<const std::byte> b, std::size_t channels) {
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 4 >= channels) continue;
    const double apart = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    squares += apart * apart;
    ++count;
  }
  return 10 * std::log10(255.0 * 255.0 * count / squares);
}

traces::Image image(Format format, std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
  traces::Image made;
  made.format = format;
  made.width = width;
  made.height = height;
  made.levels = levels;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const auto texels = gradient(traces::level_width(made, level), traces::level_height(made, level));
    made.texels.insert(made.texels.end(), texels.begin(), texels.end());
  }
  return made;
}

}  // namespace

TEST_CASE("compress: blocks have a gradient within the error that their code is known for") {
  const std::vector<std::byte> rgba = gradient(62, 37);
  const auto bc1 = compress_texels(rgba, 62, 37, TextureCompression::kBc1),
             bc3 = compress_texels(rgba, 62, 37, TextureCompression::kBc3);
  CHECK(bc1.size() == 16 * 10 * 8);
  CHECK(bc3.size() == 16 * 10 * 16);
  const std::vector<std::byte> decoded = models::decode_blocks(Format::kBc3Unorm, 62, 37, bc3);
  CHECK(psnr(rgba, decoded, 4) > 36);
  CHECK(psnr(rgba, decoded, 4) < 60);
}

TEST_CASE("compress: alpha of BC1 is 0 below the half and 1 above") {
  std::vector<std::byte> rgba = gradient(64, 4);
  const std::vector<std::byte> decoded = models::decode_blocks(
      Format::kBc1RgbaUnorm, 64, 4, compress_texels(rgba, 64, 4, TextureCompression::kBc1));
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    CHECK(static_cast<int>(decoded[i]) == (static_cast<int>(rgba[i]) >= 128 ? 255 : 0));
}

TEST_CASE("compress: ASTC has 16 bytes a block, and much larger blocks have a larger error") {
  // The encoder stops where a block is good enough, so blocks a little larger may have less error.
  const std::vector<std::byte> rgba = gradient(96, 60);
  double before = 100;
  for (const auto& [how, format, blocks, least] :
       {std::tuple{TextureCompression::kAstc4x4, Format::kAstc4x4Unorm, 24 * 15, 46.0},
        {TextureCompression::kAstc8x5, Format::kAstc8x5Unorm, 12 * 12, 40.0},
        {TextureCompression::kAstc12x12, Format::kAstc12x12Unorm, 8 * 5, 30.0}}) {
    const std::vector<std::byte> made = compress_texels(rgba, 96, 60, how);
    CHECK(made.size() == 16 * static_cast<std::size_t>(blocks));
    CHECK(compress_texels(rgba, 96, 60, how) == made);
    const double found = psnr(rgba, models::decode_blocks(format, 96, 60, made), 4);
    CHECK(found > least);
    CHECK(found < before);
    before = found;
  }
}

TEST_CASE(
    "compress: every size of blocks of ASTC has its format, of sRGB too, whatever the size of a level") {
  for (auto c = static_cast<int>(TextureCompression::kAstc4x4);
       c < static_cast<int>(kCompressionNames.size()); ++c) {
    traces::CommandStream stream;
    stream.images = {image(Format::kR8G8B8A8Srgb, 13, 7, 4), image(Format::kR8G8B8A8Unorm, 13, 7, 4)};
    CHECK(compress_textures(stream, static_cast<TextureCompression>(c)) == 2);
    const std::string_view name = kCompressionNames[static_cast<std::size_t>(c)];
    const std::string size = name == "astc" ? "4x4" : std::string(name.substr(4));
    CHECK(models::format_info(stream.images[0].format).name == "ASTC_" + size + "_SRGB_BLOCK");
    CHECK(models::format_info(stream.images[1].format).name == "ASTC_" + size + "_UNORM_BLOCK");
    for (const traces::Image& made : stream.images) {
      CHECK(made.texels.size() == traces::texel_bytes(made));
      CHECK(traces::decompressed(made).texels.size() == std::size_t{4} * (13 * 7 + 6 * 3 + 3 * 1 + 1));
    }
  }
}

TEST_CASE("compress: the bytes of ASTC are those of every host that this was tried on") {
  std::uint64_t hash = 14695981039346656037u;
  for (const TextureCompression how : {TextureCompression::kAstc4x4, TextureCompression::kAstc6x6})
    for (const std::byte b : compress_texels(gradient(61, 33), 61, 33, how))
      hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
  CHECK(hash == 12971163480842088545u);
}

TEST_CASE("compress: textures of RGBA8 in all levels, packed or not, and nothing else") {
  traces::CommandStream stream;
  stream.images = {image(Format::kR8G8B8A8Srgb, 33, 18, 6), image(Format::kR8G8B8A8Unorm, 33, 18, 6),
                   image(Format::kR8G8B8A8Unorm, 8, 8, 1), image(Format::kR8G8B8A8Unorm, 8, 8, 1)};
  stream.images[1].packed = std::make_shared<const traces::UnpackTexels>(
      [whole = image(Format::kR8G8B8A8Unorm, 33, 18, 6)](const traces::LevelSink& sink) {
        std::span<const std::byte> rest = whole.texels;
        for (std::uint32_t level = 0; level < whole.levels; ++level) {
          sink(level, rest.first(traces::level_bytes(whole, level)));
          rest = rest.subspan(traces::level_bytes(whole, level));
        }
      });
  stream.images[1].texels.clear();
  stream.images[2].usage = traces::kColorAttachment | traces::kSampled;
  stream.images[2].texels.clear();
  stream.images[3].format = Format::kR32Float;
  const std::vector<traces::Image> before = stream.images;

  CHECK(compress_textures(stream, TextureCompression::kBc1) == 2);
  CHECK(stream.images[0].format == Format::kBc1RgbaSrgb);
  CHECK(stream.images[1].format == Format::kBc1RgbaUnorm);
  CHECK(stream.images[2] == before[2]);
  CHECK(stream.images[3] == before[3]);
  CHECK(stream.images[0].texels.size() == traces::texel_bytes(stream.images[0]));
  CHECK(stream.images[1].texels.empty());
  traces::unpack(stream.images[1]);
  CHECK(stream.images[1].texels == stream.images[0].texels);
}

}  // namespace quadrille::scenes
