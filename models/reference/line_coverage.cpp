/// Lines and points, pixel by pixel and by the words of the rules; exact in integers or in doubles.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "models/reference/coverage.h"

namespace quadrille::models::reference {
namespace {

__extension__ using Wide = __int128;

/// A line whose numbers are integers (with exact products) or doubles, and whose pixels are `one` wide. Where
/// a comparison is a tie, both ends count as moved to the left by a little, and up by much less.
template <class Number, class Product>
struct ThinLine {
  Number ax, ay, bx, by, one;

  [[nodiscard]] Number half() const { return one / 2; }
  [[nodiscard]] Number centre(int pixel) const { return static_cast<Number>(pixel) * one + half(); }
  static Number magnitude(Number v) { return v < 0 ? -v : v; }
  [[nodiscard]] bool steep() const { return magnitude(bx - ax) < magnitude(by - ay); }

  /// Is a point inside the diamond of pixel (x, y)?
  [[nodiscard]] bool in_diamond(Number px, Number py, int x, int y) const {
    const Number distance = magnitude(px - centre(x)) + magnitude(py - centre(y));
    return distance < half() || (distance == half() && px > centre(x));
  }
  /// Is the line's crossing of the middle of a column above (px, py), or of a row, to the left of it?
  [[nodiscard]] bool passes_before(Number px, Number py) const {
    const Number dx = bx - ax, dy = by - ay;
    const Product side = static_cast<Product>(dx) * static_cast<Product>(py - ay) -
                         static_cast<Product>(dy) * static_cast<Product>(px - ax);
    const bool forward = steep() ? dy > 0 : dx > 0;
    // on the line: its move to the left counts, or else that upwards
    const bool positive = side > 0 || (side == 0 && (dy != 0 ? dy < 0 : dx > 0));
    return steep() ? positive != forward : positive == forward;
  }
  /// Do its ends lie on either side of the middle of pixel (x, y)'s column, or row if it is steep?
  [[nodiscard]] bool spans(int x, int y) const {
    return steep() ? (ay > centre(y)) != (by > centre(y)) : (ax > centre(x)) != (bx > centre(x));
  }
  /// Does it cross the middle between `before` and `after` the centre of the pixel? Extrapolated where it
  /// ends.
  [[nodiscard]] bool crosses(int x, int y, Number before, Number after) const {
    const Number cx = centre(x), cy = centre(y);
    return steep() ? passes_before(cx + after, cy) && !passes_before(cx - before, cy)
                   : passes_before(cx, cy + after) && !passes_before(cx, cy - before);
  }
  /// The diamond-exit rule. [VK1.3 #primsrast-lines-bresenham]
  [[nodiscard]] bool draws(int x, int y) const {
    const bool meets = in_diamond(ax, ay, x, y) || (spans(x, y) && crosses(x, y, half(), half()));
    return meets && !in_diamond(bx, by, x, y);
  }
  /// Does it draw a pixel of this column, or row if it is steep?
  [[nodiscard]] bool steps_on(int x, int y) const {
    const double slope = steep() ? static_cast<double>(bx - ax) / static_cast<double>(by - ay)
                                 : static_cast<double>(by - ay) / static_cast<double>(bx - ax);
    const double across = steep() ? static_cast<double>(ax) + slope * static_cast<double>(centre(y) - ay)
                                  : static_cast<double>(ay) + slope * static_cast<double>(centre(x) - ax);
    const int pixel = static_cast<int>(std::floor(across / static_cast<double>(one)));
    for (int k = pixel - 1; k <= pixel + 1; ++k) {
      if (steep() ? draws(k, y) : draws(x, k)) return true;
    }
    return false;
  }
};

template <class Number, class Product>
ThinLine<Number, Product> thin_line(const std::array<Number, 3>& x, const std::array<Number, 3>& y,
                                    Number one) {
  return {x[0], y[0], x[1], y[1], one};
}

/// Width on the machine's grid, or as it is.
double line_width(const WindowTriangle& t) {
  const double width = std::clamp(t.line_width, 1.0, 64.0);
  return t.exact ? std::nearbyint(std::ldexp(width, t.subpixel_bits)) : width;
}

template <class Line, class Number>
bool covers_band(const Line& line, const WindowTriangle& t, int x, int y, Number one) {
  const auto width = static_cast<Number>(line_width(t));
  // the band reaches from `before` above the line to `after` below it, so the line from `after` above a pixel
  // that it covers
  const Number before = width / 2;
  const Number after = width - before;
  if (width == one) return line.draws(x, y);
  return line.crosses(x, y, after, before) && line.steps_on(x, y);
}

/// A direction of length one, and the length.
struct Direction {
  double x, y, length;
};
Direction direction_of(const WindowTriangle& t) {
  const double dx = t.x[1] - t.x[0], dy = t.y[1] - t.y[0], length = std::hypot(dx, dy);
  return {dx / length, dy / length, length};
}

/// Half the sides of the rectangle whose pixels are looked at: a smooth line's is half a pixel longer at each
/// end and side.
struct Rectangle {
  double half_width, longer;
};
Rectangle rectangle_of(const WindowTriangle& t) {
  const double half = 0.5 * std::clamp(t.line_width, 1.0, 64.0);
  return t.line_mode == LineMode::kSmooth ? Rectangle{half + 0.5, 0.5} : Rectangle{half, 0};
}

/// Inside all four sides, of corners that run clockwise on the screen. A side's samples belong to it if it
/// goes up, or level to the right.
template <class Number, class Product>
bool inside_all(const std::array<Number, 4>& x, const std::array<Number, 4>& y, Number px, Number py) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const Number dx = x[j] - x[i], dy = y[j] - y[i];
    const Product side = static_cast<Product>(dx) * static_cast<Product>(py - y[i]) -
                         static_cast<Product>(dy) * static_cast<Product>(px - x[i]);
    if (side < 0 || (side == 0 && !(dy < 0 || (dy == 0 && dx > 0)))) return false;
  }
  return true;
}

