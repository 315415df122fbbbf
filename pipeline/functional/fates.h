/// What became of triangles and fragments on their way to the target: why a picture shows nothing.
#pragma once

#include <cstdint>

namespace quadrille::pipeline {

struct Fates {
  // Triangles; of those that were cut, their pieces. From set-up on, in each raster engine that they went to.
  std::uint64_t off_screen = 0;  ///< outside the view volume or the scissor
  std::uint64_t not_finite = 0;  ///< a position is NaN or infinite
  std::uint64_t culled = 0;      ///< face the way that is culled
  std::uint64_t no_area = 0;
  std::uint64_t no_sample = 0;   ///< their bounds hold no pixel centre
  std::uint64_t rasterised = 0;  ///< all others
  // Of those that were rasterised.
  std::uint64_t tiles_hidden = 0;  ///< dropped by Hi-Z, with an unknown number of fragments
  std::uint64_t hidden = 0;        ///< fragments that failed a depth test
  std::uint64_t discarded = 0;     ///< fragments, by their program
};

}  // namespace quadrille::pipeline
