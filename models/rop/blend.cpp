#include "models/rop/blend.h"

#include "models/rop/quad_codec.h"

#include <immintrin.h>

#include <cstddef>

namespace quadrille::models {
namespace {

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
