#include "scenes/image/image_io.h"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "models/base/error.h"
#include "scenes/image/image_header.h"
#include "scenes/image/plain_image.h"
#include "tests/scenes/gltf_text.h"
#include "traces/whole_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

Rgba8Image gradient(std::uint32_t width, std::uint32_t height) {
  Rgba8Image image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    for (std::uint32_t c = 0; c < 4; ++c)
      image.pixels.push_back(static_cast<std::uint8_t>(i * (c + 3) + 17 * c));
  }
  return image;
}

void append_big_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void put_big_endian(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes[at++] = static_cast<std::uint8_t>(value >> shift);
}

/// An ICC colour profile of a display whose table names `tags` tags that no standard knows, from `first_tag`
/// on.
std::vector<std::uint8_t> color_profile(std::uint32_t first_tag, std::uint32_t tags) {
  constexpr std::size_t kHeader = 128;
  constexpr std::uint32_t kTagBytes = 12;
  std::vector<std::uint8_t> profile(kHeader);
  append_big_endian(profile, tags);
  const auto data = static_cast<std::uint32_t>(profile.size()) + kTagBytes * tags;
  for (std::uint32_t i = 0; i < tags; ++i) {
    append_big_endian(profile, first_tag + i);
    append_big_endian(profile, data);
    append_big_endian(profile, 12);
  }
  profile.resize(data + 12);
  put_big_endian(profile, 0, static_cast<std::uint32_t>(profile.size()));
  put_big_endian(profile, 8, 0x02400000);   // version 2.4
  put_big_endian(profile, 12, 0x6d6e7472);  // "mntr", a display
  put_big_endian(profile, 16, 0x52474220);  // "RGB "
  put_big_endian(profile, 20, 0x58595a20);  // "XYZ "
  put_big_endian(profile, 36, 0x61637370);  // "acsp"
  put_big_endian(profile, 68, 0x0000f6d6);  // the white point of D50: x, y, z
  put_big_endian(profile, 72, 0x00010000);
  put_big_endian(profile, 76, 0x0000d32d);
  return profile;
}

/// The CRC-32 of a PNG's chunk: its name and its data.
std::uint32_t crc_of_chunk(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = ~0U;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0);
  }
  return ~crc;
}

/// `data` of less than 64 KiB as a zlib stream of one block that is stored, not compressed.
std::vector<std::uint8_t> stored_zlib(const std::vector<std::uint8_t>& data) {
  const auto size = static_cast<std::uint32_t>(data.size());
  std::vector<std::uint8_t> stream{0x78, 0x01, 0x01};
  for (const std::uint32_t word : {size, ~size}) {
    stream.push_back(static_cast<std::uint8_t>(word));
    stream.push_back(static_cast<std::uint8_t>(word >> 8));
  }
  std::uint32_t sum = 1, sum_of_sums = 0;  // Adler-32
  for (const std::uint8_t byte : data) {
    stream.push_back(byte);
    sum = (sum + byte) % 65521;
    sum_of_sums = (sum_of_sums + sum) % 65521;
  }
  append_big_endian(stream, sum_of_sums << 16 | sum);
  return stream;
}

/// The PNG file with a colour profile behind its header.
std::vector<std::byte> with_profile(const std::vector<std::byte>& png,
                                    const std::vector<std::uint8_t>& profile) {
  constexpr std::size_t kBehindHeader = 33;
  std::vector<std::uint8_t> chunk{'i', 'C', 'C', 'P', 'p', 0, 0};
  const std::vector<std::uint8_t> stream = stored_zlib(profile);
  chunk.insert(chunk.end(), stream.begin(), stream.end());
  std::vector<std::uint8_t> inserted;
  append_big_endian(inserted, static_cast<std::uint32_t>(chunk.size() - 4));
  inserted.insert(inserted.end(), chunk.begin(), chunk.end());
  append_big_endian(inserted, crc_of_chunk(chunk));
  std::vector<std::byte> file(png.begin(), png.begin() + kBehindHeader);
  for (const std::uint8_t byte : inserted) file.push_back(std::byte{byte});
  file.insert(file.end(), png.begin() + kBehindHeader, png.end());
  return file;
}

