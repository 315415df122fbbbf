/// Poses vertices on the host: for vertex shaders of the user's, and for what the materials' shader has no
/// room for.
#pragma once

#include <array>
#include <optional>

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

/// The attributes of a primitive that a pose changes, in model space: morphed, then, if `skinned`, moved by
/// the joints. Float streams, computed in double and rounded once; normals and tangents of a skin are of unit
/// length. Attributes that stay as they are have no value.
[[nodiscard]] std::array<std::optional<Array>, kSemantics> pose_on_host(const SceneData& scene,
                                                                        const Primitive& primitive,
                                                                        const Pose& pose, bool skinned);

}  // namespace quadrille::scenes
