#include "scenes/view/scene_reach.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMostParts = 4096;

const Array* positions_of(const SceneData& scene, const Primitive& primitive) {
  return primitive.attributes[0] < 0 ? nullptr
                                     : &scene.arrays[static_cast<std::size_t>(primitive.attributes[0])];
}

std::size_t copies_of(const PlacedScene& scene, const Instance& instance) {
  return instance.copies < 0 ? 1 : scene.at.copies[static_cast<std::size_t>(instance.copies)].size();
}

struct Extent {
  std::size_t draws = 0, points = 0;
};

Extent extent_of(const PlacedScene& scene) {
  Extent extent;
  for (const Instance& instance : scene.at.instances) {
    const Array* const positions = positions_of(scene.data, scene.data.primitives[instance.primitive]);
    const std::size_t copies = copies_of(scene, instance);
    extent.draws += copies;
    if (positions != nullptr) extent.points += positions->count * copies;
  }
  return extent;
}

Reaches reach_of(const Bounds& box, const Directions& directions) {
  Reaches reaches{};
  for (std::size_t d = 0; d < directions.size(); ++d)
    for (int c = 0; c < 3; ++c)
      reaches[d] += std::max(directions[d][c] * static_cast<double>(box.low[c]),
                             directions[d][c] * static_cast<double>(box.high[c]));
  return reaches;
}

/// The four directions stand side by side in a vector.
Reaches reach_of(const Array& points, const Directions& d) {
  const __m256d x = _mm256_setr_pd(d[0].x, d[1].x, d[2].x, d[3].x),
                y = _mm256_setr_pd(d[0].y, d[1].y, d[2].y, d[3].y),
                z = _mm256_setr_pd(d[0].z, d[1].z, d[2].z, d[3].z);
  __m256d most = _mm256_set1_pd(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.count; ++i) {
    std::array<float, 3> p;
    std::memcpy(p.data(), &points.data[i * sizeof(p)], sizeof(p));
    const auto times = [](const __m256d& along, float by) {
      return _mm256_mul_pd(along, _mm256_set1_pd(static_cast<double>(by)));
    };
    most = _mm256_max_pd(_mm256_add_pd(_mm256_add_pd(times(x, p[0]), times(y, p[1])), times(z, p[2])), most);
  }
  Reaches reaches;
  _mm256_storeu_pd(reaches.data(), most);
  return reaches;
}

}  // namespace

SceneReach::SceneReach(const PlacedScene& scene, const glm::dvec3& origin, std::size_t most_points)
    : scene_(scene), origin_(origin) {
  const Extent extent = extent_of(scene);
  if (!scene.at.extent.empty()) {
    for (const Bounds& box : scene.at.extent) add_box(box);
  } else if (extent.draws > kMostParts) {
    add_box(scene.bounds());
  } else {
    for (const Instance& instance : scene.at.instances) {
      if (instance.copies < 0) add(instance, instance.world, extent.points <= most_points);
      else
        for (const glm::dmat4& copy : scene.at.copies[static_cast<std::size_t>(instance.copies)])
          add(instance, copy, extent.points <= most_points);
    }
  }
}

void SceneReach::add(const Instance& instance, const glm::dmat4& world, bool by_vertex) {
  const Array* const positions = positions_of(scene_.data, scene_.data.primitives[instance.primitive]);
  if (instance.pose < 0 && by_vertex && positions != nullptr) {
    parts_.push_back({world, positions, {}});
    return;
  }
  scene_.data.visit_model_boxes(instance, [&](const Bounds& box, const glm::mat4& matrix) {
    add_box(box, world * glm::dmat4(matrix));
  });
}

void SceneReach::add_box(const Bounds& box, const glm::dmat4& world) {
  if (!box.empty()) parts_.push_back({world, nullptr, box});
}

/// Directions are turned into a part's space, once for all its points.
Reaches SceneReach::operator()(const Directions& directions) const {
  Reaches reaches;
  reaches.fill(-std::numeric_limits<double>::infinity());
  for (const Part& part : parts_) {
    const glm::dvec3 place = glm::dvec3(part.world[3]) - origin_;
    const glm::dmat3 back = glm::transpose(glm::dmat3(part.world));
    Directions own;
    for (std::size_t d = 0; d < directions.size(); ++d) own[d] = back * directions[d];
    const Reaches reach = part.points != nullptr ? reach_of(*part.points, own) : reach_of(part.box, own);
    for (std::size_t d = 0; d < directions.size(); ++d)
      reaches[d] = std::max(reaches[d], glm::dot(directions[d], place) + reach[d]);
  }
  return reaches;
}

}  // namespace quadrille::scenes
