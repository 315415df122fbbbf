/// Random command streams: many small draws that mix depth comparisons, blending, discard, depth output,
/// textures and divergent shaders on one small target.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

struct StreamShape {
  std::uint32_t width = 88, height = 56;  ///< not multiples of a tile on purpose
  int draws = 14;
  int triangles = 10;  ///< a draw, on average
};

/// The same seed gives the same stream. It is validated.
[[nodiscard]] traces::CommandStream random_stream(std::uint64_t seed, const StreamShape& shape = {});
/// Draws of every topology, polygon mode and mode and width of lines, with sizes of points, clip and cull
/// distances and restart, one behind the other without depth test.
[[nodiscard]] traces::CommandStream random_primitives(std::uint64_t seed);

}  // namespace quadrille::pipeline::test
