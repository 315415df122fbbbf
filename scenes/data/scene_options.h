/// What a user says of how a scene is shown: size, camera, time, exposure, shaders of their own, or one of
/// the pipelines that lectures teach.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "models/base/format.h"
#include "models/base/pipeline_state.h"

namespace quadrille::scenes {

inline constexpr double kLeastExposure = 1e-12, kMostExposure = 1e12;

/// How a surface gets its colour: by one of the lectures' pipelines, or by the materials' own shaders.
enum class Shading : std::uint8_t {
  kMinimal,  ///< one colour for everything
  kFlat,     ///< lit once a face
  kGouraud,  ///< lit at the vertices
  kPhong,    ///< lit at the fragments
  kPbr       ///< the materials' own
};
inline constexpr std::array<std::string_view, 5> kShadingNames{"minimal", "flat", "gouraud", "phong", "pbr"};

/// How hidden surfaces go away: by the depth test, or by drawing from back to front.
enum class DrawOrder : std::uint8_t { kFile, kPainter };
inline constexpr std::array<std::string_view, 2> kDrawOrderNames{"file", "painter"};

/// How see-through surfaces are put in order: whole draws by the centres of their boxes, or each pixel's
/// fragments by their depths. The names are those of `models::Transparency`.
inline constexpr std::array<std::string_view, 3> kTransparencyNames{"sorted", "abuffer", "kbuffer"};

/// What of a frame the picture shows. The names are those of all but the first.
enum class Showing : std::uint8_t { kColors, kDepth, kOverdraw, kUv, kNormal, kTriangle, kSamples, kLevel };
inline constexpr std::array<std::string_view, 7> kShowingNames{"depth",    "overdraw", "uv",   "normal",
                                                               "triangle", "samples",  "level"};

/// The enumerator that `name` stands for in one of these lists, of which `first` is the first one's; `first`
/// too for a name that is not in it.
template <class Enum, std::size_t n>
[[nodiscard]] constexpr Enum named(const std::array<std::string_view, n>& names, std::string_view name,
                                   Enum first) {
  for (std::size_t i = 0; i < n; ++i)
    if (names[i] == name) return static_cast<Enum>(static_cast<std::size_t>(first) + i);
  return first;
}

struct SceneOptions {
  std::uint32_t width = 1920, height = 1080;  ///< pixels, 1..16384
  /// index into the file's cameras; -1: the first one a node carries, else one that frames the scene
  int camera = -1;
  std::optional<glm::vec3> eye,
      /// world space; either one makes an own camera (60 degrees high); the other defaults to the centre /
      /// the framing eye
      at;
  std::string camera_name;  ///< used where `camera` is -1: a camera's name
  std::string scene;        ///< which scene of the file, by number or name; empty: the file's own
  /// seconds into the animation; none: at rest, unless an animation is named
  std::optional<double> time;
  std::string animation;  ///< number, name or `all`; empty: the first
  /// part of a turn by which the camera is carried around the scene's centre
  std::optional<double> orbit;
  /// times the scene's light (scenes/view/exposure.h); none: chosen by it
  std::optional<double> exposure = 1;
  /// a .hdr or .exr file, or a sky (scenes/environment/environment.h); empty: the scene's own
  std::string environment;
  Shading shading = Shading::kPbr;
  DrawOrder order = DrawOrder::kFile;
  /// of the picture and what is drawn before it; what `shown` and `visibility` show has its own
  models::Format color_format = models::Format::kR8G8B8A8Srgb;
  models::Format depth_format = models::Format::kD32Float;
  Showing shown = Showing::kColors;  ///< all but colours have shaders of their own, and no shading
  std::uint32_t samples = 1;         ///< a pixel, of which a picture of samples has its colours
  /// Masked materials without layers let their alpha say which samples stay, instead of a test.
  bool alpha_to_coverage = false;
  /// of passes with see-through materials; kNone: sorted
  models::TransparencyState transparency{};
  bool visibility = false;  ///< draw triangle ids instead of all that (see `triangle_id_color`)
  /// false: also unpack and record textures that no shader samples; all shaders are compiled from GLSL
  bool leave_out = true;
  /// record textures packed, for a machine that unpacks those that it samples (`traces::Image::packed`)
  bool keep_packed = false;
  /// path of GLSL or SPIR-V (.spv) used instead of the material's; empty: the material's
  std::string vertex_shader, fragment_shader;
};

/// When, and from where, a frame of a scene is taken.
struct Moment {
  double time = 0;              ///< seconds into the animation
  std::optional<double> orbit;  ///< as `SceneOptions::orbit`
};

}  // namespace quadrille::scenes
