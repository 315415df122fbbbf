/// The sRGB transfer function for 8-bit codes, both ways, exact to rounding. [IEC 61966-2-1; Khronos Data
/// Format #TRANSFER_SRGB]
///
/// Tables are built by multiplication and Newton's method alone (x^2.4 is the fifth root of x^12), so they
/// are the same on every machine.
#pragma once

#include <array>
#include <cstdint>

namespace quadrille::models {

/// Code -> linear value, rounded to the nearest float.
extern const std::array<float, 256> kSrgbToLinear;
/// Entry i: the least float whose code is i + 1 or more, i = 0..254. Entry 255 is +infinity.
extern const std::array<float, 256> kSrgbThreshold;

[[nodiscard]] inline float decode_srgb8(std::uint8_t code) { return kSrgbToLinear[code]; }
/// Code nearest to the linear value, clamped to 0..1; NaN gives 0. Correctly rounded.
[[nodiscard]] std::uint8_t encode_srgb8(float linear);
/// Entries of the search table below: 13 octaves from 2^-13 to 1 in 128 steps each, narrow enough to hold at
/// most one threshold.
inline constexpr int kSrgbBuckets = 13 * 128;
/// float bits of 2^-13, 7 bits of the mantissa kept
inline constexpr std::uint32_t kSrgbFirstBucket = 0x39000000u >> 16;
/// Code at the bottom of a bucket.
extern const std::array<std::int32_t, kSrgbBuckets + 1> kSrgbBucketCode;

}  // namespace quadrille::models
