/// From radiance to what shaders sample: levels blurred for roughness, and what diffuse surfaces get.
///
/// A level holds what a mirror of its roughness shows that is looked at straight on; what it shows at an
/// angle is taken to be the same around another direction (the split sum [P: Karis 2013]; docs/environment.md
/// has the error).
#pragma once

#include <string>
#include <vector>

#include "scenes/data/environment_map.h"
#include "scenes/environment/radiance_cube.h"

namespace quadrille::scenes {

/// The side of the coarsest level, which is that of roughness 1.
inline constexpr std::uint32_t kCoarsestSide = 8;

/// Radiance around a normal, weighted by the lobe. The cube that is sampled is that of `chain`.
[[nodiscard]] RadianceCube blurred(const CubeChain& chain, std::uint32_t side, double roughness);
/// Coefficients of `EnvironmentMap::irradiance`.
[[nodiscard]] std::array<glm::vec3, 9> diffuse_coefficients(const RadianceCube& cube);
/// Their sum for a normal.
[[nodiscard]] glm::vec3 diffuse_radiance(const std::array<glm::vec3, 9>& coefficients, const glm::vec3& n);
/// Puts levels into the map's texels, finest first, with a scale that lets 16-bit floats hold them.
void pack_levels(EnvironmentMap& map, const std::vector<RadianceCube>& levels);
/// A map of a cube whose side is a power of two of at least `kCoarsestSide`.
[[nodiscard]] EnvironmentMap prefiltered(const std::string& name, RadianceCube radiance);

}  // namespace quadrille::scenes
