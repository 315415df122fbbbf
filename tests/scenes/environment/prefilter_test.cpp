/// Maps of the environment against direct integration: docs/environment.md shows these errors.
#include "scenes/environment/prefilter.h"

#include <immintrin.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/environment/lobe.h"
#include "scenes/environment/sky.h"
#include "tests/scenes/environment/direct_light.h"

using namespace quadrille;
using namespace quadrille::scenes;
using quadrille::tests::directions;

namespace {

constexpr std::array kRoughness{0.1, 0.25, 0.4, 0.6, 0.8, 1.0};
constexpr std::array kAngles{0, 30, 60, 80};

/// A dim room with three bright windows of a sixth of the horizon each.
RadianceCube windows(std::uint32_t side) {
  RadianceCube cube(side);
  for (int face = 0; face < 6; ++face) {
    for (std::uint32_t row = 0; row < side; ++row) {
      for (std::uint32_t column = 0; column < side; ++column) {
        const glm::dvec3 d = glm::normalize(cube.direction(face, column, row));
        const bool glass = std::abs(d.y - 0.2) < 0.3 && std::sin(3 * std::atan2(d.z, d.x)) > 0;
        cube.at(face, column, row) = glass ? glm::vec3(4, 4.5F, 5) : glm::vec3(0.3F, 0.25F, 0.2F);
      }
    }
  }
  return cube;
}

/// The map's levels as a machine holds them.
std::vector<RadianceCube> levels_of(const EnvironmentMap& map) {
  std::vector<RadianceCube> levels;
  const std::byte* at = map.texels.data();
  for (std::uint32_t level = 0; level < map.levels; ++level) {
    RadianceCube cube(map.size >> level);
    for (glm::vec3& texel : cube.texels) {
      for (int i = 0; i < 4; ++i, at += 2) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, at, 2);
        if (i < 3) texel[i] = _cvtsh_ss(bits) * map.scale;
      }
    }
    levels.push_back(std::move(cube));
  }
  return levels;
}

/// As the shader looks it up (scenes/material/shaders/environment.glsl), for a white metal.
glm::dvec3 looked_up(const std::vector<RadianceCube>& levels, const glm::dvec3& n, const glm::dvec3& v,
                     double roughness) {
  const double level = roughness * static_cast<double>(levels.size() - 1);
  const auto finer = static_cast<std::size_t>(level);
  const std::size_t coarser = std::min(finer + 1, levels.size() - 1);
  const double smooth = 1 - roughness * roughness;
  const glm::dvec3 r =
      glm::mix(n, 2 * glm::dot(n, v) * n - v, smooth * (std::sqrt(smooth) + roughness * roughness));
  const glm::dvec2 lobe = lobe_albedo(roughness, glm::dot(n, v));
  return (lobe.x + lobe.y) *
         glm::mix(levels[finer].sample(r), levels[coarser].sample(r), level - static_cast<double>(finer));
}

/// Root of the mean square of the errors over that of the values.
struct Error {
  double difference = 0, value = 0;
  void add(const glm::dvec3& is, const glm::dvec3& should) {
    difference += glm::dot(is - should, is - should);
    value += glm::dot(should, should);
  }
  [[nodiscard]] double share() const { return std::sqrt(difference / value); }
};

struct Errors {
  std::array<std::array<double, kAngles.size()>, kRoughness.size()> mirror{};
  double diffuse = 0;
};

Errors measure(const RadianceCube& cube) {
  const EnvironmentMap map = prefiltered("measured", cube);
  const std::vector<RadianceCube> levels = levels_of(map);
  Errors errors;
  Error diffuse;
  for (const glm::dvec3& n : directions(40))
    diffuse.add(glm::dvec3(diffuse_radiance(map.irradiance, glm::vec3(n))), tests::scattered(cube, n));
  errors.diffuse = diffuse.share();
  for (std::size_t r = 0; r < kRoughness.size(); ++r) {
    for (std::size_t a = 0; a < kAngles.size(); ++a) {
      Error error;
      for (const glm::dvec3& n : directions(40)) {
        const glm::dvec3 side = glm::normalize(glm::cross(n, glm::dvec3(0.31, 0.2, 0.9)));
        const double angle = kAngles[a] * 3.14159265358979 / 180;
        const glm::dvec3 v = std::cos(angle) * n + std::sin(angle) * side;
        error.add(looked_up(levels, n, v, kRoughness[r]), tests::reflected(cube, n, v, kRoughness[r]));
      }
      errors.mirror[r][a] = error.share();
    }
  }
  return errors;
}

