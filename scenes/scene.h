/// Scenes as command streams: the one door through which glTF files and built-in scenes reach the machine.
///
/// A scene is read into a `SceneData` (scenes/scene_data.h), a camera is chosen and `record_scene` turns both into Vulkan-level commands: one pass, opaque
/// and masked draws in scene order, then blended ones back to front. docs/scenes.md says what of glTF is covered and which defaults apply,
/// docs/shaders.md what a shader of the user's own gets to see.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "traces/command_stream.h"

namespace quadrille::scenes {

inline constexpr double kLeastExposure = 1e-12, kMostExposure = 1e12;

struct SceneOptions {
  std::uint32_t width = 1920, height = 1080;  ///< pixels, 1..16384
  int camera = -1;  ///< index into the file's cameras; -1: the first one a node carries, else one that frames the scene
  std::optional<glm::vec3> eye,
      at;  ///< world space; either one makes an own camera (60 degrees high); the other defaults to the centre / the framing eye
  std::string camera_name;             ///< used where `camera` is -1: a camera's name
  std::string scene;                   ///< which scene of the file, by number or name; empty: the file's own
  std::optional<double> time;          ///< seconds into the animation; none: at rest, unless an animation is named
  std::string animation;               ///< number, name or `all`; empty: the first
  std::optional<double> orbit;         ///< part of a turn by which the camera is carried around the scene's centre
  std::optional<double> exposure = 1;  ///< times the scene's light (scenes/exposure.h); none: chosen by it
  bool visibility = false;             ///< draw triangle ids instead of colours (see `triangle_id_color`)
  bool leave_out = true;  ///< false: also unpack and record textures that no shader samples; all shaders are compiled from GLSL
  std::string vertex_shader, fragment_shader;  ///< path of GLSL or SPIR-V (.spv) used instead of the material's; empty: the material's
};

/// When, and from where, a frame of a scene is taken.
struct Moment {
  double time = 0;              ///< seconds into the animation
  std::optional<double> orbit;  ///< as `SceneOptions::orbit`
};

/// A scene that is read once, to record any number of frames of.
class Scene {
 public:
  /// Throws `UserError` with file, place and reason. `options.time` and `options.orbit` are those of `record(options)`'s moment.
  Scene(const std::string& file_or_builtin, const SceneOptions& options);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Is there an animation that `options` ask for?
  [[nodiscard]] bool animated() const;
  /// Seconds to the animation's last key; 0 without one.
  [[nodiscard]] double length() const;
  /// Does the animation of a built-in scene go on after its length, as from its start? A file's holds its last pose.
  [[nodiscard]] bool repeats() const;
  /// One frame, validated. Throws `UserError`.
  [[nodiscard]] traces::CommandStream record(const Moment& moment);
  /// The exposure of the last frame.
  [[nodiscard]] float exposure() const;
  /// Images of the file that no frame recorded so far had to unpack.
  [[nodiscard]] std::size_t packed_images() const;
  /// Shaders that were compiled from GLSL for the frames recorded so far; the others came with the program (scenes/shader_pack.h), or as SPIR-V.
  [[nodiscard]] std::size_t compiled_shaders() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Loads a glTF file (.gltf, .glb) or `builtin:NAME` and records one frame. The stream is validated. Throws `UserError` with file, place and reason.
[[nodiscard]] traces::CommandStream load_scene(const std::string& file_or_builtin, const SceneOptions& options);

struct BuiltinScene {
  std::string_view name;         ///< without the `builtin:`
  std::string_view description;  ///< one line
};
[[nodiscard]] const std::vector<BuiltinScene>& builtin_scenes();
/// "; did you mean 'builtin:quad'?" for a name that is none, to go on with after what is wrong; empty when none is near.
[[nodiscard]] std::string meant_builtin(std::string_view name);

/// The 32-bit colour (red in the low byte) that a visibility frame shows for triangle `number` (0-based over all draws in recording order):
/// (number + 1) * 2654435761 mod 2^32, a bijection; the background is 0.
[[nodiscard]] std::uint32_t triangle_id_color(std::uint32_t number);
/// The inverse: the triangle number + 1, or 0 for the background.
[[nodiscard]] std::uint32_t triangle_from_color(std::uint32_t color);

}  // namespace quadrille::scenes
