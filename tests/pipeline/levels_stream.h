/// Passes that draw to levels and layers of images, each of which later ones load or sample.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

inline constexpr std::uint32_t kLevelsWidth = 84, kLevelsHeight = 50;

/// Of random triangles; the same seed gives the same stream. It is validated.
///
/// Image 0 has four levels and three layers, image 1 two levels of depths, image 2 is the picture. Passes: 0
/// draws level 0 of layer 1; 1 draws level 1 of layer 2, with its depths in level 1; 2 draws level 1 of layer
/// 1 from the level above; 3 draws level 2 of layers 1 and 0 from that; 4 loads level 1 of layer 2; 5 samples
/// all of it into the picture.
[[nodiscard]] traces::CommandStream levels_stream(std::uint64_t seed, std::uint32_t samples = 1);

}  // namespace quadrille::pipeline::test
