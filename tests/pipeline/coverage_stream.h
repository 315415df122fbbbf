/// Streams that ask for samples: what a fragment program and a pipeline can say of centroids, samples, masks
/// and alpha to coverage.
#pragma once

#include "traces/command_stream.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::pipeline::test {

/// A triangle with colours at its corners: normalised device coordinates and depth.
struct ColoredTriangle {
  std::array<std::array<float, 3>, 3> corner;
  std::array<std::array<float, 4>, 3> color;
};
/// One that covers the whole picture, at this depth. Its colour runs from 0 to 1 along x (red), y (green).
[[nodiscard]] ColoredTriangle whole_picture(float depth = 0.5f);

struct CoverageDraw {
  std::vector<ColoredTriangle> triangles;
  std::string fragment;  ///< GLSL after #version; `v_color` is the output at location 0
  bool depth = false;    ///< is tested, less, and written
  bool sample_shading = false, alpha_to_coverage = false;
  std::uint32_t sample_mask = ~0u;
};
/// One pass of these draws, over black, into a UNORM target of so many samples a pixel.
[[nodiscard]] traces::CommandStream coverage_stream(const std::vector<CoverageDraw>& draws,
                                                    std::uint32_t samples, std::uint32_t width = 40,
                                                    std::uint32_t height = 24);

/// Lets a third of the pipelines of a `random_stream` run programs that ask for samples, and sets their
/// states at random.
void add_sample_states(traces::CommandStream& random_stream, std::uint64_t seed);

}  // namespace quadrille::pipeline::test
