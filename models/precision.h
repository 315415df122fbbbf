/// Precisions of the fixed-function units that a machine may choose; all other widths are fixed by the
/// numeric contract (docs/architecture.md).
#pragma once

namespace quadrille::models {

struct Precision {
  int subpixel_bits = 8;  ///< fractional bits of window positions, 4..12
  int subtexel_bits = 8;  ///< fractional bits of a texel coordinate: weights of the bilinear filter, 1..8
  int lod_bits = 8;       ///< fractional bits of the level of detail: weight between mip levels, 1..8
  /// the level of detail's log2 is linear between powers of two, as cheap hardware has it: up to 0.043 levels
  /// low
  bool linear_log2 = false;
  /// Anisotropic samples lie along the longer axis of the ellipse that a round pixel covers [P: Heckbert
  /// 1989]; else along the longer of the pixel's two differences, as in Vulkan's equations
  bool ellipse_axis = false;
};

}  // namespace quadrille::models
