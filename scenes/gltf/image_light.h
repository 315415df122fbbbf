/// The image-based light of a scene. [EXT_lights_image_based]
#pragma once

#include <memory>
#include <string>

#include "scenes/data/environment_map.h"
#include "scenes/gltf/file.h"
#include "scenes/gltf/images.h"

namespace quadrille::scenes {

/// That of the scene that `choice` names, as for `scene_roots`; null without one. Its pictures are unpacked.
/// Throws `UserError`.
[[nodiscard]] std::shared_ptr<const EnvironmentMap> read_image_light(const GltfFile& file,
                                                                     const std::string& choice,
                                                                     ImageReader& images);

}  // namespace quadrille::scenes
