/// What a map of the environment stands for, integrated directly: the ruler of docs/environment.md.
///
/// Nothing of scenes/environment/ but the cube that holds the radiance is used: the lobe is written down
/// anew, and summed over a grid, not over samples.
#pragma once

#include <vector>

#include <glm/ext/vector_double3.hpp>

#include "scenes/environment/radiance_cube.h"

namespace quadrille::tests {

/// Radiance that a white metal of this roughness and normal reflects towards `v`: Trowbridge and Reitz,
/// Smith's height-correlated shadowing, without light that its facets reflect more than once.
[[nodiscard]] glm::dvec3 reflected(const scenes::RadianceCube& around, const glm::dvec3& n,
                                   const glm::dvec3& v, double roughness);
/// Radiance of a white diffuse surface.
[[nodiscard]] glm::dvec3 scattered(const scenes::RadianceCube& around, const glm::dvec3& n);
/// Directions spread over the sphere. [P: Gonzalez 2010]
[[nodiscard]] std::vector<glm::dvec3> directions(int count);

}  // namespace quadrille::tests
