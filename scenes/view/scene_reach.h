/// How far a scene reaches along a direction: what a camera that frames it asks.
///
/// Of meshes at rest every vertex counts, of posed ones the boxes of what each joint moves. A box around a
/// whole round or slanting object has corners where nothing is, and a camera that held them would show the
/// object small.
#pragma once

#include <array>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

using Directions = std::array<glm::dvec3, 4>;  ///< of any length
using Reaches = std::array<double, 4>;

/// Asked for several sets of directions; refers to the scene.
class SceneReach {
 public:
  /// Where the scene draws more than `most_points` vertices, its boxes stand for them, and where there are
  /// more than 4096 of those, the box around all.
  SceneReach(const PlacedScene& scene, const glm::dvec3& origin, std::size_t most_points);

  /// The largest of dot(direction, point - origin) over what a camera has to hold
  /// (`PlacedScene::visit_boxes`), for each direction; -infinity for an empty scene.
  [[nodiscard]] Reaches operator()(const Directions& directions) const;

 private:
  /// Points of a mesh, or a box, and where they are.
  struct Part {
    glm::dmat4 world{1};
    const Array* points = nullptr;
    Bounds box;
  };

  void add(const Instance& instance, const glm::dmat4& world, bool by_vertex);
  void add_box(const Bounds& box, const glm::dmat4& world = glm::dmat4(1));

  const PlacedScene& scene_;
  glm::dvec3 origin_;
  std::vector<Part> parts_;
};

}  // namespace quadrille::scenes
