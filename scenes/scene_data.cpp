#include "scenes/scene_data.h"

#include <glm/geometric.hpp>

namespace quadrille::scenes {

float Bounds::radius() const { return empty() ? 0.0F : 0.5F * glm::length(high - low); }

void Bounds::add(const glm::vec3& point) {
  low = glm::min(low, point);
  high = glm::max(high, point);
}

void Bounds::add(const Bounds& box) {
  if (box.empty()) return;
  add(box.low);
  add(box.high);
}

Bounds Bounds::transformed(const glm::mat4& matrix) const {
  Bounds result;
  if (empty()) return result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point{(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y, (corner & 4) != 0 ? high.z : low.z};
    result.add(glm::vec3(matrix * glm::vec4(point, 1)));
  }
  return result;
}

Bounds SceneData::box(const Instance& instance) const {
  const Bounds& own = primitives[instance.primitive].bounds;
  if (instance.copies < 0) return own.transformed(instance.world);
  Bounds result;
  for (const glm::mat4& copy : copies[static_cast<std::size_t>(instance.copies)]) result.add(own.transformed(copy));
  return result;
}

Bounds SceneData::bounds() const {
  Bounds result;
  for (const Instance& instance : instances) result.add(box(instance));
  return result;
}

}  // namespace quadrille::scenes
