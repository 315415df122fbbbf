#include "models/rop/srgb.h"

#include <bit>
#include <limits>

namespace quadrille::models {
namespace {

constexpr double power(double x, int n) {
  double result = 1.0;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

/// Fifth root of v in 0..1 by Newton's method from above: falls monotonically until rounding stops it.
constexpr double fifth_root(double v) {
  double x = 1.0;
  for (int i = 0; i < 200; ++i) {
    const double next = x - (power(x, 5) - v) / (5.0 * power(x, 4));
    if (next >= x) break;
    x = next;
  }
  return x;
}

/// Linear value of an encoded one, 0..1.
constexpr double to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : fifth_root(power((encoded + 0.055) / 1.055, 12));
}

constexpr std::array<float, 256> make_linear() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 256; ++i)
    table[i] = static_cast<float>(to_linear(static_cast<double>(i) / 255.0));
  return table;
}

constexpr std::array<float, 256> make_thresholds() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 255; ++i) {
    const double boundary = to_linear((static_cast<double>(i) + 0.5) / 255.0);
    auto least = static_cast<float>(boundary);
    if (static_cast<double>(least) < boundary)
      least = std::bit_cast<float>(std::bit_cast<std::uint32_t>(least) + 1);
    table[i] = least;
  }
  table[255] = std::numeric_limits<float>::infinity();
  return table;
}

}  // namespace

constinit const std::array<float, 256> kSrgbToLinear = make_linear();
constinit const std::array<float, 256> kSrgbThreshold = make_thresholds();

namespace {

constexpr std::array<std::int32_t, kSrgbBuckets + 1> make_bucket_codes() {
  constexpr std::array<float, 256> thresholds = make_thresholds();
  std::array<std::int32_t, kSrgbBuckets + 1> table{};
  std::int32_t code = 0;
  for (std::uint32_t i = 0; i <= kSrgbBuckets; ++i) {
    const auto bottom = std::bit_cast<float>((kSrgbFirstBucket + i) << 16);
    while (bottom >= thresholds[static_cast<std::size_t>(code)]) ++code;
    table[i] = code;
  }
  return table;
}

}  // namespace

constinit const std::array<std::int32_t, kSrgbBuckets + 1> kSrgbBucketCode = make_bucket_codes();

std::uint8_t encode_srgb8(float linear) {
  if (!(linear >= kSrgbThreshold[0])) return 0;
  if (linear >= 1.0f) return 255;
  const std::uint32_t bucket = (std::bit_cast<std::uint32_t>(linear) >> 16) - kSrgbFirstBucket;
  const std::int32_t code = kSrgbBucketCode[bucket];
  return static_cast<std::uint8_t>(code + (linear >= kSrgbThreshold[static_cast<std::size_t>(code)] ? 1 : 0));
}

}  // namespace quadrille::models
