#include "scenes/environment/lobe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scenes/environment/half.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint32_t kSamples = 1024;
constexpr double kLeastAlpha = 1e-4, kLeastCosine = 1e-3;

/// Of normals that are seen from `v`. [P: Heitz 2018]
glm::dvec3 visible_half_vector(const glm::dvec3& v, double alpha, const glm::dvec2& point) {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * v.x, alpha * v.y, v.z));
  const double flat = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::dvec3 across =
      flat > 0 ? glm::dvec3(-stretched.y, stretched.x, 0) / std::sqrt(flat) : glm::dvec3(1, 0, 0);
  const glm::dvec3 along = glm::cross(stretched, across);
  const double radius = std::sqrt(point.x), angle = 2 * std::numbers::pi * point.y;
  const double x = radius * std::cos(angle), share = 0.5 * (1 + stretched.z);
  const double y = (1 - share) * std::sqrt(std::max(0.0, 1 - x * x)) + share * radius * std::sin(angle);
  const glm::dvec3 h = x * across + y * along + std::sqrt(std::max(0.0, 1 - x * x - y * y)) * stretched;
  return glm::normalize(glm::dvec3(alpha * h.x, alpha * h.y, std::max(0.0, h.z)));
}

/// Smith's term of one direction, times twice its cosine.
double reach(double alpha, double cosine) {
  return cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine);
}

std::vector<std::byte> make_table() {
  std::vector<std::byte> table;
  table.reserve(std::size_t{4} * kLobeTableSide * kLobeTableSide);
  for (std::uint32_t row = 0; row < kLobeTableSide; ++row) {
    for (std::uint32_t column = 0; column < kLobeTableSide; ++column) {
      const glm::dvec2 albedo = lobe_albedo(row / (kLobeTableSide - 1.0), column / (kLobeTableSide - 1.0));
      for (const double value : {albedo.x, albedo.y}) append_half(table, value);
    }
  }
  return table;
}

}  // namespace

glm::dvec2 even_point(std::uint32_t i, std::uint32_t count) {
  std::uint32_t reversed = i;
  reversed = reversed << 16 | reversed >> 16;
  reversed = (reversed & 0x00ff00ffU) << 8 | (reversed & 0xff00ff00U) >> 8;
  reversed = (reversed & 0x0f0f0f0fU) << 4 | (reversed & 0xf0f0f0f0U) >> 4;
  reversed = (reversed & 0x33333333U) << 2 | (reversed & 0xccccccccU) >> 2;
  reversed = (reversed & 0x55555555U) << 1 | (reversed & 0xaaaaaaaaU) >> 1;
  return {(i + 0.5) / count, (reversed + 0.5) / 4294967296.0};
}

double half_vector_density(double alpha, double cosine) {
  const double a2 = alpha * alpha, d = cosine * cosine * (a2 - 1) + 1;
  return a2 / (std::numbers::pi * d * d);
}

glm::dvec3 half_vector(double alpha, const glm::dvec2& point) {
  const double angle = 2 * std::numbers::pi * point.y;
  const double cosine = std::sqrt((1 - point.x) / (1 + (alpha * alpha - 1) * point.x));
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

double visibility(double alpha, double n_dot_v, double n_dot_l) {
  const double a2 = alpha * alpha;
  return 0.5 / (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1 - a2) + a2) +
                n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1 - a2) + a2));
}

glm::dvec2 lobe_albedo(double roughness, double n_dot_v) {
  const double alpha = std::max(roughness * roughness, kLeastAlpha), cosine = std::max(n_dot_v, kLeastCosine);
  const glm::dvec3 v(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
  glm::dvec2 sum(0);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const glm::dvec3 h = visible_half_vector(v, alpha, even_point(i, kSamples));
    const double v_dot_h = glm::dot(v, h), n_dot_l = 2 * v_dot_h * h.z - v.z;
    if (n_dot_l <= 0 || v_dot_h <= 0) continue;
    // what is left of the lobe over the density of the samples
    const double share = 2 * visibility(alpha, v.z, n_dot_l) * n_dot_l * reach(alpha, v.z);
    const double k = 1 - v_dot_h, fresnel = k * k * k * k * k;
    sum += share * glm::dvec2(1 - fresnel, fresnel);
  }
  return sum / static_cast<double>(kSamples);
}

const std::vector<std::byte>& lobe_table() {
  static const std::vector<std::byte> table = make_table();
  return table;
}

}  // namespace quadrille::scenes
