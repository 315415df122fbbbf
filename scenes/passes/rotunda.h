/// The stage of the frames of several passes: a floor with a ring of columns around a pedestal, steps, balls
/// and rings, each vertex with its colour.
#pragma once

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

inline constexpr float kRotundaRadius = 4.2F;  ///< metres, of the ring of columns

[[nodiscard]] SceneData build_rotunda();

}  // namespace quadrille::scenes
