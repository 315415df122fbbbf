/// The part of a depth tile that lies in the frame: a frame whose sides are no multiples of 8 cuts the tiles
/// at its right and lower edge, and what lies beyond is never drawn to.
#pragma once

#include <cstdint>

namespace quadrille::models {

/// Entries of a tile of which the first `width` columns and `height` rows are in the frame (both 1 and more;
/// from 8 on: all of them).
[[nodiscard]] std::uint64_t pixels_within(int width, int height);

/// Greatest depth of the pixels of `mask`, +infinity if one is NaN, as of `tile_max`.
[[nodiscard]] float tile_max_within(const float depths[64], std::uint64_t mask);

}  // namespace quadrille::models
