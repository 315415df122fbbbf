#include "scenes/image/mip_chain.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace quadrille::scenes;

namespace {

Rgba8Image constant(std::uint32_t width, std::uint32_t height, std::uint8_t r, std::uint8_t g, std::uint8_t b,
                    std::uint8_t a) {
  Rgba8Image image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) image.pixels.insert(image.pixels.end(), {r, g, b, a});
  return image;
}

}  // namespace

TEST_CASE("mip chain: levels and bytes follow the sizes, down to 1x1") {
  REQUIRE(full_chain_levels(1, 1) == 1);
  REQUIRE(full_chain_levels(211, 211) == 8);
  REQUIRE(full_chain_levels(16384, 1) == 15);
  REQUIRE(build_mip_chain(constant(5, 3, 0, 0, 0, 0), {false}).size() == 4 * (15 + 2 + 1));
}

TEST_CASE("mip chain: a constant image stays that constant at every level, every code, every size") {
  for (const bool srgb : {false, true}) {
    for (int code = 0; code < 256; ++code) {
      const auto c = static_cast<std::uint8_t>(code);
      for (const std::byte b : build_mip_chain(constant(7, 5, c, c, c, c), {srgb}))
        REQUIRE(b == static_cast<std::byte>(code));
    }
  }
}

TEST_CASE("mip chain: black and white average in linear light") {
  Rgba8Image image = constant(2, 2, 0, 0, 0, 0);
  for (const std::size_t texel : {0U, 3U}) {
    for (std::size_t c = 0; c < 4; ++c) image.pixels[4 * texel + c] = 255;
  }
  const auto srgb = build_mip_chain(image, {true}), plain = build_mip_chain(image, {false});
  REQUIRE(static_cast<int>(srgb[16]) == static_cast<int>(std::lround(255 * linear_to_srgb(0.5))));  // 188
  REQUIRE(static_cast<int>(srgb[16]) == 188);
  REQUIRE(static_cast<int>(srgb[19]) == 128);  // alpha is linear
  REQUIRE(static_cast<int>(plain[16]) == 128);
}

TEST_CASE("mip chain: the mean of an odd-sized image is kept") {
  Rgba8Image image = constant(9, 1, 0, 0, 0, 255);
  image.pixels[0] = 255;  // one of nine texels, at the border
  const auto chain = build_mip_chain(image, {false});
  REQUIRE(std::abs(static_cast<int>(chain.back()) - 255) == 0);
  REQUIRE(static_cast<int>(chain[chain.size() - 4]) == 28);  // 255 / 9 = 28.3
}

TEST_CASE("mip chain: premultiplied, what is transparent brings no colour into a coarser level") {
  Rgba8Image image = constant(2, 1, 255, 0, 0, 255);
  const std::array<std::uint8_t, 4> transparent{0, 255, 0, 0};
  std::ranges::copy(transparent, image.pixels.begin() + 4);
  for (const bool srgb : {false, true}) {
    const auto chain = build_mip_chain(image, {srgb, true}), straight = build_mip_chain(image, {srgb, false});
    const auto code = [](const std::vector<std::byte>& of, std::size_t i) { return static_cast<int>(of[i]); };
    CHECK(code(chain, 5) == 0);  // the transparent texel's green
    CHECK(code(straight, 5) == 255);
    const int half = srgb ? 188 : 128;
    CHECK(code(chain, 8) == half);
    CHECK(code(chain, 9) == 0);
    CHECK(code(straight, 9) == half);
    CHECK(code(chain, 11) == 128);
  }
}

TEST_CASE("mip chain: of an opaque image premultiplied is the same") {
  Rgba8Image image = constant(9, 6, 0, 0, 0, 255);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (i % 4 != 3) image.pixels[i] = static_cast<std::uint8_t>(i * 37);
  for (const bool srgb : {false, true})
    CHECK(build_mip_chain(image, {srgb, true}) == build_mip_chain(image, {srgb, false}));
}
