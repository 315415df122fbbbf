/// Frames of random pipelines: each draw has states, programs and a mesh of its own, to several targets of
/// random formats.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

/// What a driver beside which they are drawn may lack, or do in its own way.
struct PipelinesOptions {
  bool depth_bounds = true;
  bool small_floats = true;  ///< B10G11R11, which some round toward zero
  bool sample_masks = true;  ///< of pipelines, at one sample a pixel
  bool sample_shading = true;
  bool sample_scissors = true;  ///< at several samples, where some draw a pixel beyond them
  std::uint32_t samples = 1;    ///< a pixel
  int draws = 16;
  std::uint32_t side = 32;  ///< of the targets, pixels
};
/// The same seed gives the same stream. It is validated.
[[nodiscard]] traces::CommandStream random_pipelines(std::uint64_t seed, const PipelinesOptions& options);

}  // namespace quadrille::pipeline::test
