/// Shaders of this program's own: a clear or a copy in the middle of a frame is a draw to the machine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::capture {

enum class OwnShader : std::uint8_t {
  kArea,   ///< vertices 0 to 2: a triangle over the whole viewport
  kClear,  ///< one colour, of floats
  kClearUnsigned,
  kClearSigned,  ///< of integers, whose bits `AreaConstants::color` holds
  kCopy,         ///< what a texture (set 0, binding 0) holds
  kCopyLine,     ///< the same of a texture of one dimension
  kCopyDepth,    ///< what a texture of depths holds, as the fragment's depth
  kNothing       ///< of a pipeline that has no fragment shader: it writes nothing
};
/// SPIR-V 1.0, entry point "main". A clear's output has the location.
[[nodiscard]] std::vector<std::uint32_t> own_shader(OwnShader which, std::uint32_t location = 0);

/// Their push constants.
struct AreaConstants {
  std::array<float, 4> color{};
  std::array<float, 4> source{};  ///< corner and size of what is copied, in coordinates of the texture
  float depth = 0;
};
static_assert(sizeof(AreaConstants) == 36);

}  // namespace quadrille::capture
