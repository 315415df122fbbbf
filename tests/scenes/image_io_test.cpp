#include "scenes/image/image_io.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>

#include "models/base/error.h"
#include "tests/scenes/gltf_text.h"
#include "traces/whole_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

Rgba8Image gradient(std::uint32_t width, std::uint32_t height) {
  Rgba8Image image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    for (std::uint32_t c = 0; c < 4; ++c) image.pixels.push_back(static_cast<std::uint8_t>(i * (c + 3) + 17 * c));
  }
  return image;
}

/// The image has this size, and this colour everywhere.
void require_plain(const Rgba8Image& image, std::uint32_t width, std::uint32_t height, const std::array<std::uint8_t, 4>& color) {
  REQUIRE(image.width == width);
  REQUIRE(image.height == height);
  REQUIRE(image.pixels.size() == std::size_t{4} * width * height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) REQUIRE(image.pixels[i] == color[i % 4]);
}

}  // namespace

TEST_CASE("image_io: a PNG comes back bit for bit, colours under zero alpha included") {
  const TempGltf folder("", "a.png");
  const Rgba8Image image = gradient(13, 7);
  save_png(folder.path(), image);
  const Rgba8Image back = load_image(folder.path());
  REQUIRE(back.width == 13);
  REQUIRE(back.height == 7);
  REQUIRE(back.pixels == image.pixels);
}

TEST_CASE("image_io: EXR keeps floats exactly, infinities included") {
  const TempGltf folder("", "a.exr");
  for (const std::uint32_t channels : {1U, 3U, 4U}) {
    FloatImage image{5, 3, channels, {}};
    for (std::uint32_t i = 0; i < 15 * channels; ++i) image.pixels.push_back(std::ldexp(1.1F, static_cast<int>(i) - 30));
    image.pixels[2] = INFINITY;
    save_exr(folder.path(), image);
    const FloatImage back = load_float_image(folder.path());
    REQUIRE(back.channels == channels);
    REQUIRE(back.pixels == image.pixels);
  }
}

TEST_CASE("image_io: a file holds its picture and no date, so that writing it again gives the same bytes") {
  const auto today = [] {
    const std::time_t now = std::time(nullptr);
    std::array<char, 16> text{};
    std::strftime(text.data(), text.size(), "%Y:%m:%d", std::localtime(&now));
    return std::string(text.data());
  };
  for (const char* name : {"a.png", "a.exr"}) {
    const TempGltf folder("", name);
    const auto written = [&] {
      if (folder.path().ends_with("exr")) {
        save_exr(folder.path(), {2, 2, 1, {1, 2, 3, 4}});
      } else {
        save_png(folder.path(), gradient(2, 2));
      }
      const std::vector<std::byte> bytes = traces::read_whole_file(folder.path(), 1 << 20);
      return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const std::string before = today(), file = written(), after = today();
    CAPTURE(name);
    CHECK(file == written());
    CHECK(file.find(before) == std::string::npos);
    CHECK(file.find(after) == std::string::npos);
    CHECK(file.find("tIME") == std::string::npos);  // a PNG's date is seven binary bytes behind this
  }
}

TEST_CASE("image_io: every truncation of a PNG is refused with its name") {
  const TempGltf folder("", "a.png");
  save_png(folder.path(), gradient(16, 16));
  const std::vector<std::byte> bytes = traces::read_whole_file(folder.path(), 1 << 20);
  for (std::size_t size = 0; size + 20 < bytes.size(); size += 7) {  // the last bytes are the end marker, which holds no pixels
    CAPTURE(size);
    REQUIRE_THROWS_WITH(decode_image(std::span(bytes).first(size), "some.png"), Catch::StartsWith("some.png: "));
  }
}

TEST_CASE("image_io: what is no image, and what cannot be written, is the user's error") {
  const std::vector<std::byte> noise(100, std::byte{42});
  REQUIRE_THROWS_WITH(decode_image(noise, "x.png"), "x.png: not a PNG, JPEG, WebP, DDS or EXR image (by its first bytes)");
  const std::vector<std::byte> jpeg{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}, std::byte{0xe0}};
  REQUIRE_THROWS_WITH(decode_image(jpeg, "x.jpg"), "x.jpg: the JPEG image is truncated");
  REQUIRE_THROWS_AS(load_image("/nonexistent/x.png"), UserError);
  REQUIRE_THROWS_AS(save_png("/nonexistent/x.png", gradient(2, 2)), UserError);
}

