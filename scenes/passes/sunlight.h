/// What the frames of several passes share: a sun, the pass that lights are written in, and the last one,
/// which makes a picture of radiances.
#pragma once

#include "scenes/passes/pass_recorder.h"

namespace quadrille::scenes {

/// The camera, and a sun whose clip space holds the scene.
[[nodiscard]] PassFrame sunlit_frame(const SceneData& scene, const View& view);
/// Draws the scene's front faces. The fragment shader sees `world`, `facing` and `albedo`, vec3, at locations
/// 0 to 2: where the surface is, its normal, not of unit length, and its colour.
void draw_surfaces(PassRecorder& recorder, const std::string& name, std::string_view fragment,
                   traces::Index textures = traces::kNone);
/// Clears colours to the scene's background, and depths; depths are not kept. `depth` may be none.
[[nodiscard]] traces::BeginPass cleared_pass(const SceneData& scene, traces::Index colors,
                                             traces::Index depth);
/// Draws radiances as a picture in the format that `options` ask for: what is bright glares, and tones are
/// mapped to 0..1.
void add_tone_pass(PassRecorder& recorder, traces::Index radiance, const SceneOptions& options);

}  // namespace quadrille::scenes
