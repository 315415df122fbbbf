/// Radiance in every direction, on the faces of a cube, as Vulkan lays them out.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/vec3.hpp>

namespace quadrille::scenes {

/// The direction, not of unit length, of a place on a face: -1..1 rightwards and downwards, or beyond.
/// [VK1.3 #textures-cube-map-face-selection]
[[nodiscard]] glm::dvec3 face_direction(int face, double right, double down);

struct FacePlace {
  int face = 0;
  double right = 0, down = 0;  ///< -1..1
};
[[nodiscard]] FacePlace place_on_face(const glm::dvec3& direction);

struct RadianceCube {
  std::uint32_t size = 1;
  std::vector<glm::vec3> texels;  ///< face by face, rows top to bottom

  explicit RadianceCube(std::uint32_t side) : size(side), texels(std::size_t{6} * side * side) {}
  [[nodiscard]] glm::vec3& at(int face, std::uint32_t column, std::uint32_t row) {
    return texels[(static_cast<std::size_t>(face) * size + row) * size + column];
  }
  [[nodiscard]] const glm::vec3& at(int face, std::uint32_t column, std::uint32_t row) const {
    return texels[(static_cast<std::size_t>(face) * size + row) * size + column];
  }
  /// Of the middle of a texel.
  [[nodiscard]] glm::dvec3 direction(int face, std::uint32_t column, std::uint32_t row) const {
    return face_direction(face, middle(column), middle(row));
  }
  /// Linear between the four texels around; beyond an edge lies the next face.
  [[nodiscard]] glm::dvec3 sample(const glm::dvec3& direction) const;
  /// The solid angle of a texel, but for a factor that all have.
  [[nodiscard]] double weight(std::uint32_t column, std::uint32_t row) const;

 private:
  [[nodiscard]] double middle(std::uint32_t index) const { return (2.0 * index + 1) / size - 1; }
  [[nodiscard]] glm::dvec3 texel(int face, int column, int row) const;
};

/// The cube and its means over ever more texels, down to one texel a face. Its side is a power of two.
class CubeChain {
 public:
  explicit CubeChain(RadianceCube finest);
  /// Linear between levels too.
  [[nodiscard]] glm::dvec3 sample(const glm::dvec3& direction, double level) const;
  [[nodiscard]] const RadianceCube& finest() const { return levels_.front(); }

 private:
  std::vector<RadianceCube> levels_;
};

}  // namespace quadrille::scenes
