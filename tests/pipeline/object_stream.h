/// Frames of many objects, each a draw with matrices of its own: what culling of whole draws is tried on.
#pragma once

#include "traces/command_stream.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille::pipeline::test {

using Matrix = std::array<float, 16>;  ///< columns, as GLSL has them

struct ObjectDraw {
  std::size_t program = 0;
  Matrix model{}, view{};                     ///< push constants: view * model * position
  std::vector<std::array<float, 3>> corners;  ///< three a triangle
  bool indexed = false;
  bool depth_clamp = false;
};

/// Vertex shaders whose positions can be bounded: the plain product; the same with branches, selections,
/// limits and products of inputs.
[[nodiscard]] std::vector<std::string> bounded_programs();
/// Vertex shaders whose positions cannot: special functions, loops, the vertex's number, a texture, and one
/// that writes a buffer.
[[nodiscard]] std::vector<std::string> unbounded_programs();

/// Draws in one colour, on a target of 64x64 pixels. `program` of a draw is one of `programs`.
[[nodiscard]] traces::CommandStream object_stream(const std::vector<ObjectDraw>& draws,
                                                  const std::vector<std::string>& programs);

}  // namespace quadrille::pipeline::test
