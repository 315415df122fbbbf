#include "models/raster/samples.h"

#include "models/base/error.h"

#include <algorithm>
#include <span>

namespace quadrille::models {
namespace {

/// From the pixel's upper left corner, in sixteenths of a pixel.
struct Sixteenths {
  int x, y;
};
constexpr std::array<Sixteenths, 2> kTwo{{{12, 12}, {4, 4}}};
constexpr std::array<Sixteenths, 4> kFour{{{6, 2}, {14, 6}, {2, 10}, {10, 14}}};
constexpr std::array<Sixteenths, 8> kEight{
    {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}};

std::span<const Sixteenths> positions_of(int count) {
  switch (count) {
    case 2: return kTwo;
    case 4: return kFour;
    case 8: return kEight;
    default: return {};
  }
}

}  // namespace

SampleGrid sample_grid(int count, int subpixel_bits) {
  QUADRILLE_CHECK(is_sample_count(static_cast<std::uint32_t>(count)), "{} samples", count);
  SampleGrid grid;
  grid.count = count;
  grid.subpixel_bits = subpixel_bits;
  const std::span<const Sixteenths> positions = positions_of(count);
  QUADRILLE_CHECK(positions.empty() || subpixel_bits >= 4, "{} sub-pixel bits for {} samples", subpixel_bits,
                  count);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto on_grid = [&](int sixteenths) {
      return std::int64_t{sixteenths - 8} * (std::int64_t{1} << (subpixel_bits - 4));
    };
    const GridPoint at{on_grid(positions[i].x), on_grid(positions[i].y)};
    grid.offset[i] = at;
    grid.low = {std::min(grid.low.x, at.x), std::min(grid.low.y, at.y)};
    grid.high = {std::max(grid.high.x, at.x), std::max(grid.high.y, at.y)};
  }
  return grid;
}

}  // namespace quadrille::models
