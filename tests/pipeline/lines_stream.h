/// Passes that draw to images of one dimension, each of which later ones sample.
#pragma once

#include "traces/command_stream.h"

namespace quadrille::pipeline::test {

inline constexpr std::uint32_t kLinesWidth = 64, kLinesHeight = 24;

/// Image 0 is of one dimension, with two levels and three layers; image 1 is the picture. Passes: 0 to 2 draw
/// level 0 of each layer; 3 draws level 1 of layer 2 from the level above; 4 samples layers and levels
/// into the picture. With more samples a pixel, all of them are resolved. It is validated.
[[nodiscard]] traces::CommandStream lines_stream(std::uint32_t samples = 1);

}  // namespace quadrille::pipeline::test
