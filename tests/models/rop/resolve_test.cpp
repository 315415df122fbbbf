/// Resolving a tile: equal samples are themselves, others their mean in linear values.
#include "models/rop/resolve.h"

#include "models/memory/surface.h"
#include "models/rop/blend.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <array>
#include <cstring>
#include <span>
#include <vector>

using namespace quadrille::models;

namespace {

/// Planes of 64 pixels each, without room between them.
std::vector<std::byte> resolved(Format format, const std::vector<std::byte>& planes, std::uint32_t samples) {
  std::vector<std::byte> pixels(planes.size() / samples);
  resolve_tile(format, planes.data(), pixels.size(), samples, pixels.data());
  return pixels;
}

/// A plane of one colour, so often.
void add_planes(std::vector<std::byte>& planes, Format format, std::uint32_t count,
                const std::array<float, 4>& color) {
  const std::size_t first = planes.size(), bytes = format_bytes(format);
  planes.resize(first + std::size_t{64} * count * bytes);
  fill_pixels(std::span(planes).subspan(first), static_cast<std::uint32_t>(bytes),
              encode_color(format, color));
}

PixelCode pixel_of(Format format, const std::vector<std::byte>& pixels, std::size_t i) {
  PixelCode code;
  std::memcpy(code.word.data(), pixels.data() + i * format_bytes(format), format_bytes(format));
  return code;
}

}  // namespace

TEST_CASE("resolve: equal samples are themselves, in every colour format and code") {
  RandomSource random(5);
  for (int f = 0; f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (!format_info(format).may(kColorUse)) continue;
    const std::size_t bytes = format_bytes(format);
    for (const std::uint32_t samples : {2u, 4u, 8u}) {
      for (int round = 0; round < 16; ++round) {
        std::vector<std::byte> plane(64 * bytes), planes;
        for (std::byte& byte : plane) byte = static_cast<std::byte>(random.bits());
        if (is_float_format(format)) {  // a NaN has many codes, and infinity has none of its own as a mean
          for (std::size_t i = 0; i < 64; ++i) {
            const float v = random.real(0, 60000);
            const PixelCode code = encode_color(format, {v, v / 3, v / 700, 1 - v});
            std::memcpy(plane.data() + i * bytes, code.word.data(), bytes);
          }
        }
        for (std::uint32_t s = 0; s < samples; ++s) planes.insert(planes.end(), plane.begin(), plane.end());
        REQUIRE(resolved(format, planes, samples) == plane);
      }
    }
  }
}

TEST_CASE("resolve: of integers the first sample stays") {
  RandomSource random(6);
  for (int f = 0; f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (!format_info(format).may(kColorUse) || !is_integer_format(format)) continue;
    std::vector<std::byte> planes(std::size_t{4} * 64 * format_bytes(format));
    for (std::byte& byte : planes) byte = static_cast<std::byte>(random.bits());
    INFO(format_info(format).name);
    CHECK(resolved(format, planes, 4) ==
          std::vector(planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(planes.size() / 4)));
  }
}

TEST_CASE("resolve: half of white and half of black is a half in linear values") {
  for (int f = 0; f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (!format_info(format).may(kBlendUse)) continue;
    for (const std::uint32_t samples : {2u, 4u, 8u}) {
      std::vector<std::byte> planes;
      add_planes(planes, format, samples / 2, {1, 1, 1, 1});
      add_planes(planes, format, samples / 2, {0, 0, 0, 1});
      INFO(format_info(format).name);
      CHECK(pixel_of(format, resolved(format, planes, samples), 17) ==
            encode_color(format, {0.5f, 0.5f, 0.5f, 1}));
    }
  }
  CHECK((encode_color(Format::kR8G8B8A8Srgb, {0.5f, 0, 0, 1}).word[0] & 0xff) == 188);
}