/// The image has this size, and this colour everywhere.
void require_plain(const Rgba8Image& image, std::uint32_t width, std::uint32_t height,
                   const std::array<std::uint8_t, 4>& color) {
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
    for (std::uint32_t i = 0; i < 15 * channels; ++i)
      image.pixels.push_back(std::ldexp(1.1F, static_cast<int>(i) - 30));
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

TEST_CASE("image_io: images with colour profiles are decoded by several threads at once") {
  constexpr std::uint32_t kThreads = 4, kImages = 8, kTags = 400;
  const TempGltf folder("", "a.png");
  const Rgba8Image image = gradient(5, 3);
  save_png(folder.path(), image);
  const std::vector<std::byte> plain = traces::read_whole_file(folder.path(), 1 << 20);
  std::atomic<std::uint32_t> right = 0;
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        for (std::uint32_t i = 0; i < kImages; ++i) {
          const std::uint32_t first_tag = 0x20000000 + (t * kImages + i) * kTags;
          right += decode_any_image(with_profile(plain, color_profile(first_tag, kTags)), "a.png").pixels ==
                           image.pixels
                       ? 1
                       : 0;
        }
      });
    }
  }
  CHECK(right == kThreads * kImages);
}

TEST_CASE("image_io: a PNG of any kind has the pixels that OpenImageIO gives it") {
  struct Kind {
    int color_type, bits, channels;
    bool keyed;  ///< a colour, or the first entry of the palette, is transparent
  };
  constexpr std::array kKinds{Kind{0, 1, 1, false}, Kind{0, 2, 1, true},  Kind{0, 8, 1, false},
                              Kind{0, 8, 1, true},  Kind{4, 8, 2, false}, Kind{2, 8, 3, false},
                              Kind{2, 8, 3, true},  Kind{6, 8, 4, false}, Kind{3, 1, 1, false},
                              Kind{3, 4, 1, true},  Kind{3, 8, 1, true},  Kind{2, 16, 3, false}};
  constexpr std::uint32_t kWidth = 13, kHeight = 5;
  for (const Kind& kind : kKinds) {
    std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const auto chunk = [&](const char* name, const std::vector<std::uint8_t>& data) {
      std::vector<std::uint8_t> body(name, name + 4);
      body.insert(body.end(), data.begin(), data.end());
      append_big_endian(file, static_cast<std::uint32_t>(data.size()));
      file.insert(file.end(), body.begin(), body.end());
      append_big_endian(file, crc_of_chunk(body));
    };
    std::vector<std::uint8_t> header;
    append_big_endian(header, kWidth);
    append_big_endian(header, kHeight);
    header.insert(header.end(), {static_cast<std::uint8_t>(kind.bits),
                                 static_cast<std::uint8_t>(kind.color_type), 0, 0, 0});
    chunk("IHDR", header);
    if (kind.color_type == 3) {
      std::vector<std::uint8_t> palette(std::size_t{3} << kind.bits);
      for (std::size_t i = 0; i < palette.size(); ++i) palette[i] = static_cast<std::uint8_t>(i * 37);
      chunk("PLTE", palette);
    }
    if (kind.keyed)
      chunk("tRNS", kind.color_type == 3
                        ? std::vector<std::uint8_t>{77, 9}
                        : std::vector<std::uint8_t>(2 * static_cast<std::size_t>(kind.channels), 0));
    const std::uint32_t row = (kWidth * static_cast<std::uint32_t>(kind.channels * kind.bits) + 7) / 8;
    std::vector<std::uint8_t> rows;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      rows.push_back(0);
      for (std::uint32_t i = 0; i < row; ++i)
        rows.push_back(static_cast<std::uint8_t>(y == 0 && i < 6 ? 0 : (y * row + i) * 29));
    }
    chunk("IDAT", stored_zlib(rows));
    chunk("IEND", {});
    const auto bytes = std::as_bytes(std::span(file));
    INFO("colour type " << kind.color_type << ", " << kind.bits << " bits, keyed " << kind.keyed);
    const Rgba8Image any = decode_any_image(bytes, "a.png");
    CHECK(decode_image(bytes, "a.png").pixels == any.pixels);
    const auto plain = decode_plain_image(bytes, check_image_header(bytes, "a.png"));
    CHECK(plain.has_value() == (kind.bits <= 8));
    if (plain) CHECK(plain->pixels == any.pixels);
  }
}

TEST_CASE(
    "image_io: what the plain reader cannot read without a warning is left to OpenImageIO, with its words") {
  const TempGltf scratch("");
  const std::string path = scratch.path() + ".png";
  save_png(path, gradient(40, 30));
  const std::vector<std::byte> good = traces::read_whole_file(path, 1 << 20);
  for (std::size_t at = 60; at < good.size(); at += 7) {
    std::vector<std::byte> bad = good;
    bad[at] ^= std::byte{0x20};
    const auto result = [&](auto&& decode) -> std::string {
      try {
        const Rgba8Image image = decode(bad, "a.png");
        return {reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size()};
      } catch (const UserError& error) { return error.what(); }
    };
    INFO("byte " << at);
    CHECK((result(decode_image) == result(decode_any_image)));
  }
}