RadianceCube even(float radiance) {
  RadianceCube cube(32);
  std::ranges::fill(cube.texels, glm::vec3(radiance));
  return cube;
}

}  // namespace

TEST_CASE("environment: what is the same all around stays so at every level and for every normal") {
  const EnvironmentMap map = prefiltered("even", even(0.75F));
  REQUIRE(map.levels == 3);
  REQUIRE(map.texels.size() == 8 * 6 * (32 * 32 + 16 * 16 + 8 * 8));
  for (const RadianceCube& level : levels_of(map)) {
    for (const glm::vec3& texel : level.texels) REQUIRE(texel.g == Approx(0.75).epsilon(1e-3));
  }
  for (const glm::dvec3& n : directions(20))
    CHECK(diffuse_radiance(map.irradiance, glm::vec3(n)).r == Approx(0.75).epsilon(1e-4));
}

TEST_CASE("environment: radiance beyond 16-bit floats is scaled, not cut") {
  const EnvironmentMap map = prefiltered("bright", even(3e6F));
  CHECK(map.scale == 128);
  CHECK(levels_of(map).front().texels.front().r == Approx(3e6).epsilon(1e-3));
}

TEST_CASE("environment: the table of the lobe equals the lobe's integral") {
  const RadianceCube white = even(1);
  for (const double roughness : kRoughness) {
    for (const int angle : {0, 30, 60, 75}) {
      const double cosine = std::cos(angle * 3.14159265358979 / 180);
      const glm::dvec2 lobe = lobe_albedo(roughness, cosine);
      const glm::dvec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
      INFO(roughness << " at " << angle);
      CHECK(lobe.x + lobe.y == Approx(tests::reflected(white, {0, 0, 1}, v, roughness).r).margin(0.006));
    }
  }
  CHECK(lobe_albedo(0, 1).x + lobe_albedo(0, 1).y == Approx(1));
  CHECK(lobe_table().size() == 32 * 32 * 4);
}

TEST_CASE("environment: a direction finds its place on the cube again") {
  for (const glm::dvec3& d : directions(200)) {
    const FacePlace place = place_on_face(d);
    const glm::dvec3 back = glm::normalize(face_direction(place.face, place.right, place.down));
    CHECK(glm::length(back - d) < 1e-12);
  }
}

TEST_CASE("environment: a sky and a room of windows are reflected as direct integration says", "[slow]") {
  // The bounds are those of docs/environment.md: seen straight on, at 30, 60 and 80 degrees.
  constexpr std::array kSky{0.06, 0.06, 0.08, 0.18}, kRoom{0.16, 0.15, 0.14, 0.23};
  const Errors sky = measure(clear_sky({}, 128).radiance), room = measure(windows(128));
  for (std::size_t a = 0; a < kAngles.size(); ++a) {
    for (std::size_t r = 0; r < kRoughness.size(); ++r) {
      INFO("roughness " << kRoughness[r] << " at " << kAngles[a] << " degrees");
      CHECK(sky.mirror[r][a] < kSky[a]);
      CHECK(room.mirror[r][a] < kRoom[a]);
    }
  }
  CHECK(sky.diffuse < 0.02);
  CHECK(room.diffuse < 0.05);
}

TEST_CASE("environment: prints the table of its errors", "[.table]") {
  for (const auto& [name, cube] : {std::pair("a clear sky", clear_sky({}, 128).radiance),
                                   std::pair("a room of windows", windows(128))}) {
    const Errors errors = measure(cube);
    std::printf("| %s: roughness | 0 degrees | 30 | 60 | 80 |\n|---|---|---|---|---|\n", name);
    for (std::size_t r = 0; r < kRoughness.size(); ++r) {
      std::printf("| %.2f |", kRoughness[r]);
      for (const double error : errors.mirror[r]) std::printf(" %.1f %% |", 100 * error);
      std::printf("\n");
    }
    std::printf("| diffuse | %.1f %% | | | |\n\n", 100 * errors.diffuse);
  }
}
