/// Coverage by the definition, one sample at a time in 128-bit integers: the ruler for the rasteriser's
/// tests.
#pragma once

#include "models/raster/triangle_setup.h"
#include "tests/models/random_source.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace quadrille::models {

__extension__ typedef __int128 Wide;

/// Twice the area of (a, b, p): positive when clockwise on a screen whose y points down.
inline Wide doubled_area(const WindowVertex& a, const WindowVertex& b, std::int64_t px, std::int64_t py) {
  return Wide(b.x - std::int64_t{a.x}) * Wide(py - a.y) - Wide(b.y - std::int64_t{a.y}) * Wide(px - a.x);
}

/// Is a place of the grid in the triangle? One on an edge belongs to it if the edge is a top one (horizontal,
/// inside below) or a left one.
inline bool covers_point(std::array<WindowVertex, 3> v, std::int64_t px, std::int64_t py) {
  const Wide area = doubled_area(v[0], v[1], v[2].x, v[2].y);
  if (area == 0) return false;
  if (area < 0) std::swap(v[0], v[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const WindowVertex &a = v[i], &b = v[(i + 1) % 3];
    const Wide side = doubled_area(a, b, px, py);
    const bool top = a.y == b.y && b.x > a.x, left = b.y < a.y;
    if (side < 0 || (side == 0 && !top && !left)) return false;
  }
  return true;
}
/// Is a place of pixel (x, y), away from its centre, in the triangle?
inline bool covers(const std::array<WindowVertex, 3>& v, std::int64_t x, std::int64_t y, int subpixel_bits,
                   const GridPoint& from_centre = {}) {
  const std::int64_t half = std::int64_t{1} << (subpixel_bits - 1);
  return covers_point(v, (x << subpixel_bits) + half + from_centre.x,
                      (y << subpixel_bits) + half + from_centre.y);
}

/// Set-up without culling of a whole triangle in a square of `size` pixels. Its depths and 1 / w are whatever
/// the vertices hold.
inline SetupOutcome setup_in_square(const std::array<WindowVertex, 3>& v, int size, int subpixel_bits,
                                    TriangleSetup& out, int samples = 1) {
  SetupState state;
  state.scissor = {0, 0, size, size};
  state.subpixel_bits = subpixel_bits;
  state.samples = sample_grid(samples, subpixel_bits);
  return setup_triangle(v, whole_triangle_weights(), state, out);
}

/// Triangles of every awkward kind around a square of `size` pixels.
inline std::array<WindowVertex, 3> awkward_triangle(RandomSource& random, int size, int subpixel_bits) {
  const std::int32_t one = 1 << subpixel_bits, extent = size * one, far = (1 << kPositionBits) - 1 - extent;
  std::array<WindowVertex, 3> v;
  const int kind = random.integer(0, 6);
  for (WindowVertex& p : v) {
    const auto point = [&](std::int32_t low, std::int32_t high) {
      p.x = random.integer(low, high);
      p.y = random.integer(low, high);
    };
    if (kind == 0) point(-extent / 2, extent * 3 / 2);
    if (kind == 1) point(extent / 2 - 3 * one, extent / 2 + 3 * one);
    if (kind == 2) point(-far, far);
    if (kind == 3) {  // at the corners of the grid, so that edges run through the square
      p.x = (random.integer(0, 1) != 0 ? far : -far) + random.integer(-1, 1) * random.integer(0, extent);
      p.y = (random.integer(0, 1) != 0 ? far : -far) + random.integer(-1, 1) * random.integer(0, extent);
    }
    if (kind >= 4) {  // vertices on sample points and pixel corners, so that edges meet samples
      p.x = random.integer(-2, size + 2) * one + random.integer(0, 1) * one / 2;
      p.y = random.integer(-2, size + 2) * one + random.integer(0, 1) * one / 2;
    }
  }
  if (kind == 2) {  // one edge through the square, whatever its slope
    v[1].x = std::clamp(random.integer(0, 2 * extent) - v[0].x, -far, far);
    v[1].y = std::clamp(random.integer(0, 2 * extent) - v[0].y, -far, far);
  }
  if (kind == 5) {  // a sliver
    v[2].x = v[1].x + random.integer(-1, 1);
    v[2].y = v[1].y + random.integer(-1, 1);
  }
  for (WindowVertex& p : v) {
    p.z = random.real(0.0f, 1.0f);
    p.inv_w = random.real(0.05f, 2.0f);
  }
  return v;
}

}  // namespace quadrille::models
