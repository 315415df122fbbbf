/// The scenes that this project makes itself: geometry and textures by code, no files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/passes/passes.h"

namespace quadrille::scenes {

struct BuiltinScene {
  std::string_view name;         ///< without the `builtin:`
  std::string_view description;  ///< one line
};
[[nodiscard]] const std::vector<BuiltinScene>& builtin_scenes();
/// "; did you mean 'builtin:quad'?" for a name that is none, to go on with after what is wrong; empty when
/// none is near.
[[nodiscard]] std::string meant_builtin(std::string_view name);

/// Builds the scene `name` (without `builtin:`) as it is at `time`, in seconds. Throws `UserError` that lists
/// the legal names.
[[nodiscard]] SceneData build_builtin(const std::string& name, double time = 0);
/// Seconds that its animation takes; 0: nothing moves. Throws as `build_builtin`.
[[nodiscard]] double builtin_length(const std::string& name);

/// What records its frames where they have passes of their own; null: a recorder of scenes does. Throws as
/// `build_builtin`.
[[nodiscard]] RecordPasses builtin_passes(const std::string& name);

// One function a scene; the descriptions are in builtin.cpp.
[[nodiscard]] SceneData build_triangle();
[[nodiscard]] SceneData build_quad();
[[nodiscard]] SceneData build_cubes();
[[nodiscard]] SceneData build_outlines();
[[nodiscard]] SceneData build_overdraw();
[[nodiscard]] SceneData build_glass();
[[nodiscard]] SceneData build_fill();
[[nodiscard]] SceneData build_cycle();
[[nodiscard]] SceneData build_materials();
[[nodiscard]] SceneData build_primitives();
[[nodiscard]] SceneData build_courtyard();
[[nodiscard]] SceneData build_rotunda();
/// A camera and a background: the card of blending is drawn by passes of its own.
[[nodiscard]] SceneData build_blends();
[[nodiscard]] SceneData build_flag(double time);
inline constexpr double kFlagSeconds = 2;

}  // namespace quadrille::scenes