template <class Number>
std::array<Number, 4> corners(Number a, Number b, Number ahead, Number side) {
  return {a - ahead - side, b + ahead - side, b + ahead + side, a - ahead + side};
}

bool covers_rectangle(const WindowTriangle& t, const SampleAt& at) {
  const Direction d = direction_of(t);
  const Rectangle r = rectangle_of(t);
  if (!t.exact) {
    return inside_all<double, double>(corners(t.x[0], t.x[1], d.x * r.longer, -d.y * r.half_width),
                                      corners(t.y[0], t.y[1], d.y * r.longer, d.x * r.half_width), at.px(),
                                      at.py());
  }
  // the machine's precision: the rectangle's corners lie on its grid
  const double one = std::ldexp(1.0, t.subpixel_bits);
  const auto snapped = [&](double v) { return static_cast<std::int64_t>(std::nearbyint(v * one)); };
  const auto unit = static_cast<std::int64_t>(one);
  return inside_all<std::int64_t, Wide>(
      corners(t.fixed_x[0], t.fixed_x[1], snapped(d.x * r.longer), snapped(-d.y * r.half_width)),
      corners(t.fixed_y[0], t.fixed_y[1], snapped(d.y * r.longer), snapped(d.x * r.half_width)),
      at.grid_x(unit), at.grid_y(unit));
}

/// A Bresenham line covers all samples of a pixel or none.
bool covers_line(const WindowTriangle& t, const SampleAt& at) {
  if (t.line_mode != LineMode::kBresenham) return covers_rectangle(t, at);
  const int x = at.x, y = at.y;
  if (!t.exact) return covers_band(thin_line<double, double>(t.x, t.y, 1.0), t, x, y, 1.0);
  const std::int64_t one = std::int64_t{1} << t.subpixel_bits;
  return covers_band(thin_line<std::int64_t, Wide>(t.fixed_x, t.fixed_y, one), t, x, y, one);
}

/// How far along the line a pixel's centre is; 1 at its second end.
double place_along(const WindowTriangle& t, const SampleAt& at) {
  const double dx = t.x[1] - t.x[0], dy = t.y[1] - t.y[0], px = at.px() - t.x[0], py = at.py() - t.y[0];
  if (t.line_mode != LineMode::kBresenham) return (px * dx + py * dy) / (dx * dx + dy * dy);
  return std::abs(dx) < std::abs(dy) ? py / dy : px / dx;
}

/// The part of a pixel, turned with the line, that a smooth line covers.
double smooth_part(const WindowTriangle& t, const SampleAt& at) {
  const Direction d = direction_of(t);
  const double px = at.px() - 0.5 * (t.x[0] + t.x[1]), py = at.py() - 0.5 * (t.y[0] + t.y[1]);
  const double half_width = 0.5 * std::clamp(t.line_width, 1.0, 64.0), half_length = 0.5 * d.length;
  const auto part = [](double half, double from) {
    return std::clamp(half + 0.5 - std::abs(from), 0.0, std::min(1.0, 2 * half));
  };
  return part(half_length, px * d.x + py * d.y) * part(half_width, py * d.x - px * d.y);
}

}  // namespace

SamplePlace locate_on_line(const WindowTriangle& t, const SampleAt& at) {
  SamplePlace place;
  place.covered = covers_line(t, at);
  const double along = place_along(t, at);
  place.weights = {1 - along, along, 0};
  if (t.line_mode == LineMode::kSmooth) place.part = smooth_part(t, at);
  return place;
}

SamplePlace locate_in_point(const WindowTriangle& t, const SampleAt& at) {
  SamplePlace place;
  place.weights = {1, 0, 0};
  if (t.exact) {
    const std::int64_t one = std::int64_t{1} << t.subpixel_bits;
    const auto size = static_cast<std::int64_t>(std::nearbyint(std::ldexp(t.point_size, t.subpixel_bits)));
    const std::int64_t left = t.fixed_x[0] - size / 2, top = t.fixed_y[0] - size / 2;
    const std::int64_t px = at.grid_x(one), py = at.grid_y(one);
    place.covered = px >= left && px < left + size && py >= top && py < top + size;
  } else {
    const double half = 0.5 * t.point_size, px = at.px() - t.x[0], py = at.py() - t.y[0];
    place.covered = px >= -half && px < half && py >= -half && py < half;
  }
  place.point = {0.5 + (at.px() - t.x[0]) / t.point_size, 0.5 + (at.py() - t.y[0]) / t.point_size};
  return place;
}

}  // namespace quadrille::models::reference
