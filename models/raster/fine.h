/// Fine rasterisation: the pixels of one tile of which a triangle covers the centre, or a sample.
#pragma once

#include "models/raster/triangle_setup.h"

#include <cstdint>

namespace quadrille::models {

/// Coverage of the tile (8 * tile_x, 8 * tile_y) by the triangle, within its bounds; quad-major bits
/// (tile.h). Exact; top-left rule on shared edges. [VK1.3 #primsrast-polygons-basic]
[[nodiscard]] std::uint64_t tile_coverage(const TriangleSetup& triangle, int tile_x, int tile_y);
/// The same for one sample of each pixel.
[[nodiscard]] std::uint64_t sample_coverage(const TriangleSetup& triangle, int tile_x, int tile_y,
                                            const SampleGrid& samples, int sample);
/// Pixels of the tile within a rectangle.
[[nodiscard]] std::uint64_t rect_coverage(const PixelRect& rect, int tile_x, int tile_y);
/// Samples of pixel (x, y) that are covered, a bit each: as `sample_coverage`, the other way round.
[[nodiscard]] std::uint32_t covered_samples(const TriangleSetup& triangle, int x, int y,
                                            const SampleGrid& samples);

}  // namespace quadrille::models
