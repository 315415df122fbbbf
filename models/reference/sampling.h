/// Texture sampling by Vulkan's equations, in doubles. [VK1.3 #textures-texel-coordinate-systems]
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "models/reference/reference.h"
#include "traces/command_stream.h"

namespace quadrille::models::reference {

using Texel = std::array<double, 4>;  ///< linear red, green, blue, alpha; or integers

/// An image, of which some levels are seen, with the sampler it is read through. Borrowed from the stream.
/// `precision` null: no quantisation.
struct TextureView {
  const traces::Image* image = nullptr;
  const traces::Sampler* sampler = nullptr;
  const Precision* precision = nullptr;
  std::uint32_t first_level = 0, levels = 1;
  /// components that a border colours; 0: those of the image's format
  std::uint32_t channels = 0;
  traces::ViewKind kind = traces::ViewKind::k2D;
  std::uint32_t first_layer = 0, layers = 1;
  ComponentMapping components = kSameComponents;
  /// By layer, where passes have drawn them: images of one layer each. Empty: `image` brings its texels.
  std::vector<const traces::Image*> drawn{};
};

/// Decodes one texel of a level; x and y are inside it. The samples of a texel follow each other.
[[nodiscard]] Texel fetch_texel(const traces::Image& image, std::uint32_t level, std::uint32_t x,
                                std::uint32_t y, std::uint32_t sample = 0);

/// Decodes one texel of what the view sees: of a level, and of a layer or slice.
[[nodiscard]] Texel view_texel(const TextureView& texture, std::uint32_t level, std::uint32_t x,
                               std::uint32_t y, std::uint32_t slice, std::uint32_t sample = 0);

/// log2 of the larger of the two footprint lengths, in texels of the finest level. The derivatives are of
/// normalised coordinates. Minus infinity where both are zero. [VK1.3 #textures-scale-factor]
[[nodiscard]] double base_lod(const TextureView& texture, std::array<double, 2> d_dx,
                              std::array<double, 2> d_dy);

/// Samples at normalised (u, v). `base` is the level of detail before the shader's `bias`, the sampler's bias
/// and its clamps; together the biases are limited to
/// +-16. A nearest mip level is the one of ceil(lambda + 0.5) - 1. A coordinate or bias that is not finite
/// counts as 0, so does a NaN level. [VK1.3 #textures-level-of-detail-operation]
[[nodiscard]] Texel sample_texture(const TextureView& texture, double u, double v, double base, double bias);

inline constexpr std::int64_t kBeyondBorder = -1;
/// The texel that an index outside [0, size) stands for. [VK1.3 #textures-wrapping-operation]
[[nodiscard]] std::int64_t wrapped(std::int64_t i, std::int64_t size, traces::Wrap wrap);
/// What lies beyond the image: of the components that its format has.
[[nodiscard]] Texel border_texel(const TextureView& texture, BorderColor border);
/// Rounds to `bits` fractional bits where a precision is given.
[[nodiscard]] double quantised(double a, const Precision* precision, int Precision::*bits);
/// floor as an integer; coordinates beyond any texture are kept within what the arithmetic holds.
[[nodiscard]] std::int64_t floor_index(double a);
[[nodiscard]] Texel mix(const Texel& a, const Texel& b, double t);
/// The level of detail after bias, limits and rounding, as far as there are levels.
[[nodiscard]] double final_lambda(const TextureView& texture, double base, double bias);

/// What a word of a format of integers stands for.
[[nodiscard]] double integer_value(traces::Format format, std::uint32_t bits);

/// The number, or 0 if it is not finite.
[[nodiscard]] double finite_or_zero(double a);

/// Extent (width, height) of a level; of level 0 for one that the image lacks.
[[nodiscard]] std::array<std::uint32_t, 2> level_extent(const traces::Image& image, std::uint32_t level);
/// Of a level that the view sees, from 0; the finest for one that it does not.
[[nodiscard]] std::array<std::uint32_t, 2> level_extent(const TextureView& texture, std::uint32_t level);

/// The inverse of the sRGB encoding, [0, 1] to [0, 1]. [VK1.3 references Khronos Data Format #TRANSFER_SRGB]
[[nodiscard]] double srgb_to_linear(double encoded);
/// The sRGB encoding, [0, 1] to [0, 1].
[[nodiscard]] double linear_to_srgb(double linear);

}  // namespace quadrille::models::reference
