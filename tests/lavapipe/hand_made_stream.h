/// Small command streams written by hand, whose pictures follow from closed forms.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// A corner: clip-space position, and two values that the shaders interpolate (a texture coordinate, a
/// colour, ...).
struct Corner {
  std::array<float, 4> position;
  std::array<float, 2> value;
};

/// Builds a stream of one pass over one target around one pipeline and one vertex buffer (binding 0: location
/// 0 the position, location 1 the value).
class HandMadeStream {
 public:
  HandMadeStream(std::uint32_t width, std::uint32_t height, traces::Format color, traces::Format depth);

  /// GLSL of both stages. The vertex stage may read `layout(location = 0) in vec4` (position) and
  /// `layout(location = 1) in vec2` (value).
  HandMadeStream& shaders(std::string_view vertex, std::string_view fragment);
  HandMadeStream& corners(std::span<const Corner> corners);
  /// A texture at set 0, binding `binding`.
  HandMadeStream& texture(std::uint32_t binding, traces::Image image, const traces::Sampler& sampler);
  /// A uniform block at set 0, binding `binding`.
  HandMadeStream& uniforms(std::uint32_t binding, std::span<const float> values);
  HandMadeStream& push_constants(std::span<const float> values);
  HandMadeStream& draw(std::uint32_t count, std::uint32_t first = 0, std::uint32_t instances = 1);
  HandMadeStream& draw_indexed(std::span<const std::uint8_t> indices);

  /// For what the functions above do not cover. Pipeline 0 is the only one; draws come after everything else
  /// of the pass.
  [[nodiscard]] traces::Pipeline& pipeline() { return stream_.pipelines[0]; }
  [[nodiscard]] traces::BeginPass& pass() { return pass_; }
  /// The finished, validated stream.
  [[nodiscard]] traces::CommandStream finish() const;

 private:
  traces::CommandStream stream_;
  traces::BeginPass pass_;
  std::vector<traces::Command> state_, draws_;
};

/// The plain vertex shader: passes position and value on (value at location 0).
[[nodiscard]] std::string_view pass_through_vertex_shader();

}  // namespace quadrille::lavapipe
