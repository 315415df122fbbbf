/// Edge functions and planes: what decides a pixel, and what is interpolated over it.
#pragma once

#include <cstdint>

namespace quadrille::models {

/// Inside: origin + a * px + b * py >= 0, at the centre of pixel (px, py). |a|, |b| < 2^30; values fit 62
/// bits for pixels within the window grid.
struct EdgeFunction {
  std::int64_t origin = 0, a = 0, b = 0;
  std::int64_t fraction = 0;  ///< what was rounded off `origin`, for samples away from the centre
  /// Heights on the sub-pixel grid between which it bounds the shape: from `top` on and before `bottom`. One
  /// without ends bounds it at every height.
  std::int64_t top = -kEndless, bottom = kEndless;
  static constexpr std::int64_t kEndless = std::int64_t{1} << 40;
  [[nodiscard]] std::int64_t at(std::int64_t px, std::int64_t py) const { return origin + a * px + b * py; }
};

/// A window position, or a way, on the sub-pixel grid.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

/// The edge from a to b of a shape whose inside is where the value is positive (its corners run clockwise on
/// the screen, y down). The top-left rule is folded in.
[[nodiscard]] constexpr EdgeFunction make_edge(const GridPoint& a, const GridPoint& b, int subpixel_bits) {
  EdgeFunction edge;
  edge.a = a.y - b.y;
  edge.b = b.x - a.x;
  const bool top_left = edge.a > 0 || (edge.a == 0 && edge.b > 0);
  const std::int64_t half = std::int64_t{1} << (subpixel_bits - 1);
  const std::int64_t at_first_centre = edge.a * (half - a.x) + edge.b * (half - a.y) - (top_left ? 0 : 1);
  edge.origin = at_first_centre >> subpixel_bits;  // rounds down: keeps the sign at every centre
  edge.fraction = at_first_centre & ((std::int64_t{1} << subpixel_bits) - 1);
  edge.top = a.y < b.y ? a.y : b.y;
  edge.bottom = a.y < b.y ? b.y : a.y;
  return edge;
}

/// The same edge without ends: of a shape that its bounds cut off.
[[nodiscard]] constexpr EdgeFunction endless(EdgeFunction edge) {
  edge.top = -EdgeFunction::kEndless;
  edge.bottom = EdgeFunction::kEndless;
  return edge;
}

/// First pixel whose centre is at or after a position of the grid.
[[nodiscard]] constexpr std::int32_t first_pixel_from(std::int64_t position, int subpixel_bits) {
  const std::int64_t one = std::int64_t{1} << subpixel_bits;
  return static_cast<std::int32_t>((position - one / 2 + one - 1) >> subpixel_bits);
}

/// value + dx * X + dy * Y, X and Y in pixels from the primitive's reference point to the pixel's centre.
struct Plane {
  double value = 0, dx = 0, dy = 0;
};

}  // namespace quadrille::models
