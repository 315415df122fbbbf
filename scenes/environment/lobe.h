/// The specular lobe that maps and table are made for: Trowbridge and Reitz' distribution with Smith's
/// height-correlated shadowing [P: Heitz 2014]; the squared roughness is its width, as glTF asks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>

namespace quadrille::scenes {

/// Point `i` of `count` that are spread evenly over the unit square. [P: Hammersley 1960]
[[nodiscard]] glm::dvec2 even_point(std::uint32_t i, std::uint32_t count);
/// The distribution of half vectors around the normal (z), `cosine` from it.
[[nodiscard]] double half_vector_density(double alpha, double cosine);
/// Half vectors by that distribution times their cosine.
[[nodiscard]] glm::dvec3 half_vector(double alpha, const glm::dvec2& point);
/// Shadowing of both directions over four times the product of their cosines.
[[nodiscard]] double visibility(double alpha, double n_dot_v, double n_dot_l);

/// What the lobe reflects of white surroundings: x times the reflectance at normal incidence plus y times
/// that at grazing angles, by Schlick's approximation of Fresnel. [P: Karis 2013]
[[nodiscard]] glm::dvec2 lobe_albedo(double roughness, double n_dot_v);

inline constexpr std::uint32_t kLobeTableSide = 32;
/// `lobe_albedo` as R16G16_SFLOAT, n_dot_v growing from left to right and roughness from top to bottom, from
/// 0 in the middle of the first texel to 1 in the middle of the last. Computed once.
[[nodiscard]] const std::vector<std::byte>& lobe_table();

}  // namespace quadrille::scenes
