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

constexpr std::uint32_t most_of(const ComponentBits& component) { return (1u << component.bits) - 1; }

inline __m128 decode_component(__m128i pixels, const ComponentBits& component) {
  const auto most = static_cast<int>(most_of(component));
  const __m128i code =
      _mm_and_si128(_mm_srl_epi32(pixels, _mm_cvtsi32_si128(component.shift)), _mm_set1_epi32(most));
  if (component.numeric == Numeric::kSrgb) return _mm_i32gather_ps(kSrgbToLinear.data(), code, 4);
  return _mm_div_ps(_mm_cvtepi32_ps(code), _mm_set1_ps(static_cast<float>(most)));
}

QuadColor decode_quad(const FormatInfo& format, __m128i pixels) {
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = decode_component(pixels, format.component[c]);
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

inline __m128i encode_component(__m128 v, const ComponentBits& component) {
  if (component.numeric == Numeric::kSrgb) return encode_srgb(v);
  return _mm_cvtps_epi32(_mm_mul_ps(v, _mm_set1_ps(static_cast<float>(most_of(component)))));
}

__m128i encode_quad(const FormatInfo& format, const QuadColor& color) {
  __m128i pixels = _mm_setzero_si128();
  for (std::size_t c = 0; c < 4; ++c) {
    const ComponentBits& component = format.component[c];
    pixels = _mm_or_si128(
        pixels, _mm_sll_epi32(encode_component(color[c], component), _mm_cvtsi32_si128(component.shift)));
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

/// All ones in the bits of the components that are written.
std::uint32_t component_mask(const FormatInfo& format, std::uint8_t write_mask) {
  std::uint32_t bits = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const ComponentBits& component = format.component[c];
    bits |= (write_mask >> c & 1u) != 0 ? most_of(component) << component.shift : 0u;
  }
  return bits;
}

}  // namespace

bool reads_destination(const BlendState& state) { return state.enable || (state.write_mask & 0xf) != 0xf; }

void blend_quad(const BlendState& state, Format format, const float rgba[4][4], std::uint32_t dst_pixels[4],
                std::uint32_t lane_mask) {
  const FormatInfo& info = format_info(format);
  const __m128i old = _mm_loadu_si128(reinterpret_cast<const __m128i*>(dst_pixels));
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = saturate(_mm_loadu_ps(rgba[c]));
  if (state.enable) color = blend(state, color, decode_quad(info, old));
  const __m128i lane_bits = _mm_setr_epi32(1, 2, 4, 8);
  const __m128i lanes =
      _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(lane_mask)), lane_bits), lane_bits);
  const __m128i written =
      _mm_and_si128(lanes, _mm_set1_epi32(static_cast<int>(component_mask(info, state.write_mask))));
  const __m128i pixels =
      _mm_or_si128(_mm_andnot_si128(written, old), _mm_and_si128(written, encode_quad(info, color)));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(dst_pixels), pixels);
}

std::uint32_t encode_color(Format format, const std::array<float, 4>& rgba) {
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = saturate(_mm_set1_ps(rgba[c]));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(encode_quad(format_info(format), color)));
}

std::uint32_t to_rgba8(Format format, std::uint32_t pixel) {
  const FormatInfo& info = format_info(format);
  std::uint32_t rgba = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const ComponentBits& component = info.component[c];
    const std::uint32_t most = most_of(component), code = pixel >> component.shift & most;
    rgba |= (255 * code + most / 2) / most << (8 * c);
  }
  return rgba;
}

}  // namespace quadrille::models
