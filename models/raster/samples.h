/// Where the samples of a pixel lie. [VK1.3 #primsrast-multisampling, standard sample locations]
#pragma once

#include "models/raster/edge.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

inline constexpr int kMaxSamples = 8;
[[nodiscard]] constexpr bool is_sample_count(std::uint32_t count) {
  return count == 1 || count == 2 || count == 4 || count == 8;
}

/// A way in pixels.
struct PixelOffset {
  double x = 0, y = 0;
};

/// The samples of a pixel on the sub-pixel grid. A single one lies at the centre.
struct SampleGrid {
  int count = 1;
  int subpixel_bits = 8;
  std::array<GridPoint, kMaxSamples> offset{};  ///< from the pixel's centre
  GridPoint low, high;                          ///< least and greatest of them
  [[nodiscard]] double pixels(std::int64_t grid) const {
    return static_cast<double>(grid) / static_cast<double>(std::int64_t{1} << subpixel_bits);
  }
  [[nodiscard]] PixelOffset from_centre(int sample) const {
    const GridPoint& at = offset[static_cast<std::size_t>(sample)];
    return {pixels(at.x), pixels(at.y)};
  }
  /// All samples of a pixel, a bit each.
  [[nodiscard]] std::uint32_t all() const { return (1u << count) - 1; }
  friend bool operator==(const SampleGrid&, const SampleGrid&) = default;
};

/// `count` is 1, 2, 4 or 8; with more than one, `subpixel_bits` is at least 4.
[[nodiscard]] SampleGrid sample_grid(int count, int subpixel_bits);

/// The same edge, decided at a sample instead of the centre.
[[nodiscard]] inline EdgeFunction at_sample(const EdgeFunction& edge, const GridPoint& offset, int bits) {
  const std::int64_t moved = edge.fraction + edge.a * offset.x + edge.b * offset.y;
  return {edge.origin + (moved >> bits), edge.a, edge.b, 0, edge.top, edge.bottom};
}

}  // namespace quadrille::models
