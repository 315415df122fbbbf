/// glTF materials: the metallic-roughness model, its five textures, and the extensions that this project
/// knows.
#pragma once

#include <cstddef>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Material `index` of the file; image numbers are the file's. Throws `UserError` with the place of a
/// reference or value that is wrong.
[[nodiscard]] Material read_material(const GltfFile& file, std::size_t index);

}  // namespace quadrille::scenes
