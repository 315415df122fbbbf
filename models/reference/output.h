/// Depth test, blending and conversion to the target's format, for one sample. Internal to the reference.
#pragma once

#include <array>
#include <cstdint>

#include "traces/command_stream.h"

namespace quadrille::models::reference {

/// incoming `op` stored; a NaN passes only kNotEqual and kAlways. [VK1.3 #fragops-depth]
[[nodiscard]] bool depth_passes(traces::CompareOp op, double incoming, double stored);

/// The nearest depth that a format holds, ties to even; a format of floats holds all here.
[[nodiscard]] double held_depth(traces::Format format, double depth);

/// A pixel of a depth attachment, as shaders sample it: without stencil values.
[[nodiscard]] PixelCode store_depth(traces::Format format, double depth);

/// What a pixel of a depth attachment holds; 0 of stencil values where the format has none.
[[nodiscard]] double load_depth(traces::Format format, const PixelCode& code);
[[nodiscard]] std::uint8_t load_stencil(traces::Format format, const PixelCode& code);

/// May a fragment stay whose stencil values compare so? `stored` is what the pixel holds.
[[nodiscard]] bool stencil_passes(const traces::StencilFace& face, std::uint8_t stored);
/// What the pixel holds after an operation.
[[nodiscard]] std::uint8_t stencil_after(const traces::StencilFace& face, traces::StencilOp op,
                                         std::uint8_t stored);

/// |a - b| in units of the last place of the float32 nearest to the larger of the two.
[[nodiscard]] double float_ulps(double a, double b);

/// A pixel as its format stores it and the linear values it was rounded from.
struct StoredColor {
  PixelCode code;
  std::array<double, 4> linear{};
};

/// Blends a shader's output into a stored pixel: source and destination in linear values, clamped to 0..1
/// (NaN: 0) where the format holds no others, as is the result, which is then encoded and rounded to nearest,
/// ties to even. Of integers the low bits are stored as they come. Channels that the mask leaves out keep
/// what they hold. [VK1.3 #framebuffer-blending]
/// `second` is the second source.
[[nodiscard]] StoredColor blend(const traces::BlendState& state, const traces::BlendShared& shared,
                                traces::Format format, const std::array<double, 4>& source,
                                const std::array<double, 4>& second, const StoredColor& before);

/// The linear values of a pixel or texel. Components that the format lacks are (0, 0, 0, 1).
[[nodiscard]] std::array<double, 4> load_color(traces::Format format, const PixelCode& code);
/// A pixel as 8 bits a component, red in bits 0..7, an sRGB encoding kept, floats sRGB-encoded, of integers
/// the low bits.
[[nodiscard]] std::uint32_t to_bytes(traces::Format format, const PixelCode& code);

/// The stored form of linear values.
[[nodiscard]] StoredColor store_color(traces::Format format, const std::array<double, 4>& linear);

}  // namespace quadrille::models::reference
