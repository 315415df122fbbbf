/// Blending and conversion of colours to and from what a colour attachment stores. [VK1.3
/// #framebuffer-blending]
///
/// All arithmetic is fp32 on linear values: the destination is decoded, blended, clamped to 0..1 (NaN becomes
/// 0) and encoded once. Alpha is never sRGB.
#pragma once

#include "models/base/format.h"
#include "models/base/pipeline_state.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

/// Does a write under this state need the old pixel (blending with it, or a partial write mask)?
[[nodiscard]] bool reads_destination(const BlendState& state);

/// Blends four pixels. `rgba[c][i]` is component c of pixel i as the shader wrote it; `dst_pixels` holds the
/// attachment's pixels in its format and receives the result where `lane_mask` (bits 0..3) is set. Source
/// and blend factors are clamped to 0..1 first, as a UNORM target asks.
void blend_quad(const BlendState& state, Format format, const float rgba[4][4], std::uint32_t dst_pixels[4],
                std::uint32_t lane_mask);

/// A clear colour in the attachment's encoding.
[[nodiscard]] std::uint32_t encode_color(Format format, const std::array<float, 4>& rgba);

/// A pixel as red, green, blue and alpha of 8 bits, red in the low byte, as pictures have them: wider or
/// narrower components are rounded to nearest, an sRGB encoding is kept.
[[nodiscard]] std::uint32_t to_rgba8(Format format, std::uint32_t pixel);

}  // namespace quadrille::models
