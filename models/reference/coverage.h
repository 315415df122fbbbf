/// Which samples a triangle, line or point in window space covers, and where in it they are. Internal to the
/// reference.
///
/// Mode *given*: exact integers of any size the input allows. Mode *ideal*: doubles, each edge evaluated from
/// its lexicographically smaller end, so that two triangles get opposite values from a shared edge and every
/// sample belongs to one of them. Samples on an edge: top-left rule. [VK1.3 #primsrast-polygons-basic]
#pragma once

#include <array>
#include <cstdint>

#include "traces/command_stream.h"

namespace quadrille::models::reference {

using traces::LineMode;

enum class Shape : std::uint8_t { kTriangle, kLine, kPoint };

/// A triangle to be drawn; or a line between the first two corners, or a point at the first, whose other
/// corners repeat the last one. The first three members are the *original* primitive's, for its attributes.
struct WindowTriangle {
  std::uint32_t instance = 0, primitive = 0;
  std::uint32_t viewport = 0;
  std::array<std::uint32_t, 3> vertices{};  ///< distinct vertices (ShadedVertices) in assembly order
  Shape shape = Shape::kTriangle;
  LineMode line_mode = LineMode::kBresenham;
  double line_width = 1, point_size = 1;  ///< pixels
  bool exact = false;                     ///< `fixed_x`, `fixed_y` hold; else `x`, `y` alone
  int subpixel_bits = 0;
  std::array<std::int64_t, 3> fixed_x{}, fixed_y{};
  std::array<double, 3> x{}, y{}, z{}, inv_w{};  ///< framebuffer coordinates, depth, 1 / clip w
  /// (b1, b2) of each corner in the original triangle, clip space
  std::array<std::array<double, 2>, 3> barycentric{};
  std::array<std::array<double, 2>, 3> screen_barycentric{};  ///< the same, linear in the framebuffer
  /// on the screen, y down; the sign of `doubled_area`
  bool clockwise = false;
  bool front = true;
  int first_x = 0, first_y = 0, last_x = -1, last_y = -1;  ///< pixels it may cover, inclusive
};

/// Twice the area by the shoelace formula, y down: positive where the corners run clockwise on the screen.
/// Zero exactly for degenerate triangles.
[[nodiscard]] double doubled_area(const WindowTriangle& triangle);

/// A pixel centre's place in a primitive; a triangle's `clockwise` is set.
struct SamplePlace {
  bool covered = false;
  /// linear in the framebuffer, of the three corners; sum 1; extrapolated outside
  std::array<double, 3> weights{};
  double part = 1;                ///< of the pixel, that a smooth line covers
  std::array<double, 2> point{};  ///< coordinates within a point, 0 to 1
};
/// A place in a pixel: its centre, or a sample away from it.
struct SampleAt {
  int x = 0, y = 0;                             ///< the pixel
  double from_centre_x = 0, from_centre_y = 0;  ///< pixels, sixteenths
  [[nodiscard]] double px() const { return x + 0.5 + from_centre_x; }
  [[nodiscard]] double py() const { return y + 0.5 + from_centre_y; }
  /// On a grid of `one` steps a pixel.
  [[nodiscard]] std::int64_t grid_x(std::int64_t one) const {
    return x * one + one / 2 + static_cast<std::int64_t>(from_centre_x * static_cast<double>(one));
  }
  [[nodiscard]] std::int64_t grid_y(std::int64_t one) const {
    return y * one + one / 2 + static_cast<std::int64_t>(from_centre_y * static_cast<double>(one));
  }
};
/// The samples of pixel (x, y): 1, 2, 4 or 8. [VK1.3 #primsrast-multisampling, standard sample locations]
[[nodiscard]] SampleAt sample_at(int x, int y, std::uint32_t samples, std::uint32_t sample);
[[nodiscard]] SamplePlace locate_on_line(const WindowTriangle& t, const SampleAt& at);
[[nodiscard]] SamplePlace locate_in_point(const WindowTriangle& t, const SampleAt& at);
[[nodiscard]] SamplePlace locate_sample(const WindowTriangle& triangle, const SampleAt& at);

}  // namespace quadrille::models::reference
