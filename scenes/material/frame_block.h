/// The uniform block that all draws of a frame share: camera, sky and lights (`Frame` in
/// scenes/material/shaders/interface.glsl).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenes/data/environment_map.h"
#include "scenes/data/scene_data.h"
#include "scenes/view/camera.h"

namespace quadrille::scenes {

/// The lights of the scene in the shader's order (directional, point, spot), or the default key light when
/// there are none, times the exposure (scenes/view/exposure.h). At most 256. Throws `UserError` beyond that.
/// With a map of the environment there is its sun instead of the key light, beside the scene's own.
[[nodiscard]] std::vector<Light> frame_lights(const PlacedScene& scene, const View& view, float exposure,
                                              const EnvironmentMap* map = nullptr);
/// What a picture of depths makes white and what black, window depths.
struct DepthRange {
  float nearest = 0, farthest = 1;
};
/// The block's bytes, std140. `depths` is for pictures of depths.
[[nodiscard]] std::vector<std::byte> frame_block(const SceneData& scene, const View& view,
                                                 const std::vector<Light>& lights, float exposure,
                                                 const std::optional<DepthRange>& depths = std::nullopt);
/// What the fragment shader is compiled for: numbers of lights by kind, loop unrolling, projection.
[[nodiscard]] std::vector<std::string> frame_defines(const View& view, const std::vector<Light>& lights,
                                                     const EnvironmentMap* map = nullptr);
/// `Environment` of scenes/material/shaders/environment.glsl, std140.
[[nodiscard]] std::vector<std::byte> environment_block(const EnvironmentMap& map, const View& view,
                                                       float exposure);

}  // namespace quadrille::scenes
