/// Edge functions, exact in integers or consistent in doubles.
#include "models/reference/coverage.h"

#include <utility>

namespace quadrille::models::reference {
namespace {

__extension__ using Wide = __int128;

Wide product(std::int64_t a, std::int64_t b) { return static_cast<Wide>(a) * static_cast<Wide>(b); }

/// Which side of the line a -> b the point is on; the sign is exact.
Wide edge_value(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by, std::int64_t px,
                std::int64_t py) {
  return product(bx - ax, py - ay) - product(by - ay, px - ax);
}

/// The same in doubles; swapping a and b negates it, bit for bit.
double edge_value(double ax, double ay, double bx, double by, double px, double py) {
  const bool swapped = std::pair(bx, by) < std::pair(ax, ay);
  if (swapped) std::swap(ax, bx), std::swap(ay, by);
  const double value = (bx - ax) * (py - ay) - (by - ay) * (px - ax);
  return swapped ? -value : value;
}

/// Samples on the edge a -> b belong to the triangle if it is a left edge (it goes up) or a top edge (level,
/// going right); the inside is on its right hand.
template <class Number>
bool owns_its_samples(Number ax, Number ay, Number bx, Number by) {
  return by < ay || (by == ay && bx > ax);
}

template <class Number, class Value>
SamplePlace locate(const std::array<Number, 3>& x, const std::array<Number, 3>& y, Number px, Number py,
                   bool clockwise) {
  SamplePlace place;
  place.covered = true;
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t a = (i + 1) % 3, b = (i + 2) % 3;
    if (!clockwise) std::swap(a, b);
    const Value value = edge_value(x[a], y[a], x[b], y[b], px, py);
    place.covered = place.covered && (value > 0 || (value == 0 && owns_its_samples(x[a], y[a], x[b], y[b])));
    values[i] = static_cast<double>(value);
  }
  const double sum = values[0] + values[1] + values[2];
  for (std::size_t i = 0; i < 3; ++i) place.weights[i] = values[i] / sum;
  return place;
}

}  // namespace

double doubled_area(const WindowTriangle& t) {
  if (t.exact)
    return static_cast<double>(
        edge_value(t.fixed_x[0], t.fixed_y[0], t.fixed_x[1], t.fixed_y[1], t.fixed_x[2], t.fixed_y[2]));
  return edge_value(t.x[0], t.y[0], t.x[1], t.y[1], t.x[2], t.y[2]);
}

SampleAt sample_at(int x, int y, std::uint32_t samples, std::uint32_t sample) {
  // x and y of each sample in sixteenths of a pixel, from its upper left corner
  static constexpr std::array<double, 4> kTwo{12, 12, 4, 4};
  static constexpr std::array<double, 8> kFour{6, 2, 14, 6, 2, 10, 10, 14};
  static constexpr std::array<double, 16> kEight{9, 5, 7, 11, 13, 9, 5, 3, 3, 13, 1, 7, 11, 15, 15, 1};
  if (samples == 1) return {x, y};
  const double* const at = (samples == 2   ? kTwo.data()
                            : samples == 4 ? kFour.data()
                                           : kEight.data()) +
                           std::size_t{2} * sample;
  return {x, y, (at[0] - 8) / 16, (at[1] - 8) / 16};
}

SamplePlace locate_sample(const WindowTriangle& t, const SampleAt& at) {
  if (t.shape == Shape::kLine) return locate_on_line(t, at);
  if (t.shape == Shape::kPoint) return locate_in_point(t, at);
  if (t.exact) {
    const std::int64_t one = std::int64_t{1} << t.subpixel_bits;
    return locate<std::int64_t, Wide>(t.fixed_x, t.fixed_y, at.grid_x(one), at.grid_y(one), t.clockwise);
  }
  return locate<double, double>(t.x, t.y, at.px(), at.py(), t.clockwise);
}

}  // namespace quadrille::models::reference
