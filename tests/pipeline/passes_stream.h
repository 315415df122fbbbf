/// A stream of several passes: three colour attachments of three formats, depth alone, attachments that are
/// loaded again, and a last pass that samples them all.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

/// Of random triangles; the same seed gives the same stream. It is validated.
///
/// Passes: 0 draws to the images 0, 1, 2 and depth 3; 1 loads 0 and 3 and draws on; 2 draws depth 4 alone; 3
/// samples all five into image 5; 4 loads 5 and blends over it.
[[nodiscard]] traces::CommandStream passes_stream(std::uint64_t seed, std::uint32_t width = 88,
                                                  std::uint32_t height = 56);

}  // namespace quadrille::pipeline::test