TEST_CASE("image_io: a PNG is written with the bytes that OpenImageIO gives it") {
  const TempGltf scratch("");
  for (const auto& [width, height] : {std::pair{1U, 1U}, {7U, 300U}, {640U, 361U}}) {
    const std::string plain = scratch.path() + ".plain.png", module = scratch.path() + ".module.png";
    save_png(plain, gradient(width, height));
    save_png_by_module(module, gradient(width, height));
    CHECK((traces::read_whole_file(plain, 1 << 24) == traces::read_whole_file(module, 1 << 24)));
  }
}

TEST_CASE("image_io: every truncation of a PNG is refused with its name") {
  const TempGltf folder("", "a.png");
  save_png(folder.path(), gradient(16, 16));
  const std::vector<std::byte> bytes = traces::read_whole_file(folder.path(), 1 << 20);
  // the last bytes are the end marker, which holds no pixels
  for (std::size_t size = 0; size + 20 < bytes.size(); size += 7) {
    CAPTURE(size);
    REQUIRE_THROWS_WITH(decode_image(std::span(bytes).first(size), "some.png"),
                        Catch::StartsWith("some.png: "));
  }
}

TEST_CASE("image_io: what is no image, and what cannot be written, is the user's error") {
  const std::vector<std::byte> noise(100, std::byte{42});
  REQUIRE_THROWS_WITH(decode_image(noise, "x.png"),
                      "x.png: not a PNG, JPEG, WebP, DDS, EXR or HDR image (by its first bytes)");
  const std::vector<std::byte> jpeg{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}, std::byte{0xe0}};
  REQUIRE_THROWS_WITH(decode_image(jpeg, "x.jpg"), "x.jpg: the JPEG image is truncated");
  REQUIRE_THROWS_AS(load_image("/nonexistent/x.png"), UserError);
  REQUIRE_THROWS_AS(save_png("/nonexistent/x.png", gradient(2, 2)), UserError);
}

TEST_CASE("image_io: a WebP image is decoded, a truncated one is refused") {
  // 3 x 2 texels of (200, 100, 50), lossless, written by libwebp.
  const std::vector<unsigned char> file{0x52, 0x49, 0x46, 0x46, 0x1e, 0x00, 0x00, 0x00, 0x57, 0x45,
                                        0x42, 0x50, 0x56, 0x50, 0x38, 0x4c, 0x11, 0x00, 0x00, 0x00,
                                        0x2f, 0x02, 0x40, 0x00, 0x00, 0x07, 0x50, 0xb2, 0x22, 0x57,
                                        0xa6, 0xff, 0x81, 0x88, 0xe8, 0x7f, 0x00, 0x00};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
  require_plain(decode_image(bytes, "a.webp"), 3, 2, {200, 100, 50, 255});
  for (std::size_t size = 12; size < bytes.size() - 4; size += 3)
    REQUIRE_THROWS_WITH(decode_image(bytes.first(size), "a.webp"), Catch::StartsWith("a.webp: "));
}

TEST_CASE("image_io: the colours of a WebP image with alpha are as they were written, not multiplied by it") {
  // 2 x 2 texels of (200, 100, 50, 60), lossless, written by libwebp.
  std::vector<unsigned char> file{82, 73,  70, 70, 30,  0,  0,   0,   87,  69,  66, 80, 86,
                                  80, 56,  76, 17, 0,   0,  0,   47,  1,   64,  0,  16, 7,
                                  80, 178, 34, 87, 166, 60, 129, 136, 232, 127, 0,  0};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
  require_plain(decode_image(bytes, "a.webp"), 2, 2, {200, 100, 50, 60});
  for (std::size_t i = 25; i < 32; ++i) file[i] = 0;
  REQUIRE_THROWS_WITH(decode_image(bytes, "a.webp"),
                      Catch::StartsWith("a.webp: cannot be decoded as webp: "));
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
  REQUIRE(std::vector<std::uint8_t>(image.pixels.begin(), image.pixels.begin() + 4) ==
          std::vector<std::uint8_t>{255, 0, 0, 255});
  REQUIRE(std::vector<std::uint8_t>(image.pixels.end() - 4, image.pixels.end()) ==
          std::vector<std::uint8_t>{0, 255, 0, 255});
  for (const std::size_t size : {4U, 60U, 127U, 130U})
    REQUIRE_THROWS_WITH(decode_image(bytes.first(size), "a.dds"), Catch::StartsWith("a.dds: "));
}

TEST_CASE("image_io: a KTX image is refused by that name") {
  const std::vector<unsigned char> file{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, 13, 10, 26, 10};
  REQUIRE_THROWS_WITH(decode_image(std::as_bytes(std::span(file)), "a.ktx2"),
                      Catch::Contains("a.ktx2: a KTX image"));
}
