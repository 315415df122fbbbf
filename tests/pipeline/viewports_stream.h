/// Draws to several viewports, each with a scissor and a range of depths of its own: the vertex program says
/// which one a primitive takes.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

inline constexpr std::uint32_t kViewportsSide = 64;  ///< of the picture, pixels

/// Triangles, strips, fans, lines and points. Vertices ask for viewports of their own, and for some that are
/// not there; with `agreeing` all vertices of a primitive ask for the same one, which is there. The same seed
/// gives the same stream. It is validated.
[[nodiscard]] traces::CommandStream viewports_stream(std::uint64_t seed, std::uint32_t samples = 1,
                                                     bool agreeing = false);

}  // namespace quadrille::pipeline::test
