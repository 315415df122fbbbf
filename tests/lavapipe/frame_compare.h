/// Do two renderers show the same picture? The criteria by which Quadrille is held against lavapipe.
///
/// Each renderer gives two images of a frame: which triangle every pixel shows, and its colour. Shape is
/// judged on the first, colour on the second. A pixel is excused only for a stated reason: the two winners'
/// depths are within 2 units in the last place, or an alpha was within 1/255 of the cut-off that discards;
/// how many were is part of the result. An excused pixel is left out of every criterion.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "models/reference/compare.h"
#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {

struct Limits {
  double coverage_fraction = 1e-5;  ///< of all pixels: covered in one, background in the other
  double triangle_fraction = 1e-4;  ///< of all pixels: covered in both, by different triangles
  double within_fraction = 0.999;   ///< of all pixels: every channel within `within_lsb`
  int within_lsb = 2;
  std::uint64_t bad_blocks = 0;  ///< 8x8 blocks with more than a quarter of their pixels off by more than 8
};

inline constexpr std::uint32_t kTieUlps = 2;

/// Both images of one renderer.
struct FramePair {
  /// `triangles.color` holds an id a pixel, 0 for the background; its depth is the winner's
  Rendered color, triangles;
};

struct Comparison {
  models::reference::ImageDifference color;
  models::reference::CoverageDifference shape;
  std::uint64_t depth_ties = 0;  ///< pixels excused because the winners' depths agree within `kTieUlps`
  std::uint64_t alpha_ties = 0;  ///< pixels excused because an alpha was that close to the cut-off
  bool coverage_ok = false, triangles_ok = false, color_ok = false, blocks_ok = false;
  [[nodiscard]] bool passed() const { return coverage_ok && triangles_ok && color_ok && blocks_ok; }
};

/// Distance in representable floats; the largest value if either is NaN. Both zeros are the same.
[[nodiscard]] std::uint32_t ulps_apart(float a, float b);

/// Pixels where the triangles differ and depth does not say why: only an alpha at its cut-off may excuse
/// them. One entry a pixel, 1 or 0.
[[nodiscard]] std::vector<std::uint8_t> unexplained_pixels(const FramePair& a, const FramePair& b);

/// Judges `ours` against `theirs`, which have one size (`UserError` otherwise). `alpha_ties` (empty: none)
/// marks the pixels with an alpha within 1/255 of the cut-off (tests/lavapipe/alpha_ties.h).
[[nodiscard]] Comparison compare_frames(const FramePair& ours, const FramePair& theirs,
                                        std::span<const std::uint8_t> alpha_ties, const Limits& limits);

}  // namespace quadrille::lavapipe
