#include "scenes/environment/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace quadrille::scenes {
namespace {

constexpr double kTurbidity = 3;  // [G: a clear day]
// what the ground gives back, as of the sky of two colours
const glm::dvec3 kGround{0.20, 0.18, 0.16};
// micrometres, of what sRGB's primaries look like [G]
constexpr std::array<double, 3> kWaves{0.61, 0.55, 0.465};
// lux of the sun above the air over 1000, the unit of Preetham's luminances [G: 128 klx]
constexpr double kSunAboveAir = 128;

/// Perez' function, with the five coefficients of one of Y, x and y.
struct Perez {
  double a, b, c, d, e;
  [[nodiscard]] double at(double cosine, double angle) const {
    const double near = std::cos(angle);
    return (1 + a * std::exp(b / cosine)) * (1 + c * std::exp(d * angle) + e * near * near);
  }
};

constexpr Perez linear_in_turbidity(const std::array<double, 10>& k) {
  return {k[0] * kTurbidity + k[1], k[2] * kTurbidity + k[3], k[4] * kTurbidity + k[5],
          k[6] * kTurbidity + k[7], k[8] * kTurbidity + k[9]};
}
// [P: Preetham 1999, appendix A.2]
constexpr Perez kLuminance = linear_in_turbidity(
    {0.1787, -1.4630, -0.3554, 0.4275, -0.0227, 5.3251, 0.1206, -2.5771, -0.0670, 0.3703});
constexpr Perez kX = linear_in_turbidity(
    {-0.0193, -0.2592, -0.0665, 0.0008, -0.0004, 0.2125, -0.0641, -0.8989, -0.0033, 0.0452});
constexpr Perez kY = linear_in_turbidity(
    {-0.0167, -0.2608, -0.0950, 0.0092, -0.0079, 0.2102, -0.0441, -1.6537, -0.0109, 0.0529});

/// Chromaticity of the zenith: cubic in the sun's angle from it, quadratic in the turbidity.
double zenith(const std::array<std::array<double, 4>, 3>& k, double angle) {
  double sum = 0, power = kTurbidity * kTurbidity;
  for (const auto& row : k) {
    sum += power * (((row[0] * angle + row[1]) * angle + row[2]) * angle + row[3]);
    power /= kTurbidity;
  }
  return sum;
}
constexpr std::array<std::array<double, 4>, 3> kZenithX{{{0.00166, -0.00375, 0.00209, 0},
                                                         {-0.02903, 0.06377, -0.03202, 0.00394},
                                                         {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr std::array<std::array<double, 4>, 3> kZenithY{{{0.00275, -0.00610, 0.00317, 0},
                                                         {-0.04214, 0.08970, -0.04153, 0.00516},
                                                         {0.15346, -0.26756, 0.06670, 0.26688}}};

/// Thousands of candela a square metre.
double zenith_luminance(double angle) {
  const double chi = (4.0 / 9 - kTurbidity / 120) * (std::numbers::pi - 2 * angle);
  return std::max(0.0, (4.0453 * kTurbidity - 4.9710) * std::tan(chi) - 0.2155 * kTurbidity + 2.4192);
}

/// CIE Y, x and y to linear sRGB. [IEC 61966-2-1]
glm::dvec3 color_of(double luminance, double x, double y) {
  const double big_x = x / y * luminance, big_z = (1 - x - y) / y * luminance;
  return glm::max(glm::dvec3(3.2406 * big_x - 1.5372 * luminance - 0.4986 * big_z,
                             -0.9689 * big_x + 1.8758 * luminance + 0.0415 * big_z,
                             0.0557 * big_x - 0.2040 * luminance + 1.0570 * big_z),
                  glm::dvec3(0));
}

class ClearSky {
 public:
  explicit ClearSky(const glm::dvec3& sun)
      : sun_(sun),
        angle_(std::acos(std::clamp(sun.y, 0.0, 1.0))),
        x_(zenith(kZenithX, angle_) / kX.at(1, angle_)),
        y_(zenith(kZenithY, angle_) / kY.at(1, angle_)),
        luminance_(zenith_luminance(angle_) / kLuminance.at(1, angle_)) {}
  /// Thousands of candela a square metre, of a unit direction above the horizon.
  [[nodiscard]] glm::dvec3 at(const glm::dvec3& d) const {
    const double cosine = std::max(d.y, 0.01), angle = std::acos(std::clamp(glm::dot(d, sun_), -1.0, 1.0));
    return color_of(luminance_ * kLuminance.at(cosine, angle), x_ * kX.at(cosine, angle),
                    y_ * kY.at(cosine, angle));
  }
  /// Thousands of lux at normal incidence, through molecules and haze. [P: Preetham 1999, appendix A.1]
  [[nodiscard]] glm::dvec3 sun() const {
    const double degrees = angle_ * 180 / std::numbers::pi;
    const double mass = 1 / (std::cos(angle_) + 0.15 * std::pow(93.885 - degrees, -1.253));
    const double haze = 0.04608 * kTurbidity - 0.04586;
    glm::dvec3 light;
    for (int i = 0; i < 3; ++i) {
      const double wave = kWaves[static_cast<std::size_t>(i)];
      light[i] =
          kSunAboveAir * std::exp(-mass * (0.008735 * std::pow(wave, -4.08) + haze * std::pow(wave, -1.3)));
    }
    return light;
  }

 private:
  glm::dvec3 sun_;
  double angle_;  ///< of the sun, from the zenith
  double x_, y_, luminance_;
};

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

/// What falls on level ground from the upper half of the cube.
glm::dvec3 illuminance(const RadianceCube& cube) {
  glm::dvec3 sum(0);
  double whole = 0;
  for (int face = 0; face < 6; ++face) {
    for (std::uint32_t row = 0; row < cube.size; ++row) {
      for (std::uint32_t column = 0; column < cube.size; ++column) {
        const double up = glm::normalize(cube.direction(face, column, row)).y;
        sum += std::max(up, 0.0) * cube.weight(column, row) * glm::dvec3(cube.at(face, column, row));
        whole += cube.weight(column, row);
      }
    }
  }
  return sum * (4 * std::numbers::pi / whole);
}

}  // namespace

Sky clear_sky(const SunPlace& place, std::uint32_t side) {
  const double up = place.elevation * std::numbers::pi / 180, around = place.azimuth * std::numbers::pi / 180;
  const glm::dvec3 way(std::sin(around) * std::cos(up), std::sin(up), std::cos(around) * std::cos(up));
  const ClearSky sky(way);
  RadianceCube cube(side);
  const auto fill = [&](const auto& radiance) {
    for (int face = 0; face < 6; ++face) {
      for (std::uint32_t row = 0; row < side; ++row) {
        for (std::uint32_t column = 0; column < side; ++column)
          cube.at(face, column, row) =
              radiance(glm::normalize(cube.direction(face, column, row)), cube.at(face, column, row));
      }
    }
  };
  fill([&](const glm::dvec3& d, const glm::vec3&) { return d.y > 0 ? glm::vec3(sky.at(d)) : glm::vec3(0); });
  const glm::dvec3 of_sun = sky.sun(), on_ground = illuminance(cube) + of_sun * way.y;
  const double scale = kSkyLux / luminance(on_ground);
  const glm::dvec3 ground = kGround * on_ground * std::numbers::inv_pi;
  fill([&](const glm::dvec3& d, const glm::vec3& above) {
    return d.y > 0 ? glm::vec3(glm::dvec3(above) * scale) : glm::vec3(ground * scale);
  });
  Light sun;
  sun.color = glm::vec3(of_sun * scale);
  sun.direction = glm::vec3(-way);
  return {std::move(cube), sun};
}

}  // namespace quadrille::scenes
