#include "models/rop/blend.h"

#include "models/rop/srgb.h"

#include <immintrin.h>

#include <cstddef>

namespace quadrille::models {
namespace {

/// Four pixels, component-major: red, green, blue, alpha.
struct QuadColor {
  __m128 component[4];
  __m128& operator[](std::size_t c) { return component[c]; }
  const __m128& operator[](std::size_t c) const { return component[c]; }
};

/// 0..1; NaN becomes 0 because max returns its second operand when one is NaN.
inline __m128 saturate(__m128 v) { return _mm_min_ps(_mm_max_ps(v, _mm_setzero_ps()), _mm_set1_ps(1.0f)); }

inline __m128 decode_unorm(__m128i codes) { return _mm_div_ps(_mm_cvtepi32_ps(codes), _mm_set1_ps(255.0f)); }

QuadColor decode_quad(ColorFormat format, __m128i pixels) {
  const __m128i byte = _mm_set1_epi32(0xff);
  const __m128i codes[4] = {_mm_and_si128(pixels, byte), _mm_and_si128(_mm_srli_epi32(pixels, 8), byte),
                            _mm_and_si128(_mm_srli_epi32(pixels, 16), byte), _mm_srli_epi32(pixels, 24)};
  QuadColor color;
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = format == ColorFormat::kR8G8B8A8Srgb ? _mm_i32gather_ps(kSrgbToLinear.data(), codes[c], 4)
                                                    : decode_unorm(codes[c]);
  }
  color[3] = decode_unorm(codes[3]);
  return color;
}

/// v in 0..1. Looks up the code at the bottom of the value's bucket and compares with the one threshold that
/// the bucket may hold.
inline __m128i encode_srgb(__m128 v) {
  const __m128 least = _mm_castsi128_ps(_mm_set1_epi32(static_cast<int>(kSrgbFirstBucket << 16)));
  const __m128i bucket = _mm_sub_epi32(_mm_srli_epi32(_mm_castps_si128(_mm_max_ps(v, least)), 16),
                                       _mm_set1_epi32(kSrgbFirstBucket));
  const __m128i code = _mm_i32gather_epi32(kSrgbBucketCode.data(), bucket, 4);
  const __m128 threshold = _mm_i32gather_ps(kSrgbThreshold.data(), code, 4);
  return _mm_sub_epi32(code, _mm_castps_si128(_mm_cmpge_ps(v, threshold)));
}

inline __m128i encode_unorm(__m128 v) { return _mm_cvtps_epi32(_mm_mul_ps(v, _mm_set1_ps(255.0f))); }

__m128i encode_quad(ColorFormat format, const QuadColor& color) {
  __m128i pixels = _mm_slli_epi32(encode_unorm(color[3]), 24);
  for (std::size_t c = 0; c < 3; ++c) {
    const __m128i code =
        format == ColorFormat::kR8G8B8A8Srgb ? encode_srgb(color[c]) : encode_unorm(color[c]);
    pixels = _mm_or_si128(pixels, _mm_slli_epi32(code, static_cast<int>(8 * c)));
  }
  return pixels;
}

__m128 factor(BlendFactor f, const QuadColor& src, const QuadColor& dst, std::size_t c) {
  const __m128 one = _mm_set1_ps(1.0f);
  switch (f) {
    case BlendFactor::kZero: return _mm_setzero_ps();
    case BlendFactor::kOne: return one;
    case BlendFactor::kSrcColor: return src[c];
    case BlendFactor::kOneMinusSrcColor: return _mm_sub_ps(one, src[c]);
    case BlendFactor::kDstColor: return dst[c];
    case BlendFactor::kOneMinusDstColor: return _mm_sub_ps(one, dst[c]);
    case BlendFactor::kSrcAlpha: return src[3];
    case BlendFactor::kOneMinusSrcAlpha: return _mm_sub_ps(one, src[3]);
    case BlendFactor::kDstAlpha: return dst[3];
    case BlendFactor::kOneMinusDstAlpha: return _mm_sub_ps(one, dst[3]);
  }
  return one;
}

__m128 combine(BlendOp op, __m128 src, __m128 src_factor, __m128 dst, __m128 dst_factor) {
  switch (op) {
    case BlendOp::kAdd: return _mm_add_ps(_mm_mul_ps(src, src_factor), _mm_mul_ps(dst, dst_factor));
    case BlendOp::kSubtract: return _mm_sub_ps(_mm_mul_ps(src, src_factor), _mm_mul_ps(dst, dst_factor));
    case BlendOp::kReverseSubtract:
      return _mm_sub_ps(_mm_mul_ps(dst, dst_factor), _mm_mul_ps(src, src_factor));
    case BlendOp::kMin: return _mm_min_ps(src, dst);
    case BlendOp::kMax: return _mm_max_ps(src, dst);
  }
  return src;
}

QuadColor blend(const BlendState& state, const QuadColor& src, const QuadColor& dst) {
  QuadColor out;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = saturate(combine(state.color, src[c], factor(state.src_color, src, dst, c), dst[c],
                              factor(state.dst_color, src, dst, c)));
  }
  out[3] = saturate(combine(state.alpha, src[3], factor(state.src_alpha, src, dst, 3), dst[3],
                            factor(state.dst_alpha, src, dst, 3)));
  return out;
}

/// All ones in the bytes of the components that are written.
constexpr std::uint32_t component_mask(std::uint8_t write_mask) {
  std::uint32_t bits = 0;
  for (unsigned c = 0; c < 4; ++c) bits |= (write_mask >> c & 1u) != 0 ? 0xffu << (8 * c) : 0u;
  return bits;
}

}  // namespace

bool reads_destination(const BlendState& state) { return state.enable || (state.write_mask & 0xf) != 0xf; }

void blend_quad(const BlendState& state, ColorFormat format, const float rgba[4][4],
                std::uint32_t dst_pixels[4], std::uint32_t lane_mask) {
  const __m128i old = _mm_loadu_si128(reinterpret_cast<const __m128i*>(dst_pixels));
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = saturate(_mm_loadu_ps(rgba[c]));
  if (state.enable) color = blend(state, color, decode_quad(format, old));
  const __m128i lane_bits = _mm_setr_epi32(1, 2, 4, 8);
  const __m128i lanes =
      _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(lane_mask)), lane_bits), lane_bits);
  const __m128i written =
      _mm_and_si128(lanes, _mm_set1_epi32(static_cast<int>(component_mask(state.write_mask))));
  const __m128i pixels = _mm_blendv_epi8(old, encode_quad(format, color), written);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(dst_pixels), pixels);
}

std::uint32_t encode_color(ColorFormat format, const std::array<float, 4>& rgba) {
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = saturate(_mm_set1_ps(rgba[c]));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(encode_quad(format, color)));
}

}  // namespace quadrille::models
