#include "scenes/view/exposure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include "scenes/data/environment_map.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMostPlaces = 4096;  // of instances that are asked what light they get

double luminance(const glm::vec3& color) {
  return glm::dot(glm::dvec3(color), glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// Lux at a place, of a light that is held at least half the size of what is lit away: the middle of a room
/// may lie in its lamp.
double illuminance(const Light& light, const Bounds& box) {
  const double strength = luminance(light.color);
  if (light.kind == Light::Kind::kDirectional) return strength;
  const glm::dvec3 way = glm::dvec3(box.center()) - light.position;
  const double far = glm::length(way),
               distance = std::max(far, 0.25 * glm::length(glm::dvec3(box.high) - glm::dvec3(box.low)));
  const bool outside =
      light.kind == Light::Kind::kSpot && far > 0 &&
      glm::dot(way, glm::dvec3(light.direction)) < far * std::cos(static_cast<double>(light.outer_cone));
  const double within = light.range > 0 ? distance / static_cast<double>(light.range) : 0;
  return outside || !(distance > 0)
             ? 0
             : strength * std::max(0.0, 1 - within * within * within * within) / (distance * distance);
}

/// Lux on a surface that faces any way, in the mean, and of the sun on one that faces it.
double illuminance(const EnvironmentMap* map) {
  if (map == nullptr) return 0;
  return std::numbers::pi * luminance(map->irradiance[0]) + (map->sun ? luminance(map->sun->color) : 0);
}

double median_lux(const PlacedScene& scene) {
  std::vector<double> lux;
  const double around = illuminance(scene.data.environment.map.get());
  for (const Instance& instance : scene.at.instances) {
    scene.visit_boxes(instance, [&](const Bounds& box) {
      if (box.empty() || lux.size() == kMostPlaces) return;
      double sum = around;
      for (const Light& light : scene.at.lights) sum += illuminance(light, box);
      if (std::isfinite(sum) && sum > 0) lux.push_back(sum);
    });
    if (lux.size() == kMostPlaces) break;
  }
  if (lux.empty()) return static_cast<double>(kKeyLux);
  const auto middle = lux.begin() + static_cast<std::ptrdiff_t>(lux.size() / 2);
  std::ranges::nth_element(lux, middle);
  return *middle;
}

}  // namespace

float exposure(const PlacedScene& scene, const SceneOptions& options) {
  const double factor =
      options.exposure ? *options.exposure : static_cast<double>(kKeyLux) / median_lux(scene);
  return static_cast<float>(std::clamp(factor, kLeastExposure, kMostExposure));
}

}  // namespace quadrille::scenes
