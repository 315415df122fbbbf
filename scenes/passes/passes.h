/// Built-in frames of several passes. Each takes a scene, whose vertices have normals and colours, and gives
/// all of its commands. What it draws with is its own, so a choice of shaders or of another picture is
/// refused: throws `UserError`.
#pragma once

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

using RecordPasses = traces::CommandStream (*)(const SceneData&, const SceneOptions&);

/// Depths as the sun sees them; the lit scene, in floats; a pass that maps its tones and lets what is bright
/// glare.
[[nodiscard]] traces::CommandStream record_shadow(const SceneData& scene, const SceneOptions& options);
/// Surfaces alone (colours, normals, depths); lights added up over what they reach; tones.
[[nodiscard]] traces::CommandStream record_deferred(const SceneData& scene, const SceneOptions& options);
/// The same lamps, seen themselves: the picture and what is bright of it are two layers of an image, of which
/// each level is drawn from the one above; the last pass takes from them what is out of focus, and a glow.
[[nodiscard]] traces::CommandStream record_glow(const SceneData& scene, const SceneOptions& options);
/// The test card of blending (blend_card.h); what the scene holds is not drawn.
[[nodiscard]] traces::CommandStream record_blends(const SceneData& scene, const SceneOptions& options);

/// Throws `UserError` for what frames of their own passes cannot follow.
void refuse_other_pictures(const SceneData& scene, const SceneOptions& options);

}  // namespace quadrille::scenes
