#include "scenes/view/world_range.h"

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

namespace quadrille::scenes {
namespace {

constexpr int kLeastExponent = -20, kMostExponent = 40;
constexpr double kFarFromOrigin = 1024;

/// Half the diagonal, in double: the squares of float32 may overflow.
double radius(const Bounds& box) { return 0.5 * glm::length(glm::dvec3(box.high) - glm::dvec3(box.low)); }

/// About how far away the nearest thing is that the eye may look at: over instances and their copies, the
/// distance of its middle and its own size.
double nearest_reach(const PlacedScene& scene, const glm::dvec3& eye) {
  double reach = INFINITY;
  for (const Instance& instance : scene.at.instances) {
    scene.visit_boxes(instance, [&](const Bounds& box) {
      if (!box.empty()) reach = std::min(reach, glm::length(glm::dvec3(box.center()) - eye) + radius(box));
    });
  }
  return reach;
}

glm::dvec3 moved_point(const glm::dvec3& p, const WorldRange& range) {
  return (p - glm::dvec3(range.origin)) * range.scale;
}

glm::dmat4 moved_matrix(const glm::dmat4& matrix, const WorldRange& range, double axes) {
  glm::dmat4 out = matrix;
  for (int c = 0; c < 3; ++c) out[c] = glm::dvec4(glm::dvec3(matrix[c]) * axes, matrix[c].w);
  out[3] = glm::dvec4(moved_point(glm::dvec3(matrix[3]), range), matrix[3].w);
  return out;
}

}  // namespace

std::optional<WorldRange> needed_range(const PlacedScene& scene, const SceneOptions& options) {
  return needed_range(scene, make_view(scene, options));
}

std::optional<WorldRange> needed_range(const PlacedScene& scene, const View& view) {
  const Bounds box = scene.bounds();
  if (box.empty()) return std::nullopt;
  const double size = radius(box);
  if (!std::isfinite(size) || !(size > 0)) return std::nullopt;
  const glm::dvec3 eye(view.eye);
  WorldRange range;
  const int exponent = std::ilogb(size);
  if (exponent < kLeastExponent || exponent > kMostExponent) range.scale = std::ldexp(1.0, -exponent);
  if (glm::length(eye) > kFarFromOrigin * nearest_reach(scene, eye)) range.origin = view.eye;
  if (range.scale == 1 && range.origin == glm::vec3(0)) return std::nullopt;
  return range;
}

Placements moved(Placements placements, const WorldRange& range) {
  for (Instance& instance : placements.instances)
    instance.world = moved_matrix(instance.world, range, range.scale);
  for (std::vector<glm::dmat4>& copies : placements.copies) {
    for (glm::dmat4& copy : copies) copy = moved_matrix(copy, range, range.scale);
  }
  for (Bounds& box : placements.extent) {
    if (!box.empty())
      box = {glm::vec3(moved_point(glm::dvec3(box.low), range)),
             glm::vec3(moved_point(glm::dvec3(box.high), range))};
  }
  for (Light& light : placements.lights) {
    if (light.kind == Light::Kind::kDirectional) continue;
    light.position = moved_point(light.position, range);
    light.range = static_cast<float>(static_cast<double>(light.range) * range.scale);
    // it falls with the square of the distance
    light.color = glm::vec3(glm::dvec3(light.color) * (range.scale * range.scale));
  }
  for (Camera& camera : placements.cameras) {
    if (camera.pose) camera.pose = moved_matrix(*camera.pose, range, 1);
    camera.near *= range.scale;
    if (camera.far) *camera.far *= range.scale;
    camera.half_height *= range.scale;
  }
  return placements;
}

SceneOptions moved(SceneOptions options, const WorldRange& range) {
  if (options.eye) options.eye = glm::vec3(moved_point(glm::dvec3(*options.eye), range));
  if (options.at) options.at = glm::vec3(moved_point(glm::dvec3(*options.at), range));
  return options;
}

}  // namespace quadrille::scenes
