#include "scenes/image_io.h"

#include <catch2/catch.hpp>
#include <cmath>

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
  REQUIRE_THROWS_WITH(decode_image(noise, "x.png"), "x.png: not a PNG, JPEG or EXR image (by its first bytes)");
  const std::vector<std::byte> jpeg{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}, std::byte{0xe0}};
  REQUIRE_THROWS_WITH(decode_image(jpeg, "x.jpg"), "x.jpg: the JPEG image is truncated");
  REQUIRE_THROWS_AS(load_image("/nonexistent/x.png"), UserError);
  REQUIRE_THROWS_AS(save_png("/nonexistent/x.png", gradient(2, 2)), UserError);
}
