/// A clear sky that the program makes, with its sun. [P: Preetham 1999]
#pragma once

#include "scenes/data/environment_map.h"
#include "scenes/environment/radiance_cube.h"

namespace quadrille::scenes {

/// Where the sun stands, in degrees.
struct SunPlace {
  double elevation = 35;  ///< above the horizon, 1..90
  double azimuth = -40;   ///< from +z, which faces the front of a scene, towards +x; -360..360
};

/// Illuminance of level ground, by the sun and the sky together, whatever the sun's height: a white floor is
/// almost white at exposure 1.
inline constexpr double kSkyLux = 3;

struct Sky {
  RadianceCube radiance;  ///< without the sun's disc; below the horizon, ground that the two light
  Light sun;
};
[[nodiscard]] Sky clear_sky(const SunPlace& place, std::uint32_t side);

}  // namespace quadrille::scenes
