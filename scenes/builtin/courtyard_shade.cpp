#include "scenes/builtin/courtyard_shade.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scenes/builtin/procedural_texture.h"

namespace quadrille::scenes::courtyard {
namespace {

constexpr float kShade = 0.36F;  // of the sunlit colour: what the sky alone gives

bool hits_box(const glm::vec3& p, const glm::vec3& d, const glm::vec3& low, const glm::vec3& high) {
  const glm::vec3 a = (low - p) / d, b = (high - p) / d;
  const glm::vec3 enter = glm::min(a, b), leave = glm::max(a, b);
  const float first = std::max({enter.x, enter.y, enter.z, 1e-3F}),
              last = std::min({leave.x, leave.y, leave.z});
  return first < last;
}

/// Does the ray come within `radius` of the axis below the top? Seen from above it is a line and a circle.
bool hits_cylinder(const glm::vec3& p, const glm::vec3& d, const glm::vec3& foot, float radius,
                   float height) {
  const glm::vec2 flat(d.x, d.z), offset(foot.x - p.x, foot.z - p.z);
  const float reach = glm::dot(offset, flat) / glm::dot(flat, flat);
  if (glm::dot(offset, offset) < radius * radius) return p.y < foot.y + height - 0.05F;
  if (reach <= 0) return false;
  const glm::vec2 miss = offset - reach * flat;
  return glm::dot(miss, miss) < radius * radius && p.y + reach * d.y < foot.y + height;
}

/// Light that a crown lets through: none in the middle, specks toward the rim.
float through_crown(const glm::vec3& p, const glm::vec3& d, const glm::vec3& center, float radius) {
  const glm::vec3 offset = center - p, miss = offset - glm::dot(offset, d) * d;
  const float distance = glm::length(miss) / radius;
  if (distance >= 1) return 1;
  const glm::vec2 at = glm::vec2(miss.x + miss.y, miss.z - miss.y) * 4.0F + 100.0F;
  return smooth_ramp(0.45F, 0.7F, tiling_noise(at, 4096, 2, 7) + 0.45F * distance - 0.15F);
}

}  // namespace

glm::vec3 to_sun() { return glm::normalize(glm::vec3(0.62F, 0.80F, 0.42F)); }

float Shade::lit(const glm::vec3& point, const glm::vec3& direction) const {
  for (const Box& box : boxes_) {
    if (hits_box(point, direction, box.low, box.high)) return 0;
  }
  for (const Cylinder& c : cylinders_) {
    if (hits_cylinder(point, direction, c.foot, c.radius, c.height)) return 0;
  }
  float light = 1;
  for (const Crown& crown : crowns_) light *= through_crown(point, direction, crown.center, crown.radius);
  return light;
}

float Shade::at(const glm::vec3& point) const {
  constexpr float kDisc = 0.012F;  // a sun a little larger than ours: softens the steps between vertices
  constexpr std::array<glm::vec3, 4> kOffsets{
      {{kDisc, 0, kDisc}, {-kDisc, 0, kDisc}, {kDisc, 0, -kDisc}, {-kDisc, 0, -kDisc}}};
  float sum = 0;
  for (const glm::vec3& offset : kOffsets) sum += lit(point, glm::normalize(to_sun() + offset));
  return kShade + (1 - kShade) * sum / static_cast<float>(kOffsets.size());
}

}  // namespace quadrille::scenes::courtyard
