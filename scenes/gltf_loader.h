/// glTF 2.0 files as scenes. docs/scenes.md lists what is covered. Everything that a file says is checked before it is used.
#pragma once

#include <string>

#include "scenes/scene_data.h"

namespace quadrille::scenes {

/// Reads a .gltf or .glb file with the buffers and images it names. Throws `UserError`: file, place in its JSON, what is wrong there.
[[nodiscard]] SceneData load_gltf(const std::string& path);

}  // namespace quadrille::scenes
