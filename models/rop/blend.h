/// Blending and conversion of colours to and from what a colour attachment stores. [VK1.3
/// #framebuffer-blending]
///
/// All arithmetic is fp32 on linear values: the destination is decoded, blended and encoded once. Formats
/// that hold 0..1 alone clamp sources and results to that (NaN becomes 0); the others clamp nothing. Alpha is
/// never sRGB. Integers are not blended: their low bits are stored as they come.
#pragma once

#include "models/base/format.h"
#include "models/base/pipeline_state.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// Does a write under this state need the old pixel (blending with it, or a partial write mask)?
[[nodiscard]] bool reads_destination(const BlendState& state, const BlendShared& shared = {});

/// Blends four pixels. `rgba[c][i]` is component c of pixel i as written, or the bits of an integer;
/// `dst_pixels` holds the attachment's four pixels, one behind the other, and receives the result where
/// `lane_mask` (bits 0..3) is set. `second` is the second source, as `rgba`; null: there is none.
void blend_quad(const BlendState& state, const BlendShared& shared, Format format, const float rgba[4][4],
                const float (*second)[4], std::byte* dst_pixels, std::uint32_t lane_mask);

/// A clear colour in the attachment's encoding. Not of a format of integers.
[[nodiscard]] PixelCode encode_color(Format format, const std::array<float, 4>& rgba);
/// The same of a format of integers: their bits, of which a format keeps the low ones.
[[nodiscard]] PixelCode encode_integers(Format format, const std::array<std::uint32_t, 4>& rgba);
/// Is each of these integers what a pixel of the format would hold?
[[nodiscard]] bool holds_integers(Format format, const std::array<std::uint32_t, 4>& rgba);

/// What a pixel stands for, linear; integers as the nearest floats. Components that it lacks: (0, 0, 0, 1).
[[nodiscard]] std::array<float, 4> decode_color(Format format, const PixelCode& pixel);

/// A pixel as red, green, blue and alpha of 8 bits, red in the low byte, as pictures have them: wider or
/// narrower components are rounded to nearest, an sRGB encoding is kept. Floats are linear values, which a
/// picture has sRGB-encoded. Of integers it shows the low 8 bits. Components that the format lacks are
/// (0, 0, 0, 1).
[[nodiscard]] std::uint32_t to_rgba8(Format format, const PixelCode& pixel);

}  // namespace quadrille::models
