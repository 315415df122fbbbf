/// What an instruction on a texture gives, for one lane, in doubles: volumes, cubes and arrays, gradients,
/// anisotropy, comparison, gathers and fetches. [VK1.3 #textures]
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "models/reference/sampling.h"

namespace quadrille::models::reference {

using Vector = std::array<double, 3>;

/// A lane's question. Coordinates are normalised, of a cube a direction; `layer` of an array.
struct TextureQuestion {
  Vector at{};
  double layer = 0;
  Vector along_x{}, along_y{};  ///< changes of the coordinates to the next pixel, or gradients
  std::optional<double> level;  ///< given instead of them
  double bias = 0;
  std::optional<double> reference;  ///< to compare with
  std::array<std::int64_t, 3> offset{};
};

[[nodiscard]] Texel filtered_texel(const TextureView& texture, const TextureQuestion& question);
/// The four texels of a linear filter, in the order of a gather, each with all components; or of a comparison
/// with its result as the first.
[[nodiscard]] std::array<Texel, 4> gathered_texels(const TextureView& texture,
                                                   const TextureQuestion& question);
/// By integers: place, then the layer of an array. Outside of the image, its levels and its samples,
/// transparent black.
[[nodiscard]] Texel fetched_texel(const TextureView& texture, const std::array<std::int64_t, 3>& place,
                                  std::int64_t level, std::int64_t sample);
/// The level that is read, and the level of detail before limits.
[[nodiscard]] std::array<double, 2> queried_levels(const TextureView& texture,
                                                   const TextureQuestion& question);

}  // namespace quadrille::models::reference
