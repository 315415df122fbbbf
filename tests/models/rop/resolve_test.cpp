/// Resolving a tile: equal samples are themselves, others their mean in linear values.
#include "models/rop/resolve.h"

#include "models/rop/blend.h"
#include "models/rop/srgb.h"

#include <catch2/catch.hpp>

#include <array>
#include <vector>

using namespace quadrille::models;

TEST_CASE("resolve: equal samples are themselves, in every colour format and code") {
  for (int f = 0; f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (!format_info(format).may(kColorUse)) continue;
    for (const std::size_t samples : {2u, 4u, 8u}) {
      for (std::uint32_t first = 0; first < 1024; first += 64) {
        std::vector<std::uint32_t> planes(64 * samples);
        for (std::size_t i = 0; i < planes.size(); ++i) {
          const auto code = static_cast<std::uint32_t>(first + i % 64);
          planes[i] = code * 0x00400501u;
        }
        std::array<std::uint32_t, 64> pixels{};
        resolve_tile(format, planes, pixels.data());
        for (std::size_t i = 0; i < 64; ++i) REQUIRE(pixels[i] == planes[i]);
      }
    }
  }
}

TEST_CASE("resolve: half of white and half of black is a half in linear values") {
  for (const std::size_t samples : {2u, 4u, 8u}) {
    std::vector<std::uint32_t> planes(64 * samples, 0xff000000u);
    for (std::size_t i = 0; i < planes.size() / 2; ++i) planes[i] = 0xffffffffu;
    std::array<std::uint32_t, 64> pixels{};
    resolve_tile(Format::kR8G8B8A8Srgb, planes, pixels.data());
    CHECK(pixels[17] == encode_color(Format::kR8G8B8A8Srgb, {0.5f, 0.5f, 0.5f, 1}));
    CHECK((pixels[17] & 0xff) == 188);  // the sRGB code of a half
    resolve_tile(Format::kR8G8B8A8Unorm, planes, pixels.data());
    CHECK((pixels[17] & 0xff) == 128);
  }
}
