#include "models/rop/blend.h"

#include "models/rop/quad_codec.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace quadrille::models {
namespace {

/// What blend factors are made of.
struct Sources {
  QuadColor src, dst, second, constant;
};

__m128 factor(BlendFactor f, const Sources& of, std::size_t c) {
  const __m128 one = _mm_set1_ps(1.0f);
  const auto rest = [one](__m128 v) { return _mm_sub_ps(one, v); };
  switch (f) {
    case BlendFactor::kZero: return _mm_setzero_ps();
    case BlendFactor::kOne: return one;
    case BlendFactor::kSrcColor: return of.src[c];
    case BlendFactor::kOneMinusSrcColor: return rest(of.src[c]);
    case BlendFactor::kDstColor: return of.dst[c];
    case BlendFactor::kOneMinusDstColor: return rest(of.dst[c]);
    case BlendFactor::kSrcAlpha: return of.src[3];
    case BlendFactor::kOneMinusSrcAlpha: return rest(of.src[3]);
    case BlendFactor::kDstAlpha: return of.dst[3];
    case BlendFactor::kOneMinusDstAlpha: return rest(of.dst[3]);
    case BlendFactor::kConstantColor: return of.constant[c];
    case BlendFactor::kOneMinusConstantColor: return rest(of.constant[c]);
    case BlendFactor::kConstantAlpha: return of.constant[3];
    case BlendFactor::kOneMinusConstantAlpha: return rest(of.constant[3]);
    case BlendFactor::kSrcAlphaSaturate: return c == 3 ? one : _mm_min_ps(of.src[3], rest(of.dst[3]));
    case BlendFactor::kSrc1Color: return of.second[c];
    case BlendFactor::kOneMinusSrc1Color: return rest(of.second[c]);
    case BlendFactor::kSrc1Alpha: return of.second[3];
    case BlendFactor::kOneMinusSrc1Alpha: return rest(of.second[3]);
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
QuadColor blend(const BlendState& state, const Sources& of) {
  QuadColor out;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = combine(state.color, of.src[c], factor(state.src_color, of, c), of.dst[c],
                     factor(state.dst_color, of, c));
  }
  out[3] = combine(state.alpha, of.src[3], factor(state.src_alpha, of, 3), of.dst[3],
                   factor(state.dst_alpha, of, 3));
  return out;
}

__m128i logic(LogicOp op, __m128i s, __m128i d) {
  const __m128i ones = _mm_set1_epi32(-1);
  const auto inverted = [ones](__m128i v) { return _mm_xor_si128(v, ones); };
  switch (op) {
    case LogicOp::kClear: return _mm_setzero_si128();
    case LogicOp::kAnd: return _mm_and_si128(s, d);
    case LogicOp::kAndReverse: return _mm_andnot_si128(d, s);
    case LogicOp::kCopy: return s;
    case LogicOp::kAndInverted: return _mm_andnot_si128(s, d);
    case LogicOp::kNoOp: return d;
    case LogicOp::kXor: return _mm_xor_si128(s, d);
    case LogicOp::kOr: return _mm_or_si128(s, d);
    case LogicOp::kNor: return inverted(_mm_or_si128(s, d));
    case LogicOp::kEquivalent: return inverted(_mm_xor_si128(s, d));
    case LogicOp::kInvert: return inverted(d);
    case LogicOp::kOrReverse: return _mm_or_si128(s, inverted(d));
    case LogicOp::kCopyInverted: return inverted(s);
    case LogicOp::kOrInverted: return _mm_or_si128(inverted(s), d);
    case LogicOp::kNand: return inverted(_mm_and_si128(s, d));
    case LogicOp::kSet: return ones;
  }
  return s;
}

bool has_logic(const FormatInfo& format) {
  return format.numeric == Numeric::kUnorm || number_kind(format.numeric) != NumberKind::kFloat;
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

bool reads_destination(const BlendState& state, const BlendShared& shared) {
  if ((state.write_mask & 0xf) != 0xf) return true;
  if (!shared.logic) return state.enable;
  switch (shared.logic_op) {
    case LogicOp::kClear:
    case LogicOp::kCopy:
    case LogicOp::kCopyInverted:
    case LogicOp::kSet: return false;
    default: return true;
  }
}

void blend_quad(const BlendState& state, const BlendShared& shared, Format format, const float rgba[4][4],
                const float (*second)[4], std::byte* dst_pixels, std::uint32_t lane_mask) {
  const FormatInfo& info = format_info(format);
  const QuadWords old = load_quad(dst_pixels, info.bytes);
  const bool clamps = holds_unit_range(info);
  Sources of;
  for (std::size_t c = 0; c < 4; ++c) of.src[c] = _mm_loadu_ps(rgba[c]);
  if (clamps) clamp(of.src);
  QuadColor color = of.src;
  if (state.enable && !shared.logic) {
    of.dst = decode_quad(info, old);
    for (std::size_t c = 0; c < 4; ++c) {
      of.second[c] = second != nullptr ? _mm_loadu_ps(second[c]) : _mm_setzero_ps();
      of.constant[c] = _mm_set1_ps(shared.constants[c]);
    }
    if (clamps) clamp(of.second), clamp(of.constant);
    color = blend(state, of);
    if (clamps) clamp(color);
  }
  const __m128i lane_bits = _mm_setr_epi32(1, 2, 4, 8);
  const __m128i lanes =
      _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(lane_mask)), lane_bits), lane_bits);
  const PixelCode mask = component_mask(info, state.write_mask);
  QuadWords pixels = encode_quad(info, color);
  const bool operates = shared.logic && has_logic(info);
  for (std::size_t w = 0; w < 4; ++w) {
    if (operates) pixels.word[w] = logic(shared.logic_op, pixels.word[w], old.word[w]);
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

PixelCode encode_integers(Format format, const std::array<std::uint32_t, 4>& rgba) {
  const FormatInfo& info = format_info(format);
  PixelCode code;
  for (std::size_t c = 0; c < info.channels; ++c) {
    const ComponentBits& component = info.component[c];
    code.word[component.shift / 32] |= (rgba[c] & most_of(component)) << component.shift % 32;
  }
  return code;
}

bool holds_integers(Format format, const std::array<std::uint32_t, 4>& rgba) {
  const FormatInfo& info = format_info(format);
  for (std::size_t c = 0; c < info.channels; ++c) {
    const auto beyond =
        static_cast<unsigned>(info.component[c].bits) - (info.numeric == Numeric::kSint ? 1 : 0);
    const std::uint32_t rest = info.numeric == Numeric::kSint
                                   ? static_cast<std::uint32_t>(static_cast<std::int32_t>(rgba[c]) >> beyond)
                                   : static_cast<std::uint32_t>(std::uint64_t{rgba[c]} >> beyond);
    if (rest != 0 && (info.numeric != Numeric::kSint || rest != ~0u)) return false;
  }
  return true;
}

std::array<float, 4> decode_color(Format format, const PixelCode& pixel) {
  QuadWords quad;
  for (std::size_t w = 0; w < 4; ++w) quad.word[w] = _mm_set1_epi32(static_cast<int>(pixel.word[w]));
  const QuadColor color = decode_quad(format_info(format), quad);
  std::array<float, 4> rgba{};
  const NumberKind kind = number_kind(format);
  for (std::size_t c = 0; c < 4; ++c) {
    rgba[c] = _mm_cvtss_f32(color[c]);
    if (kind == NumberKind::kUint) rgba[c] = static_cast<float>(std::bit_cast<std::uint32_t>(rgba[c]));
    if (kind == NumberKind::kSint) rgba[c] = static_cast<float>(std::bit_cast<std::int32_t>(rgba[c]));
  }
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
  if (is_integer_format(format)) {
    for (std::size_t c = 0; c < info.channels; ++c) {
      const ComponentBits& component = info.component[c];
      rgba |= (pixel.word[component.shift / 32] >> component.shift % 32 & 0xffu) << (8 * c);
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
