#include "models/rop/resolve.h"

#include "models/raster/samples.h"
#include "models/raster/tile.h"
#include "models/rop/quad_codec.h"

#include <array>

namespace quadrille::models {
namespace {

/// Sums pairs of samples, then pairs of these sums: equal samples have themselves as their mean, exactly.
QuadColor mean(std::array<QuadColor, kMaxSamples>& samples, std::size_t count) {
  for (std::size_t left = count; left > 1; left /= 2) {
    for (std::size_t i = 0; i < left / 2; ++i)
      for (std::size_t c = 0; c < 4; ++c)
        samples[i][c] = _mm_add_ps(samples[2 * i][c], samples[2 * i + 1][c]);
  }
  for (std::size_t c = 0; c < 4; ++c)
    samples[0][c] = _mm_mul_ps(samples[0][c], _mm_set1_ps(1.0f / static_cast<float>(count)));
  return samples[0];
}

}  // namespace

void resolve_tile(Format format, std::span<const std::uint32_t> planes, std::uint32_t pixels[64]) {
  const FormatInfo& info = format_info(format);
  const std::size_t count = planes.size() / kTilePixels;
  for (std::size_t quad = 0; quad < kTilePixels; quad += 4) {
    std::array<QuadColor, kMaxSamples> samples;
    for (std::size_t s = 0; s < count; ++s) {
      const std::uint32_t* const at = planes.data() + s * kTilePixels + quad;
      samples[s] = decode_quad(info, _mm_loadu_si128(reinterpret_cast<const __m128i*>(at)));
    }
    const QuadColor color = mean(samples, count);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(pixels + quad), encode_quad(info, color));
  }
}

}  // namespace quadrille::models
