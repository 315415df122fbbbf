#include "scenes/contents.h"

#include <algorithm>

#include "scenes/builtin/builtin.h"
#include "scenes/gltf/animation.h"
#include "scenes/gltf/file.h"
#include "scenes/gltf/view.h"

namespace quadrille::scenes {
namespace {

SceneContents builtin_contents(const std::string& name) {
  SceneContents contents;
  contents.scenes.emplace_back();
  const double length = builtin_length(name);
  for (const Camera& camera : build_builtin(name).cameras)
    contents.cameras.push_back({camera.name, camera.perspective});
  if (length > 0) contents.animations.push_back({"", length, 0});
  return contents;
}

}  // namespace

SceneContents scene_contents(const std::string& file_or_builtin) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (file_or_builtin.starts_with(kBuiltin)) return builtin_contents(file_or_builtin.substr(kBuiltin.size()));
  GltfFile file = read_gltf_file(file_or_builtin);
  SceneContents contents;
  for (const tinygltf::Scene& scene : file.model.scenes) contents.scenes.push_back(scene.name);
  contents.own_scene = static_cast<std::size_t>(std::max(0, file.model.defaultScene));
  for (std::size_t i = 0; i < file.model.cameras.size(); ++i) {
    const Camera camera = read_camera(file, i);
    contents.cameras.push_back({camera.name, camera.perspective});
  }
  for (std::size_t i = 0; i < file.model.animations.size(); ++i) {
    const Animation animation = read_animation(file, i);
    contents.animations.push_back({animation.name, animation.length, animation.tracks.size()});
  }
  print_notes(file);
  return contents;
}

}  // namespace quadrille::scenes
