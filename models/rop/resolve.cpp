#include "models/rop/resolve.h"

#include "models/raster/samples.h"
#include "models/raster/tile.h"
#include "models/rop/quad_codec.h"

#include <array>
#include <cstring>

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

void resolve_tile(Format format, const std::byte* planes, std::size_t stride, std::uint32_t samples,
                  std::byte* pixels) {
  const FormatInfo& info = format_info(format);
  if (is_integer_format(format)) {
    std::memcpy(pixels, planes, std::size_t{kTilePixels} * info.bytes);
    return;
  }
  const std::size_t quad_bytes = std::size_t{4} * info.bytes;
  for (std::size_t at = 0; at < std::size_t{kTilePixels} * info.bytes; at += quad_bytes) {
    std::array<QuadColor, kMaxSamples> colors;
    for (std::size_t s = 0; s < samples; ++s)
      colors[s] = decode_quad(info, load_quad(planes + s * stride + at, info.bytes));
    store_quad(pixels + at, info.bytes, encode_quad(info, mean(colors, samples)));
  }
}

}  // namespace quadrille::models
