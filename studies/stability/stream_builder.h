/// Small command streams written by hand: triangles in clip space or under a matrix, in cells of a target,
/// with blending and depth as a case needs them.
#pragma once

#include "traces/command_stream.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <span>
#include <string>
#include <vector>

namespace quadrille::studies::stability {

struct Corner {
  glm::vec4 position{0, 0, 0, 1};
  glm::vec4 color{1};
  glm::vec2 uv{0};
};
using Corners = std::vector<Corner>;

struct Area {
  std::int32_t x = 0, y = 0;
  std::uint32_t width = 0, height = 0;
};

/// What a fragment becomes.
enum class Paint : std::uint8_t {
  kColor,    ///< its colour
  kTexture,  ///< a checked texture at its coordinates, times its colour
  kCount     ///< adds 1/255 to red: the target counts how often each pixel was covered
};

/// How a fragment joins what is there.
enum class Mix : std::uint8_t {
  kReplace,
  kAdd,  ///< the sum, alpha too
  kOver  ///< by its alpha
};

struct DrawState {
  Paint paint = Paint::kColor;
  Mix mix = Mix::kReplace;
  traces::DepthState depth{};
  traces::CullMode cull = traces::CullMode::kNone;
};

class StreamBuilder {
 public:
  /// A target of RGBA8 UNORM, cleared to `clear` and `clear_depth`.
  StreamBuilder(std::string name, std::uint32_t width, std::uint32_t height, bool depth = false,
                float clear_depth = 1);
  /// A target of other formats, cleared to 0 and depth 1; no depths if undefined.
  StreamBuilder(std::string name, std::uint32_t width, std::uint32_t height, traces::Format color,
                traces::Format depth, float clear_depth = 1);
  /// Viewport and scissor of the draws that follow. Two areas, since a scissor may be smaller than its
  /// viewport.
  StreamBuilder& area(const Area& viewport, const Area& scissor);
  StreamBuilder& area(const Area& both) { return area(both, both); }
  StreamBuilder& state(const DrawState& state);
  /// A triangle list. Positions are multiplied by `matrix` in the vertex shader.
  StreamBuilder& draw(std::span<const Corner> corners, const glm::mat4& matrix = glm::mat4(1));
  /// The same from shared corners.
  StreamBuilder& draw_indexed(std::span<const Corner> corners, std::span<const std::uint32_t> indices);
  StreamBuilder& clear(const std::array<float, 4>& color);
  /// The stream, validated.
  [[nodiscard]] traces::CommandStream finish() const;

 private:
  [[nodiscard]] traces::Index shader(const std::string& name, traces::ShaderStage stage,
                                     std::string_view source);
  [[nodiscard]] traces::Index fragment_shader(Paint paint);

  traces::CommandStream stream_;
  traces::BeginPass pass_;
  std::vector<traces::Command> commands_;
};

/// Corners of a quad (two triangles), counter-clockwise in the window: x, y of two opposite corners in clip
/// space with w = 1.
[[nodiscard]] Corners quad(const glm::vec2& low, const glm::vec2& high, float z, const glm::vec4& color);
/// A position of a target of `width` x `height` pixels as clip space with w = 1.
[[nodiscard]] glm::vec4 at_pixel(double x, double y, std::uint32_t width, std::uint32_t height,
                                 float z = 0.5F);

}  // namespace quadrille::studies::stability