TEST_CASE("image_io: a WebP image is decoded, a truncated one is refused") {
  // 3 x 2 texels of (200, 100, 50), lossless, written by libwebp.
  const std::vector<unsigned char> file{0x52, 0x49, 0x46, 0x46, 0x1e, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56,
                                        0x50, 0x38, 0x4c, 0x11, 0x00, 0x00, 0x00, 0x2f, 0x02, 0x40, 0x00, 0x00, 0x07,
                                        0x50, 0xb2, 0x22, 0x57, 0xa6, 0xff, 0x81, 0x88, 0xe8, 0x7f, 0x00, 0x00};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
  require_plain(decode_image(bytes, "a.webp"), 3, 2, {200, 100, 50, 255});
  for (std::size_t size = 12; size < bytes.size() - 4; size += 3)
    REQUIRE_THROWS_WITH(decode_image(bytes.first(size), "a.webp"), Catch::StartsWith("a.webp: "));
}

TEST_CASE("image_io: the colours of a WebP image with alpha are as they were written, not multiplied by it") {
  // 2 x 2 texels of (200, 100, 50, 60), lossless, written by libwebp.
  std::vector<unsigned char> file{82, 73, 70, 70, 30, 0,  0, 0,  87,  69, 66, 80,  86, 80,  56,  76,  17,  0, 0,
                                  0,  47, 1,  64, 0,  16, 7, 80, 178, 34, 87, 166, 60, 129, 136, 232, 127, 0, 0};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
  require_plain(decode_image(bytes, "a.webp"), 2, 2, {200, 100, 50, 60});
  for (std::size_t i = 25; i < 32; ++i) file[i] = 0;
  REQUIRE_THROWS_WITH(decode_image(bytes, "a.webp"), Catch::StartsWith("a.webp: cannot be decoded as webp: "));
}

TEST_CASE("image_io: a DDS image of one DXT1 block is decoded, a truncated one is refused") {
  std::vector<std::uint32_t> file(32 + 2, 0);
  file[0] = 0x20534444;  // "DDS "
  file[1] = 124, file[2] = 0x81007, file[3] = file[4] = 4, file[5] = 8;
  file[19] = 32, file[20] = 4, file[21] = 0x31545844;  // pixel format: four characters, "DXT1"
  file[27] = 0x1000;                                   // a texture
  file[32] = 0x07e0f800;                               // the block's colours: red, green
  file[33] = 0x55000000;                               // rows of the first, the last row of the second
  const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
  const Rgba8Image image = decode_image(bytes, "a.dds");
  REQUIRE(image.width == 4);
  REQUIRE(image.height == 4);
  REQUIRE(std::vector<std::uint8_t>(image.pixels.begin(), image.pixels.begin() + 4) == std::vector<std::uint8_t>{255, 0, 0, 255});
  REQUIRE(std::vector<std::uint8_t>(image.pixels.end() - 4, image.pixels.end()) == std::vector<std::uint8_t>{0, 255, 0, 255});
  for (const std::size_t size : {4U, 60U, 127U, 130U})
    REQUIRE_THROWS_WITH(decode_image(bytes.first(size), "a.dds"), Catch::StartsWith("a.dds: "));
}

TEST_CASE("image_io: a KTX image is refused by that name") {
  const std::vector<unsigned char> file{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, 13, 10, 26, 10};
  REQUIRE_THROWS_WITH(decode_image(std::as_bytes(std::span(file)), "a.ktx2"), Catch::Contains("a.ktx2: a KTX image"));
}
