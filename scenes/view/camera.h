/// Where the picture is taken from: a camera of the file, one of the user's, or one that frames the scene.
#pragma once

#include <cstdint>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"

namespace quadrille::scenes {

/// World space to Vulkan's clip space (y down, 0 <= z <= w), and what shading needs of the camera.
struct View {
  glm::mat4 view_projection{1};
  glm::vec3 eye{0};  ///< world space
  glm::vec3 right{1, 0, 0}, up{0, 1, 0};
  glm::vec3 toward_viewer{0, 0, 1};  ///< unit vector against the view direction
  bool orthographic = false;
};

/// The camera that `options` asks for. The vertical extent is the camera's, the horizontal one follows the
/// output's aspect ratio. Throws `UserError` when the scene has no such camera, or eye and point looked at
/// coincide.
[[nodiscard]] View make_view(const PlacedScene& scene, const SceneOptions& options);

/// A perspective camera, 45 degrees high, right of, above and before the scene, which takes 80 % of the
/// picture's height or width, whichever it fills first, in its middle (scenes/view/scene_reach.h).
/// `orbit`: carried around the scene's centre by this part of a turn, as far away as all parts of the turn
/// need.
[[nodiscard]] View framing_view(const PlacedScene& scene, double aspect,
                                std::optional<double> orbit = std::nullopt);

}  // namespace quadrille::scenes
