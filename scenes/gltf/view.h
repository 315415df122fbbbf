/// What looks at a glTF scene and what lights it: cameras and punctual lights, checked.
#pragma once

#include <cstddef>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Camera `index`, not yet placed. Throws `UserError` with the place of what is wrong.
[[nodiscard]] Camera read_camera(const GltfFile& file, std::size_t index);

/// Light `index` of KHR_lights_punctual, not yet placed. Throws as `read_camera`.
[[nodiscard]] Light read_light(const GltfFile& file, std::size_t index);

}  // namespace quadrille::scenes
