#include "models/rop/srgb.h"

#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <limits>

using namespace quadrille::models;

namespace {

/// The transfer function by the C library in long double.
long double encoded(long double linear) {
  return linear <= 0.0031308L ? 12.92L * linear : 1.055L * std::pow(linear, 1.0L / 2.4L) - 0.055L;
}
long double decoded(long double code) {
  return code <= 0.04045L ? code / 12.92L : std::pow((code + 0.055L) / 1.055L, 2.4L);
}

}  // namespace

TEST_CASE("srgb: decoding is the transfer function rounded to the nearest float") {
  for (int i = 0; i < 256; ++i)
    CHECK(decode_srgb8(static_cast<std::uint8_t>(i)) == static_cast<float>(decoded(i / 255.0L)));
}

TEST_CASE("srgb: each of the 255 thresholds separates two codes exactly") {
  for (int i = 0; i < 255; ++i) {
    const float least = kSrgbThreshold[static_cast<std::size_t>(i)], below = std::nextafter(least, 0.0f);
    CHECK(encoded(least) * 255.0L >= i + 0.5L);
    CHECK(encoded(below) * 255.0L < i + 0.5L);
    CHECK(encode_srgb8(least) == i + 1);
    CHECK(encode_srgb8(below) == i);
  }
}

TEST_CASE("srgb: a code survives decoding and encoding") {
  for (int i = 0; i < 256; ++i) CHECK(encode_srgb8(decode_srgb8(static_cast<std::uint8_t>(i))) == i);
}

TEST_CASE("srgb: a search bucket holds at most one threshold") {
  for (std::size_t i = 0; i < kSrgbBuckets; ++i) CHECK(kSrgbBucketCode[i + 1] - kSrgbBucketCode[i] <= 1);
  CHECK(kSrgbBucketCode[0] == 0);
  CHECK(kSrgbBucketCode[kSrgbBuckets] == 255);
}

TEST_CASE("srgb: encoding any float counts the thresholds at or below it") {
  RandomSource random(51);
  for (int round = 0; round < 200000; ++round) {
    const float value = round % 2 == 0 ? random.real(-0.1f, 1.1f) : std::bit_cast<float>(random.bits());
    int expected = 0;
    while (expected < 255 && value >= kSrgbThreshold[static_cast<std::size_t>(expected)]) ++expected;
    if (encode_srgb8(value) != expected) FAIL("value " << value);
  }
  CHECK(encode_srgb8(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(encode_srgb8(-std::numeric_limits<float>::infinity()) == 0);
  CHECK(encode_srgb8(std::numeric_limits<float>::infinity()) == 255);
}
