/// Filters of textures of RGBA8, the fast ways of sample_filter.cpp: four corners of eight lanes at a time,
/// as codes for UNORM and by a table for sRGB. Part of the texture unit's filter half alone.
#pragma once

#include "models/rop/srgb.h"
#include "models/texture/lanes.h"
#include "models/texture/sample.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace quadrille::models {

/// Filtered channels of eight lanes, not yet scaled to 0..1.
struct LaneColor {
  __m256 channel[4];
};

struct Rgba8Corners {
  __m256i corner[4];  ///< RGBA8, red in the low byte
  __m256i frac_x;     ///< 256ths
  __m256 weight_y;    ///< of the lower row, 256ths
};

/// Where the texels of a plan are, and their format: those of memory, or of decoded blocks.
struct TexelSource {
  const std::byte* base;
  Format format;
  std::size_t channels;     ///< that a border colours
  int plane_row_shift = 0;  ///< `TexturePlan::plane_row_shift`

  /// Brings a texel of so many bytes.
  void fetch(std::int32_t index, std::size_t bytes, std::byte* texel) const {
    if (plane_row_shift == 0) {
      std::memcpy(texel, base + static_cast<std::size_t>(index) * bytes, bytes);
      return;
    }
    for (std::uint32_t c = 0; c < bytes; ++c)
      texel[c] = base[plane_index(static_cast<std::uint32_t>(index), plane_row_shift, c)];
  }
};

/// Eight texels of RGBA8.
inline __m256i fetch_codes(const TexelSource& source, const std::array<std::int32_t, 8>& texel) {
  if (source.plane_row_shift == 0)
    return _mm256_i32gather_epi32(reinterpret_cast<const int*>(source.base), load_lanes(texel.data()), 4);
  alignas(32) std::array<std::int32_t, 8> codes;
  for (std::size_t lane = 0; lane < 8; ++lane)
    source.fetch(texel[lane], 4, reinterpret_cast<std::byte*>(&codes[lane]));
  return load_lanes(codes.data());
}

/// A border as RGBA8, which is the same with and without sRGB encoding.
inline int border_code(BorderColor border, std::size_t channels) {
  if (border == BorderColor::kOpaqueWhite) return -1;
  return border == BorderColor::kOpaqueBlack || channels < 4 ? static_cast<int>(0xff000000u) : 0;
}

inline Rgba8Corners fetch_rgba8(const TexturePlan::Footprint& f, const TexelSource& source,
                                BorderColor border) {
  Rgba8Corners t;
  for (std::size_t i = 0; i < 4; ++i) t.corner[i] = fetch_codes(source, f.texel[i]);
  for (std::size_t i = 0; f.border != 0 && i < 4; ++i)
    t.corner[i] = _mm256_blendv_epi8(t.corner[i], _mm256_set1_epi32(border_code(border, source.channels)),
                                     lanes_of(f.border >> (8 * i)));
  t.frac_x = load_lanes(f.frac_x.data());
  t.weight_y = _mm256_cvtepi32_ps(load_lanes(f.frac_y.data()));
  return t;
}

/// One row of the 2x2 in 256ths: red and blue, or green and alpha, as two 16-bit sums a lane. 255 * 256 fits.
inline __m256i mix_row(__m256i left, __m256i right, __m256i weight_left, __m256i weight_right) {
  return _mm256_add_epi16(_mm256_mullo_epi16(left, weight_left), _mm256_mullo_epi16(right, weight_right));
}

/// Codes times 65536, exact: every step is an integer below 2^24.
inline LaneColor filter_unorm(const Rgba8Corners& t) {
  const __m256i low_bytes = _mm256_set1_epi32(0x00ff00ff);
  const __m256i right = _mm256_or_si256(t.frac_x, _mm256_slli_epi32(t.frac_x, 16)),
                left = _mm256_sub_epi16(_mm256_set1_epi16(256), right);
  __m256i red_blue[2], green_alpha[2];
  for (int row = 0; row < 2; ++row) {
    const __m256i a = t.corner[2 * row], b = t.corner[2 * row + 1];
    red_blue[row] = mix_row(_mm256_and_si256(a, low_bytes), _mm256_and_si256(b, low_bytes), left, right);
    green_alpha[row] = mix_row(_mm256_srli_epi16(a, 8), _mm256_srli_epi16(b, 8), left, right);
  }
  const __m256 lower = t.weight_y, upper = _mm256_sub_ps(_mm256_set1_ps(256.0f), lower);
  const auto mix_rows = [&](__m256i top, __m256i bottom) {
    return _mm256_add_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(top), upper),
                         _mm256_mul_ps(_mm256_cvtepi32_ps(bottom), lower));
  };
  const auto low_half = [](__m256i v) { return _mm256_and_si256(v, _mm256_set1_epi32(0xffff)); };
  const auto high_half = [](__m256i v) { return _mm256_srli_epi32(v, 16); };
  return {{mix_rows(low_half(red_blue[0]), low_half(red_blue[1])),
           mix_rows(low_half(green_alpha[0]), low_half(green_alpha[1])),
           mix_rows(high_half(red_blue[0]), high_half(red_blue[1])),
           mix_rows(high_half(green_alpha[0]), high_half(green_alpha[1]))}};
}

/// One 8-bit channel that is already in linear light and scaled to 0..1: decode, then two lerps across and
/// one down.
template <int shift>
__m256 filter_srgb_channel(const Rgba8Corners& t, __m256 wx, __m256 wy) {
  __m256 value[4];
  for (int i = 0; i < 4; ++i) {
    const __m256i code = _mm256_and_si256(_mm256_srli_epi32(t.corner[i], shift), _mm256_set1_epi32(0xff));
    value[i] = _mm256_i32gather_ps(kSrgbToLinear.data(), code, 4);
  }
  const auto lerp = [](__m256 a, __m256 b, __m256 w) {
    return _mm256_add_ps(a, _mm256_mul_ps(_mm256_sub_ps(b, a), w));
  };
  return lerp(lerp(value[0], value[1], wx), lerp(value[2], value[3], wx), wy);
}

inline __m256 filter_unorm_alpha(const Rgba8Corners& t) {
  const auto alpha = [&](int i) { return _mm256_srli_epi32(t.corner[i], 24); };
  const __m256i right = t.frac_x, left = _mm256_sub_epi32(_mm256_set1_epi32(256), right);
  const __m256 lower = t.weight_y, upper = _mm256_sub_ps(_mm256_set1_ps(256.0f), lower);
  const __m256 top = _mm256_cvtepi32_ps(mix_row(alpha(0), alpha(1), left, right));
  const __m256 bottom = _mm256_cvtepi32_ps(mix_row(alpha(2), alpha(3), left, right));
  return _mm256_add_ps(_mm256_mul_ps(top, upper), _mm256_mul_ps(bottom, lower));
}

/// Red, green and blue are linear 0..1, alpha is a code times 65536.
inline LaneColor filter_srgb(const Rgba8Corners& t) {
  const __m256 scale = _mm256_set1_ps(1.0f / 256.0f);
  const __m256 wx = _mm256_mul_ps(_mm256_cvtepi32_ps(t.frac_x), scale), wy = _mm256_mul_ps(t.weight_y, scale);
  return {{filter_srgb_channel<0>(t, wx, wy), filter_srgb_channel<8>(t, wx, wy),
           filter_srgb_channel<16>(t, wx, wy), filter_unorm_alpha(t)}};
}

}  // namespace quadrille::models
