/// Precisions of the fixed-function units that a machine may choose; all other widths are fixed by the
/// numeric contract (docs/architecture.md).
#pragma once

#include <cstdint>

namespace quadrille::models {

/// What an anisotropic filter takes of a level. The ellipse is the one that a round pixel covers. [P:
/// Heckbert 1989]
enum class AnisotropicFootprint : std::uint8_t {
  kLongerDifference,  ///< samples along the longer of the pixel's two differences, as in Vulkan's equations
  kEllipseAxis,       ///< samples along the longer axis of the ellipse
  kEllipse            ///< the texels within the ellipse, weighed (texture/ellipse_texels.h)
};

struct Precision {
  int subpixel_bits = 8;  ///< fractional bits of window positions, 4..12
  int subtexel_bits = 8;  ///< fractional bits of a texel coordinate: weights of the bilinear filter, 1..8
  int lod_bits = 8;       ///< fractional bits of the level of detail: weight between mip levels, 1..8
  /// the level of detail's log2 is linear between powers of two, as cheap hardware has it: up to 0.043 levels
  /// low
  bool linear_log2 = false;
  AnisotropicFootprint anisotropic_footprint = AnisotropicFootprint::kLongerDifference;
};

}  // namespace quadrille::models
