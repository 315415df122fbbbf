/// The scenes that this project makes itself: geometry and textures by code, no files.
#pragma once

#include <string>

#include "scenes/scene_data.h"

namespace quadrille::scenes {

/// Builds the scene `name` (without `builtin:`). Throws `UserError` that lists the legal names.
[[nodiscard]] SceneData build_builtin(const std::string& name);

// One function a scene; the descriptions are in builtin.cpp.
[[nodiscard]] SceneData build_triangle();
[[nodiscard]] SceneData build_quad();
[[nodiscard]] SceneData build_cubes();
[[nodiscard]] SceneData build_overdraw();
[[nodiscard]] SceneData build_fill();
[[nodiscard]] SceneData build_materials();
[[nodiscard]] SceneData build_courtyard();

}  // namespace quadrille::scenes
