/// Per-sample operations at the end of the pipeline.
#include "models/reference/output.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "models/reference/sampling.h"

namespace quadrille::models::reference {
namespace {

using traces::BlendFactor;
using traces::BlendOp;

double clamp_unit(double a) { return a > 0 ? std::min(a, 1.0) : 0.0; }  // NaN: 0

double most_of(const ComponentBits& component) { return std::ldexp(1.0, component.bits) - 1.0; }

std::uint32_t bits_of(const ComponentBits& component, const PixelCode& code) {
  return static_cast<std::uint32_t>(std::uint64_t{code.word[component.shift / 32]} >> component.shift % 32 &
                                    ((std::uint64_t{1} << component.bits) - 1));
}

bool is_float(const ComponentBits& component) {
  return component.numeric == Numeric::kFloat || component.numeric == Numeric::kUfloat;
}

/// Five bits of exponent and so many of mantissa, of a value of 0 and more: to nearest, ties to even.
std::uint32_t small_float(double value, int mantissa_bits) {
  const std::uint32_t infinity = 31u << mantissa_bits;
  if (std::isinf(value)) return infinity;
  const int exponent = value > 0 ? std::max(std::ilogb(value), -14) : -14;
  if (exponent > 15) return infinity;
  const double steps = std::nearbyint(std::ldexp(value, mantissa_bits - exponent));
  return std::min(
      static_cast<std::uint32_t>(steps) + (static_cast<std::uint32_t>(exponent + 14) << mantissa_bits),
      infinity);
}

/// Halves that are too large are infinite; unsigned floats end with their greatest finite value.
std::uint32_t encode_float(const ComponentBits& component, double value) {
  if (component.bits == 32) return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  const bool half = component.numeric == Numeric::kFloat;
  const int mantissa_bits = half ? 10 : component.bits - 5;
  const std::uint32_t infinity = 31u << mantissa_bits;
  if (std::isnan(value)) return infinity | 1u;
  if (half) return (std::signbit(value) ? 0x8000u : 0u) | small_float(std::abs(value), mantissa_bits);
  if (std::isinf(value) && value > 0) return infinity;
  return std::min(small_float(std::max(value, 0.0), mantissa_bits), infinity - 1);
}

double decode_float(const ComponentBits& component, std::uint32_t bits) {
  if (component.bits == 32) return static_cast<double>(std::bit_cast<float>(bits));
  const bool half = component.numeric == Numeric::kFloat;
  const int mantissa_bits = half ? 10 : component.bits - 5;
  const double sign = half && (bits & 0x8000u) != 0 ? -1 : 1;
  const std::uint32_t exponent = bits >> mantissa_bits & 31u, mantissa = bits & ((1u << mantissa_bits) - 1);
  if (exponent == 31)
    return mantissa != 0 ? std::numeric_limits<double>::quiet_NaN()
                         : sign * std::numeric_limits<double>::infinity();
  const double fraction = std::ldexp(mantissa, -mantissa_bits);
  return sign * (exponent == 0 ? std::ldexp(fraction, -14)
                               : std::ldexp(1 + fraction, static_cast<int>(exponent) - 15));
}

std::uint32_t encode(const ComponentBits& component, double linear) {
  if (is_float(component)) return encode_float(component, linear);
  const double clamped = clamp_unit(linear);
  const double encoded = component.numeric == Numeric::kSrgb ? linear_to_srgb(clamped) : clamped;
  return static_cast<std::uint32_t>(std::nearbyint(encoded * most_of(component)));
}

/// Puts a component's bits into a pixel.
void put(const ComponentBits& component, std::uint32_t bits, PixelCode& code) {
  std::uint32_t& word = code.word[component.shift / 32];
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << component.bits) - 1);
  word = (word & ~(mask << component.shift % 32)) | bits << component.shift % 32;
}

/// What the format can hold of a value, before it is rounded.
double held(const FormatInfo& format, double value) {
  return format.numeric == Numeric::kUnorm || format.numeric == Numeric::kSrgb ? clamp_unit(value) : value;
}

/// Of a code of 8 bits.
double srgb_code_to_linear(std::uint32_t code) {
  static const std::array<double, 256> kTable = [] {
    std::array<double, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = srgb_to_linear(static_cast<double>(i) / 255.0);
    return table;
  }();
  return kTable[code];
}

double decode(const ComponentBits& component, const PixelCode& code) {
  const std::uint32_t bits = bits_of(component, code);
  if (is_float(component)) return decode_float(component, bits);
  return component.numeric == Numeric::kSrgb ? srgb_code_to_linear(bits) : bits / most_of(component);
}

