/// Functions of the host's mathematics library for geometry and textures that we make ourselves: computed in
/// double and rounded once, so that a last bit in which two libraries differ does not reach a pixel.
#pragma once

#include <cmath>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace quadrille::scenes {

/// Angles in radians.
[[nodiscard]] inline float sine(float angle) {
  return static_cast<float>(std::sin(static_cast<double>(angle)));
}
[[nodiscard]] inline float cosine(float angle) {
  return static_cast<float>(std::cos(static_cast<double>(angle)));
}
[[nodiscard]] inline float power(float base, float exponent) {
  return static_cast<float>(std::pow(static_cast<double>(base), static_cast<double>(exponent)));
}
/// A turn around an axis.
[[nodiscard]] inline glm::mat4 rotation(float angle, const glm::vec3& axis) {
  return glm::mat4(glm::rotate(glm::dmat4(1), static_cast<double>(angle), glm::dvec3(axis)));
}

}  // namespace quadrille::scenes
