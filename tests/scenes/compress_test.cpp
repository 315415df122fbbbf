/// Textures compressed on load: sizes, formats, what stays as it is, and the error.
#include <catch2/catch.hpp>

#include <cmath>
#include <memory>

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
