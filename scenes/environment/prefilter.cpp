#include "scenes/environment/prefilter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "scenes/data/parallel.h"
#include "scenes/environment/half.h"
#include "scenes/environment/lobe.h"

namespace quadrille::scenes {
namespace {

/// A direction around the normal (z) in which light comes in.
struct Ray {
  glm::dvec3 direction;
  double weight = 0, level = 0;  ///< the level whose texels are as large as the ray is alone
};

/// Fewer where the lobe is narrow and texels are many.
std::uint32_t ray_count(std::uint32_t side) { return std::clamp(16384 / side, 64U, 1024U); }

std::vector<Ray> lobe_rays(double roughness, std::uint32_t count, std::uint32_t source_side) {
  const double alpha = roughness * roughness,
               texel = 4 * std::numbers::pi / (6.0 * source_side * source_side);
  std::vector<Ray> rays;
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 h = half_vector(alpha, even_point(i, count));
    const glm::dvec3 l = 2 * h.z * h - glm::dvec3(0, 0, 1);
    if (l.z <= 0) continue;
    // [P: Krivanek and Colbert 2008]
    const double angle = 4 / (count * half_vector_density(alpha, h.z));
    rays.push_back({l, l.z, 0.5 * std::log2(angle / texel) + 0.5});
    sum += l.z;
  }
  for (Ray& ray : rays) ray.weight /= sum;
  return rays;
}

/// The polynomials of `EnvironmentMap::irradiance`.
std::array<double, 9> harmonics(const glm::dvec3& d) {
  return {1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
}

}  // namespace

RadianceCube blurred(const CubeChain& chain, std::uint32_t side, double roughness) {
  const std::vector<Ray> rays = lobe_rays(roughness, ray_count(side), chain.finest().size);
  RadianceCube cube(side);
  parallel_for(std::size_t{6} * side, [&](std::size_t line) {
    const int face = static_cast<int>(line / side);
    const auto row = static_cast<std::uint32_t>(line % side);
    for (std::uint32_t column = 0; column < side; ++column) {
      const glm::dvec3 n = glm::normalize(cube.direction(face, column, row));
      const glm::dvec3 up = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
      const glm::dvec3 across = glm::normalize(glm::cross(up, n)), along = glm::cross(n, across);
      glm::dvec3 sum(0);
      for (const Ray& ray : rays)
        sum +=
            ray.weight *
            chain.sample(ray.direction.x * across + ray.direction.y * along + ray.direction.z * n, ray.level);
      cube.at(face, column, row) = glm::vec3(sum);
    }
  });
  return cube;
}

// Convolved with the cosine: bands of degree 0, 1, 2 times 1, 2/3, 1/4; and the squares of the harmonics'
// constants. [P: Ramamoorthi and Hanrahan 2001]
std::array<glm::vec3, 9> diffuse_coefficients(const RadianceCube& cube) {
  constexpr std::array<double, 9> kFactors{1.0,       2.0 / 3 * 3, 2.0 / 3 * 3, 2.0 / 3 * 3, 0.25 * 15,
                                           0.25 * 15, 0.25 * 1.25, 0.25 * 15,   0.25 * 3.75};
  std::array<glm::dvec3, 9> sums{};
  double whole = 0;
  for (int face = 0; face < 6; ++face) {
    for (std::uint32_t row = 0; row < cube.size; ++row) {
      for (std::uint32_t column = 0; column < cube.size; ++column) {
        const double weight = cube.weight(column, row);
        const std::array<double, 9> values = harmonics(glm::normalize(cube.direction(face, column, row)));
        const glm::dvec3 light = weight * glm::dvec3(cube.at(face, column, row));
        for (std::size_t i = 0; i < 9; ++i) sums[i] += values[i] * light;
        whole += weight;
      }
    }
  }
  std::array<glm::vec3, 9> result{};
  for (std::size_t i = 0; i < 9; ++i) result[i] = glm::vec3(sums[i] * (kFactors[i] / whole));
  return result;
}

glm::vec3 diffuse_radiance(const std::array<glm::vec3, 9>& coefficients, const glm::vec3& n) {
  const std::array<double, 9> values = harmonics(glm::dvec3(n));
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < 9; ++i) sum += values[i] * glm::dvec3(coefficients[i]);
  return glm::max(glm::vec3(sum), glm::vec3(0));
}

void pack_levels(EnvironmentMap& map, const std::vector<RadianceCube>& levels) {
  constexpr double kBrightest = 32768;
  double brightest = 0;
  for (const RadianceCube& level : levels) {
    for (const glm::vec3& texel : level.texels)
      brightest = std::max({brightest, static_cast<double>(texel.r), static_cast<double>(texel.g),
                            static_cast<double>(texel.b)});
  }
  double scale = 1;
  while (brightest / scale > kBrightest) scale *= 2;
  map.scale = static_cast<float>(scale);
  map.size = levels.front().size;
  map.levels = static_cast<std::uint32_t>(levels.size());
  map.texels.clear();
  for (const RadianceCube& level : levels) {
    for (const glm::vec3& texel : level.texels) {
      for (int i = 0; i < 3; ++i) append_half(map.texels, static_cast<double>(texel[i]) / scale);
      append_half(map.texels, 1);
    }
  }
}

EnvironmentMap prefiltered(const std::string& name, RadianceCube radiance) {
  EnvironmentMap map;
  map.name = name;
  map.irradiance = diffuse_coefficients(radiance);
  const CubeChain chain(std::move(radiance));
  const std::uint32_t last = [&] {
    std::uint32_t count = 0;
    while (chain.finest().size >> count > kCoarsestSide) ++count;
    return count;
  }();
  std::vector<RadianceCube> levels{chain.finest()};
  for (std::uint32_t level = 1; level <= last; ++level)
    levels.push_back(blurred(chain, chain.finest().size >> level, static_cast<double>(level) / last));
  pack_levels(map, levels);
  return map;
}

}  // namespace quadrille::scenes
