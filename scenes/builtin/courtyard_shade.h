/// Sunlight in the courtyard, computed once a vertex: the machine draws no shadows, so the big surfaces carry
/// theirs in their vertex colours.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

namespace quadrille::scenes::courtyard {

/// The way to the sun, unit length.
[[nodiscard]] glm::vec3 to_sun();

/// What stands between a point and the sun.
class Shade {
 public:
  /// Blocks all light.
  void add_box(const glm::vec3& low, const glm::vec3& high) { boxes_.push_back({low, high}); }
  /// A vertical cylinder; blocks all light.
  void add_cylinder(const glm::vec3& foot, float radius, float height) {
    cylinders_.push_back({foot, radius, height});
  }
  /// A tree crown: lets specks of light through.
  void add_crown(const glm::vec3& center, float radius) { crowns_.push_back({center, radius}); }
  /// The vertex colour of a point: 1 in the sun, less in shade, averaged over the sun's disc.
  [[nodiscard]] float at(const glm::vec3& point) const;

 private:
  struct Box {
    glm::vec3 low, high;
  };
  struct Cylinder {
    glm::vec3 foot;
    float radius, height;
  };
  struct Crown {
    glm::vec3 center;
    float radius;
  };
  [[nodiscard]] float lit(const glm::vec3& point, const glm::vec3& direction) const;

  std::vector<Box> boxes_;
  std::vector<Cylinder> cylinders_;
  std::vector<Crown> crowns_;
};

}  // namespace quadrille::scenes::courtyard
