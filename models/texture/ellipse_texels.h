/// The texels within the ellipse that a pixel covers of a level, and their weights: the elliptical weighted
/// average. [P: Greene and Heckbert 1986], [P: Heckbert 1989]
///
/// A round pixel whose radius is the distance to the next one covers an ellipse J J' of the level, J being
/// the two changes of the place. A texel at r of the way to the edge weighs exp(-2 r^2), and one beyond it
/// nothing. A texel is no point, so a circle of one texel is added to the ellipse (J J' + 1). So the smallest
/// ellipse has a radius of one texel, and none is so thin that it misses all of them.
///
/// What bounds the work: the shorter axis is widened until it is at least the longer one over the sampler's
/// greatest anisotropy. The level is that of the shorter of the two changes, or of the axis where that is
/// widened more, so the shorter axis is below two texels. Where the sampler's limits or a bias ask for a
/// finer level, the ellipse shrinks to such a size: it is as sharp as they ask for. [M: Mesa's lavapipe takes
/// the same ellipse, circle, weights and level, without the limits]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille::models {

/// A number for each of eight lanes.
using GroupFloats = std::array<float, 8>;

/// 2x2 texels that an ellipse takes at most. At 16 times as long as wide it is 64 by 4.5 texels, which
/// tests/models/texture/ellipse_test.cpp turns and moves to find the most.
inline constexpr int kMaxEllipseFootprints = 96;

/// (a u + b v) u + c v v of a distance from the centre in texels: 0 there and `kEllipseSteps` at the edge.
struct TexelEllipse {
  float a = 0, b = 0, c = 0;
  float half_width = 0, half_height = 0;  ///< of its bounds, in texels
};
/// Weights are a table of so many steps, each its own below the next one.
inline constexpr int kEllipseSteps = 1023;

/// Of the changes of a place along x and y, in texels of the level (any finite ones). `most`: the greatest
/// anisotropy, 1 to 16.
[[nodiscard]] TexelEllipse texel_ellipse(std::array<float, 2> along_x, std::array<float, 2> along_y,
                                         float most);

/// The weight of a texel at a distance; 0 beyond the edge.
[[nodiscard]] float ellipse_weight(const TexelEllipse& ellipse, float u, float v);

/// 2x2 texels from (column, row) on, of an image that has no ends.
struct EllipseFootprint {
  std::int32_t column, row;
  std::array<float, 4> weight;  ///< of (0,0) (1,0) (0,1) (1,1)
};

/// Those that hold texels with a weight, two rows at a time from the top, each row from the left. The centre
/// is in texels, where the first texel's is at 0; its size is below 2^20. Returns how many.
[[nodiscard]] int ellipse_footprints(const TexelEllipse& ellipse, float x, float y,
                                     std::span<EllipseFootprint, kMaxEllipseFootprints> out);

}  // namespace quadrille::models
