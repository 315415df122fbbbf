/// What a scene file offers to choose from: `quadrille scenes FILE`.
#pragma once

#include <string>
#include <vector>

namespace quadrille::scenes {

struct SceneContents {
  struct CameraEntry {
    std::string name;
    bool perspective = true;
  };
  struct AnimationEntry {
    std::string name;
    double length = 0;  ///< seconds
    std::size_t tracks = 0;
  };
  std::vector<std::string> scenes;  ///< names, empty where the file gives none
  std::size_t own_scene = 0;        ///< the one that is drawn without a choice
  std::vector<CameraEntry> cameras;
  std::vector<AnimationEntry> animations;
};

/// Lists a glTF file (.gltf, .glb) or `builtin:NAME`. Its buffers are read, and what is compressed in them is
/// expanded; meshes are not checked and images not opened. Throws `UserError` with file, place and reason.
[[nodiscard]] SceneContents scene_contents(const std::string& file_or_builtin);

}  // namespace quadrille::scenes
