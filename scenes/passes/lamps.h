/// Deferred shading at night: surfaces first, then lamps that are added up over them. What frames with lamps
/// share.
#pragma once

#include <string_view>
#include <vector>

#include "scenes/passes/pass_recorder.h"

namespace quadrille::scenes {

/// What a program that reads the surfaces begins with: textures `colors`, `normals` and `depths` of set 1,
/// and `place`, the point in the world that a pixel shows.
extern const std::string_view kSurfaceTextures;

struct LampInstance {
  glm::vec4 sphere;  ///< centre and reach, metres
  glm::vec3 color;
};

struct LitSurfaces {
  traces::Index depths = traces::kNone;
  traces::Index set = traces::kNone;  ///< colours, normals and depths, for set 1
};
/// Adds the attachments of surfaces and records the pass that fills them. A depth pixel without one is 1.
[[nodiscard]] LitSurfaces draw_lit_surfaces(PassRecorder& recorder, const SceneOptions& options);

/// Lamps in two rings, over the floor and between the columns.
[[nodiscard]] std::vector<LampInstance> lamps();
/// A pipeline that draws a square for each lamp, which faces the camera. Its vertex program hands on sphere
/// and colour at the locations 0 and 1, flat; the square holds a ball of `radius` times the lamp's reach.
[[nodiscard]] traces::Pipeline lamp_pipeline(PassRecorder& recorder, const std::string& name, double radius,
                                             std::string_view fragment);
void draw_lamps(PassRecorder& recorder, traces::Index pipeline, traces::Index set, const std::string& label);

/// Within a pass whose colours are radiances: the sky's light over the whole picture, then what lamps add.
void draw_radiance(PassRecorder& recorder, traces::Index set);

}  // namespace quadrille::scenes
