/// The viewport transform: clip space to window positions on the sub-pixel grid. [VK1.3
/// #vertexpostproc-viewport]
#pragma once

#include "models/raster/tile.h"

#include <glm/vec4.hpp>

#include <cstdint>

namespace quadrille::models {

/// Window positions satisfy |x|, |y| < 2^kPositionBits in units of 2^-subpixel_bits pixel, so that edge
/// functions fit 62 bits.
inline constexpr int kPositionBits = 29;

/// Pixels, y down; a negative height flips y. Depth range within 0..1, `min_depth` may exceed `max_depth`.
struct Viewport {
  float x = 0, y = 0, width = 0, height = 0, min_depth = 0, max_depth = 1;
};

struct WindowVertex {
  std::int32_t x = 0, y = 0;  ///< fixed point, `subpixel_bits` fractional bits
  float z = 0, inv_w = 0;     ///< window depth; 1 / w of clip space
};

/// Clip space to window, in fp32: r = 1 / w; x = fma(xc * r, width / 2, vx + width / 2) (one rounding of
/// product and sum), snapped to the nearest grid point, ties to even; y alike; z = (zc * r) * (max - min) +
/// min, limited to +-2^20 (only depth clamp meets the limit). Returns false, and the triangle must be
/// discarded, when w is not positive, when a coordinate is not finite or when the position leaves the 2^29
/// grid; none of these can happen to the output of `clip_triangle`.
[[nodiscard]] bool to_window(const glm::vec4& clip, const Viewport& viewport, int subpixel_bits,
                             WindowVertex& out);

/// Pixels that a draw may touch: the target, the scissor, and the pixels whose centre is inside the viewport,
/// because the guard band lets triangles reach beyond the view volume that Vulkan clips to. Empty for a
/// viewport that is not finite.
[[nodiscard]] PixelRect drawable_rect(const Viewport& viewport, const PixelRect& scissor,
                                      std::uint32_t target_width, std::uint32_t target_height);

}  // namespace quadrille::models
