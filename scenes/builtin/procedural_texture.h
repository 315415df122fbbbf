/// Textures by formula for the built-in scenes. All tile: the left edge continues the right one, the top the
/// bottom.
#pragma once

#include <cstdint>
#include <functional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/image/image_io.h"

namespace quadrille::scenes {

/// Smooth noise in 0..1 that repeats every `period` lattice cells; `octaves` halve in size and weight.
[[nodiscard]] float tiling_noise(glm::vec2 p, int period, int octaves, std::uint32_t seed);
/// A fixed pseudo-random number in 0..1 for a lattice point.
[[nodiscard]] float lattice_random(int x, int y, std::uint32_t seed);

/// The nearest of one jittered point a cell: distance to the border between the two nearest, and a number for
/// the cell.
struct CellPoint {
  float border = 0, random = 0;
};
[[nodiscard]] CellPoint tiling_cells(glm::vec2 p, int period, std::uint32_t seed);

/// Evaluates `color` (linear, 0..1) at the centre of every texel, u and v in 0..1; rgb is stored sRGB-encoded
/// when `srgb`.
[[nodiscard]] Rgba8Image paint(std::uint32_t size, bool srgb,
                               const std::function<glm::vec4(glm::vec2)>& color);
/// A tangent-space normal map of a tiling height field, `depth` in units of the texture's width.
[[nodiscard]] Rgba8Image paint_normals(std::uint32_t size, float depth,
                                       const std::function<float(glm::vec2)>& height);

/// 0 below `low`, 1 above `high`, smooth between.
[[nodiscard]] float smooth_ramp(float low, float high, float x);

}  // namespace quadrille::scenes
