/// How much of a scene's light makes the picture: files state it in lux and candela, from candles to the sun.
///
/// Exposure is a factor of all light that the file brings, and of what its materials emit. The sky that fills
/// the shadows beside lights of the file is ours, in terms of the picture, and stays; where the file has no
/// lights, our own light and sky take the factor.
#pragma once

#include <limits>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"

namespace quadrille::scenes {

/// Illuminance that a white wall answers with almost white, at exposure 1 beside the default sky. [G: leaves
/// room for a highlight]
inline constexpr float kKeyLux = 2.4F;

/// The factor that `options` ask for. Chosen: `kKeyLux` over the median of what the lights bring to the
/// middles of the scene's instances, shadows aside; 1 where no light of the file reaches any.
[[nodiscard]] float exposure(const PlacedScene& scene, const SceneOptions& options);

/// A colour times an exposure; finite.
[[nodiscard]] inline glm::vec3 exposed(const glm::vec3& color, float exposure) {
  return exposure == 1 ? color : glm::min(color * exposure, glm::vec3(std::numeric_limits<float>::max()));
}

}  // namespace quadrille::scenes
