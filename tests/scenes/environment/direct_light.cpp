#include "tests/scenes/environment/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace quadrille::tests {
namespace {

constexpr int kRings = 96, kSpokes = 128;

/// Smith's Lambda. [P: Heitz 2014, equation 72]
double hidden(double alpha, double cosine) {
  const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

}  // namespace

// Over half vectors h: the tangent of their angle is alpha sqrt(u / (1 - u)), which spreads rings of the lobe
// evenly over u; dl = 4 (v h) dh, and D (n h) dh = du dphi / 2 pi.
glm::dvec3 reflected(const scenes::RadianceCube& around, const glm::dvec3& n, const glm::dvec3& v,
                     double roughness) {
  const double alpha = roughness * roughness, n_dot_v = glm::dot(n, v);
  const glm::dvec3 side =
      glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1)));
  const glm::dvec3 other = glm::cross(n, side);
  glm::dvec3 sum(0);
  for (int ring = 0; ring < kRings; ++ring) {
    const double u = (ring + 0.5) / kRings, polar = std::atan(alpha * std::sqrt(u / (1 - u)));
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double turn = 2 * std::numbers::pi * (spoke + 0.5) / kSpokes;
      const glm::dvec3 h =
          std::cos(polar) * n + std::sin(polar) * (std::cos(turn) * side + std::sin(turn) * other);
      const double v_dot_h = glm::dot(v, h);
      const glm::dvec3 l = 2 * v_dot_h * h - v;
      const double n_dot_l = glm::dot(n, l);
      if (v_dot_h <= 0 || n_dot_l <= 0) continue;
      const double shown = 1 / (1 + hidden(alpha, n_dot_v) + hidden(alpha, n_dot_l));
      sum += around.sample(l) * (shown * v_dot_h / (n_dot_v * std::cos(polar)));
    }
  }
  return sum / static_cast<double>(kRings * kSpokes);
}

glm::dvec3 scattered(const scenes::RadianceCube& around, const glm::dvec3& n) {
  glm::dvec3 sum(0);
  double whole = 0;
  for (int face = 0; face < 6; ++face) {
    for (std::uint32_t row = 0; row < around.size; ++row) {
      for (std::uint32_t column = 0; column < around.size; ++column) {
        const double cosine = glm::dot(n, glm::normalize(around.direction(face, column, row)));
        const double weight = around.weight(column, row);
        whole += weight;
        sum += std::max(cosine, 0.0) * weight * glm::dvec3(around.at(face, column, row));
      }
    }
  }
  return 4.0 * sum / whole;
}

std::vector<glm::dvec3> directions(int count) {
  std::vector<glm::dvec3> result;
  for (int i = 0; i < count; ++i) {
    const double height = 1 - (2.0 * i + 1) / count, radius = std::sqrt(1 - height * height);
    const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    result.emplace_back(radius * std::cos(turn), height, radius * std::sin(turn));
  }
  return result;
}

}  // namespace quadrille::tests