double factor(BlendFactor which, std::size_t channel, const std::array<double, 4>& source,
              const std::array<double, 4>& destination) {
  switch (which) {
    case BlendFactor::kZero: return 0.0;
    case BlendFactor::kOne: return 1.0;
    case BlendFactor::kSrcColor: return source[channel];
    case BlendFactor::kOneMinusSrcColor: return 1.0 - source[channel];
    case BlendFactor::kDstColor: return destination[channel];
    case BlendFactor::kOneMinusDstColor: return 1.0 - destination[channel];
    case BlendFactor::kSrcAlpha: return source[3];
    case BlendFactor::kOneMinusSrcAlpha: return 1.0 - source[3];
    case BlendFactor::kDstAlpha: return destination[3];
    case BlendFactor::kOneMinusDstAlpha: return 1.0 - destination[3];
  }
  return 0.0;
}

double combine(BlendOp op, double source, double source_factor, double destination,
               double destination_factor) {
  switch (op) {
    case BlendOp::kAdd: return source * source_factor + destination * destination_factor;
    case BlendOp::kSubtract: return source * source_factor - destination * destination_factor;
    case BlendOp::kReverseSubtract: return destination * destination_factor - source * source_factor;
    case BlendOp::kMin: return std::min(source, destination);
    case BlendOp::kMax: return std::max(source, destination);
  }
  return 0.0;
}

}  // namespace

bool depth_passes(traces::CompareOp op, double incoming, double stored) {
  switch (op) {
    case traces::CompareOp::kNever: return false;
    case traces::CompareOp::kLess: return incoming < stored;
    case traces::CompareOp::kEqual: return incoming == stored;
    case traces::CompareOp::kLessOrEqual: return incoming <= stored;
    case traces::CompareOp::kGreater: return incoming > stored;
    case traces::CompareOp::kNotEqual: return incoming != stored;
    case traces::CompareOp::kGreaterOrEqual: return incoming >= stored;
    case traces::CompareOp::kAlways: return true;
  }
  return false;
}

double float_ulps(double a, double b) {
  if (a == b) return 0.0;
  const auto larger = static_cast<float>(std::max(std::abs(a), std::abs(b)));
  return std::abs(a - b) /
         (static_cast<double>(std::nextafter(larger, std::numeric_limits<float>::infinity())) -
          static_cast<double>(larger));
}

StoredColor blend(const traces::BlendState& state, traces::Format format, const std::array<double, 4>& source,
                  const StoredColor& before) {
  const FormatInfo& info = format_info(format);
  const std::array<double, 4> dst = load_color(format, before.code);
  std::array<double, 4> src{};
  for (std::size_t c = 0; c < 4; ++c) src[c] = held(info, source[c]);
  StoredColor after = before;
  for (std::size_t c = 0; c < info.channels; ++c) {
    if ((state.write_mask >> c & 1u) == 0) continue;
    double value = src[c];
    if (state.enable) {
      const bool alpha = c == 3;
      const double source_factor = factor(alpha ? state.src_alpha : state.src_color, c, src, dst);
      const double destination_factor = factor(alpha ? state.dst_alpha : state.dst_color, c, src, dst);
      value = held(info, combine(alpha ? state.alpha : state.color, src[c], source_factor, dst[c],
                                 destination_factor));
    }
    after.linear[c] = value;
    put(info.component[c], encode(info.component[c], value), after.code);
  }
  return after;
}

std::array<double, 4> load_color(traces::Format format, const PixelCode& code) {
  const FormatInfo& info = format_info(format);
  std::array<double, 4> color{0, 0, 0, 1};
  for (std::size_t c = 0; c < info.channels; ++c) color[c] = decode(info.component[c], code);
  return color;
}

std::uint32_t to_bytes(traces::Format format, const PixelCode& code) {
  const FormatInfo& info = format_info(format);
  std::uint32_t bytes = info.channels < 4 ? 0xff000000u : 0;
  for (std::size_t c = 0; c < info.channels; ++c) {
    const ComponentBits& component = info.component[c];
    double value = bits_of(component, code) / most_of(component);
    if (is_float(component)) {
      value = clamp_unit(decode(component, code));
      if (c < 3) value = linear_to_srgb(value);
    }
    bytes |= static_cast<std::uint32_t>(std::nearbyint(value * 255.0)) << (8 * c);
  }
  return bytes;
}

StoredColor store_color(traces::Format format, const std::array<double, 4>& linear) {
  const FormatInfo& info = format_info(format);
  StoredColor stored;
  stored.linear[3] = 1;
  for (std::size_t c = 0; c < info.channels; ++c) {
    stored.linear[c] = held(info, linear[c]);
    put(info.component[c], encode(info.component[c], linear[c]), stored.code);
  }
  return stored;
}

}  // namespace quadrille::models::reference
