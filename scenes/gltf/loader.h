/// glTF 2.0 files as scenes. docs/scenes.md lists what is covered. Everything that a file says is checked
/// before it is used.
#pragma once

#include <memory>
#include <string>

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

/// Which part of a file is wanted. Choices are numbers from 0 or names.
struct GltfChoice {
  std::string scene;      ///< empty: the file's own
  bool animated = false;  ///< pose the scene by an animation; otherwise nodes stay as the file places them
  std::string animation;  ///< also `all`; empty: the first, if there is one
  bool leave_out = true;  ///< false: also read the images that no material in use refers to
  bool tangents = true;   ///< make those that normal maps need and the file lacks
};

/// A file that is read once, to be posed at any number of moments.
class GltfScene {
 public:
  /// Reads a .gltf or .glb file with the buffers and images it names, posed at the animation's start.
  /// Throws `UserError`: file, place in its JSON, what is wrong there.
  GltfScene(const std::string& path, const GltfChoice& choice);
  ~GltfScene();
  GltfScene(GltfScene&&) noexcept;
  GltfScene& operator=(GltfScene&&) noexcept;

  [[nodiscard]] SceneData& data();
  /// Seconds to the last key; 0 without an animation.
  [[nodiscard]] double length() const;
  [[nodiscard]] bool animated() const;
  /// Images that the file has, whether used or not.
  [[nodiscard]] std::size_t image_count() const;
  /// Moves nodes, skins, morph targets, cameras and lights to `time` in seconds. Throws `UserError`. Without
  /// an animation it does nothing.
  void pose(double time);
  /// Prints to standard error, once, what is drawn otherwise than the file says; for when the scene is not
  /// refused.
  void print_notes();

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

/// The scene at rest: no animation is applied. Throws as `GltfScene`.
[[nodiscard]] SceneData load_gltf(const std::string& path);

}  // namespace quadrille::scenes
