/// Passes that draw attachments of several samples a pixel, and one that fetches single samples of them, as
/// deferred shading and resolves of one's own do.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

inline constexpr std::uint32_t kFetchWidth = 76, kFetchHeight = 44;

/// What the last pass shows.
enum class FetchShows : std::uint8_t {
  kResolved,    ///< what the machine resolved the samples to
  kMean,        ///< the mean of the samples, by a loop over all that there are
  kEverything,  ///< samples by constant and variable numbers, of layers and depths, in both stages, and sizes
  kIntegers,    ///< a hash of all samples of the integers
  kBeyond       ///< white where each fetch from outside of the image, its layers and its samples gave 0
};

struct FetchWish {
  std::uint32_t samples = 4;
  FetchShows shows = FetchShows::kEverything;
  traces::Format color = traces::Format::kR8G8B8A8Unorm;
  traces::Format integers = traces::Format::kR16G16B16A16Uint;
  traces::Format depth = traces::Format::kD32Float;
};

/// Of random triangles; the same seed gives the same stream. It is validated.
///
/// Images: 0 colours of three layers, 1 integers, 2 depths, all of several samples; 3 what layer 1 of image 0
/// is resolved to, 4 the picture. Passes: 0 draws layer 1, integers and depths, and resolves the first.
/// Pass 1 draws layer 2, and 2 loads it and draws more. Pass 3 fetches, or samples image 3, into the picture.
/// Descriptor set 0 has layer 1 at binding 0, layers 1 and 2 at 1, the integers at 2, the depths at 3 and
/// image 3 at 4.
[[nodiscard]] traces::CommandStream multisampled_fetch_stream(std::uint64_t seed, const FetchWish& wish = {});

}  // namespace quadrille::pipeline::test
