/// Blending and conversion of colours to and from what a colour attachment stores. [VK1.3
/// #framebuffer-blending]
///
/// All arithmetic is fp32 on linear values: the destination is decoded, blended, clamped to 0..1 (NaN becomes
/// 0) and encoded once. Alpha is never sRGB.
#pragma once

#include "models/base/format.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

enum class BlendFactor : std::uint8_t {
  kZero,
  kOne,
  kSrcColor,
  kOneMinusSrcColor,
  kDstColor,
  kOneMinusDstColor,
  kSrcAlpha,
  kOneMinusSrcAlpha,
  kDstAlpha,
  kOneMinusDstAlpha
};
enum class BlendOp : std::uint8_t { kAdd, kSubtract, kReverseSubtract, kMin, kMax };

struct BlendState {
  bool enable = false;
  BlendFactor src_color = BlendFactor::kOne, dst_color = BlendFactor::kZero, src_alpha = BlendFactor::kOne,
              dst_alpha = BlendFactor::kZero;
  BlendOp color = BlendOp::kAdd, alpha = BlendOp::kAdd;
  std::uint8_t write_mask = 0xf;  ///< bit 0 red .. bit 3 alpha
};

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
