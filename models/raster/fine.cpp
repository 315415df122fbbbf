#include "models/raster/fine.h"

#include <immintrin.h>

#include <algorithm>

namespace quadrille::models {
namespace {

/// Bits of columns x0..7 (or rows y0..7) of a tile, for trimming a tile to the triangle's bounds.
struct TrimMasks {
  std::array<std::uint64_t, 9> columns_from{}, rows_from{};
};
constexpr TrimMasks make_trim_masks() {
  TrimMasks m;
  for (int first = 0; first <= 8; ++first) {
    for (int entry = 0; entry < kTilePixels; ++entry) {
      if (entry_x(entry) >= first)
        m.columns_from[static_cast<std::size_t>(first)] |= std::uint64_t{1} << entry;
      if (entry_y(entry) >= first) m.rows_from[static_cast<std::size_t>(first)] |= std::uint64_t{1} << entry;
    }
  }
  return m;
}
constexpr TrimMasks kTrim = make_trim_masks();

/// Pixels outside one edge, when every value in the tile fits 32 bits: eight pixels (two quads) a step, the
/// sign bit decides.
std::uint64_t outside_edge_32(std::int32_t corner, std::int32_t a, std::int32_t b) {
  const __m256i x = _mm256_setr_epi32(0, 1, 0, 1, 2, 3, 2, 3), y = _mm256_setr_epi32(0, 0, 1, 1, 0, 0, 1, 1);
  const __m256i va = _mm256_set1_epi32(a), vb = _mm256_set1_epi32(b);
  __m256i left = _mm256_add_epi32(_mm256_set1_epi32(corner),
                                  _mm256_add_epi32(_mm256_mullo_epi32(va, x), _mm256_mullo_epi32(vb, y)));
  const __m256i four_right = _mm256_slli_epi32(va, 2), two_down = _mm256_add_epi32(vb, vb);
  std::uint64_t outside = 0;
  for (int row = 0; row < 4; ++row) {
    const __m256i right = _mm256_add_epi32(left, four_right);
    const auto low = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(left)));
    const auto high = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(right)));
    outside |= static_cast<std::uint64_t>(low | high << 8) << (16 * row);
    left = _mm256_add_epi32(left, two_down);
  }
  return outside;
}

/// The same for edges whose slope does not fit (triangles of more than 2^18 pixels or so).
std::uint64_t outside_edge_64(std::int64_t corner, std::int64_t a, std::int64_t b) {
  std::uint64_t outside = 0;
  for (int entry = 0; entry < kTilePixels; ++entry) {
    const std::int64_t value = corner + a * entry_x(entry) + b * entry_y(entry);
    outside |= (static_cast<std::uint64_t>(value) >> 63) << entry;
  }
  return outside;
}

/// `edge_at(i)` is edge i, as it decides the samples in question.
template <class EdgeAt>
std::uint64_t coverage(const TriangleSetup& triangle, int tile_x, int tile_y, const EdgeAt& edge_at) {
  constexpr std::int64_t kReach = kTileSize - 1;
  const int px = tile_x * kTileSize, py = tile_y * kTileSize;
  std::uint64_t covered = rect_coverage(triangle.bounds, tile_x, tile_y);
  for (int i = 0; i < triangle.edge_count; ++i) {
    const EdgeFunction& edge = edge_at(static_cast<std::size_t>(i));
    const std::int64_t corner = edge.at(px, py);
    const std::int64_t lowest =
        corner + kReach * (std::min<std::int64_t>(edge.a, 0) + std::min<std::int64_t>(edge.b, 0));
    const std::int64_t highest =
        corner + kReach * (std::max<std::int64_t>(edge.a, 0) + std::max<std::int64_t>(edge.b, 0));
    if (lowest >= 0) continue;
    if (highest < 0) return 0;
    // The edge crosses the tile, so lowest < 0 <= highest and no value is further from zero than highest -
    // lowest.
    const bool narrow = highest - lowest <= INT32_MAX;
    covered &=
        ~(narrow ? outside_edge_32(static_cast<std::int32_t>(corner), static_cast<std::int32_t>(edge.a),
                                   static_cast<std::int32_t>(edge.b))
                 : outside_edge_64(corner, edge.a, edge.b));
  }
  return covered;
}

}  // namespace

std::uint64_t rect_coverage(const PixelRect& rect, int tile_x, int tile_y) {
  const int px = tile_x * kTileSize, py = tile_y * kTileSize;
  const auto at = [](int edge) { return static_cast<std::size_t>(std::clamp(edge, 0, kTileSize)); };
  return (kTrim.columns_from[at(rect.x0 - px)] & ~kTrim.columns_from[at(rect.x1 - px)]) &
         (kTrim.rows_from[at(rect.y0 - py)] & ~kTrim.rows_from[at(rect.y1 - py)]);
}

std::uint64_t tile_coverage(const TriangleSetup& triangle, int tile_x, int tile_y) {
  return coverage(triangle, tile_x, tile_y,
                  [&](std::size_t i) -> const EdgeFunction& { return triangle.edges[i]; });
}

std::uint64_t sample_coverage(const TriangleSetup& triangle, int tile_x, int tile_y,
                              const SampleGrid& samples, int sample) {
  if (samples.count == 1 || triangle.whole_pixels) return tile_coverage(triangle, tile_x, tile_y);
  return coverage(triangle, tile_x, tile_y, [&](std::size_t i) {
    return at_sample(triangle.edges[i], samples.offset[static_cast<std::size_t>(sample)],
                     samples.subpixel_bits);
  });
}

std::uint32_t covered_samples(const TriangleSetup& triangle, int x, int y, const SampleGrid& samples) {
  const PixelRect& bounds = triangle.bounds;
  if (x < bounds.x0 || x >= bounds.x1 || y < bounds.y0 || y >= bounds.y1) return 0;
  std::uint32_t covered = samples.all();
  for (int s = 0; s < samples.count; ++s) {
    const GridPoint at = triangle.whole_pixels ? GridPoint{} : samples.offset[static_cast<std::size_t>(s)];
    for (int i = 0; i < triangle.edge_count; ++i) {
      const EdgeFunction edge =
          at_sample(triangle.edges[static_cast<std::size_t>(i)], at, samples.subpixel_bits);
      if (edge.at(x, y) < 0) covered &= ~(1u << s);
    }
  }
  return covered;
}

}  // namespace quadrille::models
