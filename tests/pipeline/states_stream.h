/// Frames of random fixed-function states, in random formats: depth, stencil, depth bounds, depth bias,
/// blending by constants and by a second colour, logic operations.
#pragma once

#include "traces/command_stream.h"

namespace quadrille::pipeline::test {

struct StatesOptions {
  bool depth_bounds = true;  ///< some drivers have none
  bool small_floats = true;  ///< B10G11R11, which some drivers round otherwise
  std::uint32_t samples = 1;
  int draws = 12;
};
[[nodiscard]] traces::CommandStream states_stream(std::uint64_t seed, std::uint32_t width,
                                                  std::uint32_t height, const StatesOptions& options = {});

}  // namespace quadrille::pipeline::test
