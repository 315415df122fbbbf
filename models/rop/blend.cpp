#include "models/rop/blend.h"

#include "models/rop/quad_codec.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
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

/// Of numbers, before they are clamped.
QuadColor blend(const BlendState& state, const QuadColor& src, const QuadColor& dst) {
  QuadColor out;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = combine(state.color, src[c], factor(state.src_color, src, dst, c), dst[c],
                     factor(state.dst_color, src, dst, c));
  }
  out[3] = combine(state.alpha, src[3], factor(state.src_alpha, src, dst, 3), dst[3],
                   factor(state.dst_alpha, src, dst, 3));
  return out;
}

/// All ones in the bits of the components that are written.
PixelCode component_mask(const FormatInfo& format, std::uint8_t write_mask) {
  PixelCode bits;
  for (std::size_t c = 0; c < format.channels; ++c) {
    const ComponentBits& component = format.component[c];
    if ((write_mask >> c & 1u) != 0)
      bits.word[component.shift / 32] |= most_of(component) << component.shift % 32;
  }
  return bits;
}

bool holds_unit_range(const FormatInfo& format) {
  return format.numeric == Numeric::kUnorm || format.numeric == Numeric::kSrgb;
}

void clamp(QuadColor& color) {
  for (__m128& component : color.component) component = saturate(component);
}

std::uint32_t round_to_byte(float value) {
  return static_cast<std::uint32_t>(
      _mm_cvtss_si32(_mm_mul_ss(saturate(_mm_set_ss(value)), _mm_set_ss(255.0f))));
}

}  // namespace

bool reads_destination(const BlendState& state) { return state.enable || (state.write_mask & 0xf) != 0xf; }

void blend_quad(const BlendState& state, Format format, const float rgba[4][4], std::byte* dst_pixels,
                std::uint32_t lane_mask) {
  const FormatInfo& info = format_info(format);
  const QuadWords old = load_quad(dst_pixels, info.bytes);
  const bool clamps = holds_unit_range(info);
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = _mm_loadu_ps(rgba[c]);
  if (clamps) clamp(color);
  if (state.enable) {
    color = blend(state, color, decode_quad(info, old));
    if (clamps) clamp(color);
  }
  const __m128i lane_bits = _mm_setr_epi32(1, 2, 4, 8);
  const __m128i lanes =
      _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(lane_mask)), lane_bits), lane_bits);
  const PixelCode mask = component_mask(info, state.write_mask);
  QuadWords pixels = encode_quad(info, color);
  for (std::size_t w = 0; w < 4; ++w) {
    const __m128i written = _mm_and_si128(lanes, _mm_set1_epi32(static_cast<int>(mask.word[w])));
    pixels.word[w] =
        _mm_or_si128(_mm_andnot_si128(written, old.word[w]), _mm_and_si128(written, pixels.word[w]));
  }
  store_quad(dst_pixels, info.bytes, pixels);
}

PixelCode encode_color(Format format, const std::array<float, 4>& rgba) {
  const FormatInfo& info = format_info(format);
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = _mm_set1_ps(rgba[c]);
  if (holds_unit_range(info)) clamp(color);
  const QuadWords quad = encode_quad(info, color);
  PixelCode code;
  for (std::size_t w = 0; w < 4; ++w)
    code.word[w] = static_cast<std::uint32_t>(_mm_cvtsi128_si32(quad.word[w]));
  return code;
}

std::array<float, 4> decode_color(Format format, const PixelCode& pixel) {
  QuadWords quad;
  for (std::size_t w = 0; w < 4; ++w) quad.word[w] = _mm_set1_epi32(static_cast<int>(pixel.word[w]));
  const QuadColor color = decode_quad(format_info(format), quad);
  std::array<float, 4> rgba{};
  for (std::size_t c = 0; c < 4; ++c) rgba[c] = _mm_cvtss_f32(color[c]);
  return rgba;
}

std::uint32_t to_rgba8(Format format, const PixelCode& pixel) {
  const FormatInfo& info = format_info(format);
  std::uint32_t rgba = info.channels < 4 ? 0xff000000u : 0;
  if (holds_unit_range(info)) {
    for (std::size_t c = 0; c < info.channels; ++c) {
      const ComponentBits& component = info.component[c];
      const std::uint32_t most = most_of(component), code = pixel.word[0] >> component.shift & most;
      rgba |= (255 * code + most / 2) / most << (8 * c);
    }
    return rgba;
  }
  const std::array<float, 4> value = decode_color(format, pixel);
  for (std::size_t c = 0; c < info.channels; ++c)
    rgba |= (c < 3 ? std::uint32_t{encode_srgb8(value[c])} : round_to_byte(value[c])) << (8 * c);
  return rgba;
}

std::uint32_t encode_ufloat(float value, int mantissa_bits) {
  const std::uint32_t infinity = 31u << mantissa_bits;
  if (std::isnan(value)) return infinity | 1u;
  if (!(value > 0)) return 0;
  if (std::isinf(value)) return infinity;
  // The distance of neighbours, 2^(exponent - mantissa_bits); below 2^-14 it stays what it is there.
  const int exponent = std::max(std::ilogb(value), -14);
  const auto steps = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(value, mantissa_bits - exponent)));
  // A step of 2^mantissa_bits is the exponent's lowest bit, so that a carry goes where it belongs.
  return std::min(steps + (static_cast<std::uint32_t>(exponent + 14) << mantissa_bits), infinity - 1);
}

}  // namespace quadrille::models
