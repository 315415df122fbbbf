/// Test cards: pictures of numbers that a fragment shader takes from one texture, in any format, size and
/// sampler state, for the machine, the reference and lavapipe alike.
#pragma once

#include "traces/command_stream.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::pipeline::test {

inline constexpr std::uint32_t kCardSide = 48;  ///< pixels

/// Of an image that brings texels: random ones, of floats no larger than 2.
[[nodiscard]] traces::Image card_image(traces::Format format, std::uint32_t width, std::uint32_t height,
                                       std::uint32_t levels, std::uint64_t seed);
/// Of a line, a volume, or several layers.
[[nodiscard]] traces::Image card_image(traces::Format format, traces::ImageKind kind,
                                       const std::array<std::uint32_t, 3>& size, std::uint32_t layers,
                                       std::uint32_t levels, std::uint64_t seed);

struct TextureCard {
  traces::Image image;
  traces::Sampler sampler;
  /// Pixel (i, j) lies at texel (i + 0.5) step + first of the finest level, along each axis.
  std::array<float, 2> step{0.5f, 0.5f}, first{0, 0};
  /// GLSL that gives the texel of the sampler `t` at the coordinates `uv`; `at` are those in texels, `dir`
  /// are directions that meet every face of a cube, near its edges too.
  std::string sample = "texture(t, uv)";
  traces::ViewKind view = traces::ViewKind::k2D;
  std::uint32_t first_layer = 0, layers = 1;
  models::ComponentMapping components = models::kSameComponents;
  bool shadow = false;     ///< the sampler compares
  bool separate = false;   ///< texture and sampler are bound by themselves
  bool in_vertex = false;  ///< sampled in the vertex shader
  double tolerance = -1;   ///< of a component; negative: by format and filter
};

/// One pass to R32G32B32A32_SFLOAT. Of integers, the left half shows the low 16 bits and the right half the
/// high ones.
[[nodiscard]] traces::CommandStream card_stream(const TextureCard& card);

/// Cards of every operation on textures, on images of every kind.
[[nodiscard]] std::vector<TextureCard> operation_cards();
/// Cards of surfaces in perspective, with samples along an axis.
[[nodiscard]] std::vector<TextureCard> anisotropy_cards();

/// Formats of images that bring texels.
[[nodiscard]] std::vector<traces::Format> texture_formats();

/// A card for each format, with each filter, wrap, border and number of levels somewhere. Nearest ones keep
/// away from the boundaries of texels, where two renderers may round to either side.
[[nodiscard]] std::vector<TextureCard> format_cards();
[[nodiscard]] std::string name_of(const TextureCard& card);

/// The largest difference that a rounding may make of a component.
[[nodiscard]] double card_tolerance(const TextureCard& card);

}  // namespace quadrille::pipeline::test
