/// Worlds that float32 cannot hold around the eye, brought to where it can.
///
/// A vertex shader multiplies in float32. In a world of 10^30 metres the squares of its lengths overflow, in
/// one of 10^-30 they vanish, and 10^7 metres from the origin a position is good to a metre. A driver cannot
/// help, but the program that records the frame can: it moves the origin to the eye and scales the world by a
/// power of two, in double, before anything is rounded. Pictures of worlds within range do not change, since
/// those are left alone.
#pragma once

#include <optional>

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"
#include "scenes/view/camera.h"

namespace quadrille::scenes {

/// x' = (x - origin) * scale.
struct WorldRange {
  glm::vec3 origin{0};
  double scale = 1;  ///< a power of two
};

/// How the world has to be moved for this view; nothing when it is within range: the half diagonal of its box
/// in 2^-20 .. 2^40 metres, and its origin no more than 1024 times as far from the eye as what the eye sees
/// nearest (0.06 pixels of jitter at 1000 pixels). Throws as `make_view` does.
[[nodiscard]] std::optional<WorldRange> needed_range(const PlacedScene& scene, const SceneOptions& options);
/// The same for the view that the options ask for.
[[nodiscard]] std::optional<WorldRange> needed_range(const PlacedScene& scene, const View& view);
/// A scene's placements in the new world: instances, lights (with the intensity that keeps their light the
/// same) and cameras.
[[nodiscard]] Placements moved(Placements placements, const WorldRange& range);
/// The camera that options ask for, in the new world.
[[nodiscard]] SceneOptions moved(SceneOptions options, const WorldRange& range);

}  // namespace quadrille::scenes
