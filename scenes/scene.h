/// Scenes as command streams: the one door through which glTF files and built-in scenes reach the machine.
///
/// A scene is read into a `SceneData` (scenes/data/scene_data.h), a camera is chosen and `record_scene` turns
/// both into Vulkan-level commands: one pass, opaque and masked draws in scene order, then blended ones back
/// to front; and a second pass over its picture where the scene asks for one. docs/scenes.md says what of
/// glTF is covered and which defaults apply, docs/shaders.md what a shader of the user's own gets to see, and
/// docs/lectures.md by which other pipelines a scene can be drawn.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/data/scene_options.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

/// A scene that is read once, to record any number of frames of.
class Scene {
 public:
  /// Throws `UserError` with file, place and reason. `options.time` and `options.orbit` are those of
  /// `record(options)`'s moment.
  Scene(const std::string& file_or_builtin, const SceneOptions& options);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Is there an animation that `options` ask for?
  [[nodiscard]] bool animated() const;
  /// Seconds to the animation's last key; 0 without one.
  [[nodiscard]] double length() const;
  /// Does the animation of a built-in scene go on after its length, as from its start? A file's holds its
  /// last pose.
  [[nodiscard]] bool repeats() const;
  /// One frame, validated. Throws `UserError`.
  [[nodiscard]] traces::CommandStream record(const Moment& moment);
  /// The window depths that the last frame shows white and black, if it is a picture of depths.
  [[nodiscard]] std::optional<std::pair<float, float>> depth_range() const;
  /// The exposure of the last frame.
  [[nodiscard]] float exposure() const;
  /// Images of the file that no shader of a frame recorded so far can sample.
  [[nodiscard]] std::size_t unused_images() const;
  /// Unpacks, once and on all cores, the images that shaders of the frames recorded so far can sample. Throws
  /// `UserError`.
  void unpack_images();
  /// Shaders that were compiled from GLSL for the frames recorded so far; the others came with the program
  /// (scenes/material/shader_pack.h), or as SPIR-V.
  [[nodiscard]] std::size_t compiled_shaders() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Loads a glTF file (.gltf, .glb) or `builtin:NAME` and records one frame. The stream is validated. Throws
/// `UserError` with file, place and reason.
[[nodiscard]] traces::CommandStream load_scene(const std::string& file_or_builtin,
                                               const SceneOptions& options);

/// The 32-bit colour (red in the low byte) that a visibility frame shows for triangle `number` (0-based over
/// all draws in recording order): (number + 1) * 2654435761 mod 2^32, a bijection; the background is 0.
[[nodiscard]] std::uint32_t triangle_id_color(std::uint32_t number);
/// The inverse: the triangle number + 1, or 0 for the background.
[[nodiscard]] std::uint32_t triangle_from_color(std::uint32_t color);

}  // namespace quadrille::scenes
