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

bool is_integer(const ComponentBits& component) {
  return number_kind(component.numeric) != NumberKind::kFloat;
}

/// Of an integer: its low bits.
std::uint32_t encode(const ComponentBits& component, double linear) {
  if (is_integer(component))
    return static_cast<std::uint32_t>(std::llround(linear)) & static_cast<std::uint32_t>(most_of(component));
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
  if (component.numeric == Numeric::kUint) return bits;
  const double as_signed = bits > most_of(component) / 2 ? bits - most_of(component) - 1 : bits;
  if (component.numeric == Numeric::kSint) return as_signed;
  if (component.numeric == Numeric::kSnorm)
    return std::max(as_signed / (std::ldexp(1.0, component.bits - 1) - 1.0), -1.0);
  if (component.numeric == Numeric::kSharedExponent)
    return std::ldexp(bits, static_cast<int>(code.word[0] >> 27) - 24);
  return component.numeric == Numeric::kSrgb ? srgb_code_to_linear(bits) : bits / most_of(component);
}

/// What blend factors are made of.
struct Sources {
  std::array<double, 4> source{}, destination{}, second{}, constant{};
};

double factor(BlendFactor which, std::size_t channel, const Sources& of) {
  switch (which) {
    case BlendFactor::kZero: return 0.0;
    case BlendFactor::kOne: return 1.0;
    case BlendFactor::kSrcColor: return of.source[channel];
    case BlendFactor::kOneMinusSrcColor: return 1.0 - of.source[channel];
    case BlendFactor::kDstColor: return of.destination[channel];
    case BlendFactor::kOneMinusDstColor: return 1.0 - of.destination[channel];
    case BlendFactor::kSrcAlpha: return of.source[3];
    case BlendFactor::kOneMinusSrcAlpha: return 1.0 - of.source[3];
    case BlendFactor::kDstAlpha: return of.destination[3];
    case BlendFactor::kOneMinusDstAlpha: return 1.0 - of.destination[3];
    case BlendFactor::kConstantColor: return of.constant[channel];
    case BlendFactor::kOneMinusConstantColor: return 1.0 - of.constant[channel];
    case BlendFactor::kConstantAlpha: return of.constant[3];
    case BlendFactor::kOneMinusConstantAlpha: return 1.0 - of.constant[3];
    case BlendFactor::kSrcAlphaSaturate:
      return channel == 3 ? 1.0 : std::min(of.source[3], 1.0 - of.destination[3]);
    case BlendFactor::kSrc1Color: return of.second[channel];
    case BlendFactor::kOneMinusSrc1Color: return 1.0 - of.second[channel];
    case BlendFactor::kSrc1Alpha: return of.second[3];
    case BlendFactor::kOneMinusSrc1Alpha: return 1.0 - of.second[3];
  }
  return 0.0;
}

/// Of one bit: those of a truth table of four, by 2 s + d.
std::uint32_t logic(traces::LogicOp op, std::uint32_t s, std::uint32_t d) {
  constexpr std::array<std::uint8_t, 16> kTruth{0b0000, 0b1000, 0b0100, 0b1100, 0b0010, 0b1010,
                                                0b0110, 0b1110, 0b0001, 0b1001, 0b0101, 0b1101,
                                                0b0011, 0b1011, 0b0111, 0b1111};
  const unsigned truth = kTruth[static_cast<std::size_t>(op)];
  std::uint32_t result = 0;
  for (unsigned pair = 0; pair < 4; ++pair) {
    if ((truth >> pair & 1u) == 0) continue;
    result |= ((pair & 2u) != 0 ? s : ~s) & ((pair & 1u) != 0 ? d : ~d);
  }
  return result;
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

double held_depth(traces::Format format, double depth) {
  const FormatInfo& info = format_info(format);
  if (info.numeric == Numeric::kFloat) return depth;
  const double most = most_of(info.component[0]);
  return std::nearbyint(clamp_unit(depth) * most) / most;
}

PixelCode store_depth(traces::Format format, double depth) {
  const FormatInfo& info = format_info(format);
  PixelCode code;
  put(info.component[0], encode(info.component[0], depth), code);
  return code;
}

double load_depth(traces::Format format, const PixelCode& code) {
  return decode(format_info(format).component[0], code);
}
std::uint8_t load_stencil(traces::Format format, const PixelCode& code) {
  const ComponentBits& stencil = format_info(format).stencil;
  return stencil.bits == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(bits_of(stencil, code));
}

bool stencil_passes(const traces::StencilFace& face, std::uint8_t stored) {
  return depth_passes(face.compare, face.reference & face.compare_mask, stored & face.compare_mask);
}

std::uint8_t stencil_after(const traces::StencilFace& face, traces::StencilOp op, std::uint8_t stored) {
  int value = stored;
  switch (op) {
    case traces::StencilOp::kKeep: return stored;
    case traces::StencilOp::kZero: value = 0; break;
    case traces::StencilOp::kReplace: value = face.reference; break;
    case traces::StencilOp::kIncrementClamp: value = std::min(value + 1, 255); break;
    case traces::StencilOp::kDecrementClamp: value = std::max(value - 1, 0); break;
    case traces::StencilOp::kInvert: value = 255 - value; break;
    case traces::StencilOp::kIncrementWrap: value = (value + 1) % 256; break;
    case traces::StencilOp::kDecrementWrap: value = (value + 255) % 256; break;
  }
  return static_cast<std::uint8_t>((stored & ~face.write_mask) | (value & face.write_mask));
}

StoredColor blend(const traces::BlendState& state, const traces::BlendShared& shared, traces::Format format,
                  const std::array<double, 4>& source, const std::array<double, 4>& second,
                  const StoredColor& before) {
  const FormatInfo& info = format_info(format);
  Sources of;
  of.destination = load_color(format, before.code);
  for (std::size_t c = 0; c < 4; ++c) {
    of.source[c] = held(info, source[c]);
    of.second[c] = held(info, second[c]);
    of.constant[c] = held(info, static_cast<double>(shared.constants[c]));
  }
  const bool integers = number_kind(info.numeric) != NumberKind::kFloat;
  const bool operates = shared.logic && (integers || info.numeric == Numeric::kUnorm);
  StoredColor after = before;
  for (std::size_t c = 0; c < info.channels; ++c) {
    if ((state.write_mask >> c & 1u) == 0) continue;
    double value = of.source[c];
    if (state.enable && !shared.logic) {
      const bool alpha = c == 3;
      const double source_factor = factor(alpha ? state.src_alpha : state.src_color, c, of);
      const double destination_factor = factor(alpha ? state.dst_alpha : state.dst_color, c, of);
      value = held(info, combine(alpha ? state.alpha : state.color, of.source[c], source_factor,
                                 of.destination[c], destination_factor));
    }
    std::uint32_t bits = encode(info.component[c], value);
    if (operates) {
      bits = logic(shared.logic_op, bits, bits_of(info.component[c], before.code)) &
             static_cast<std::uint32_t>(most_of(info.component[c]));
      value = bits / most_of(info.component[c]);
    }
    put(info.component[c], bits, after.code);
    after.linear[c] = integers ? decode(info.component[c], after.code) : value;
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
    if (is_integer(component)) {
      bytes |= (bits_of(component, code) & 0xffu) << (8 * c);
      continue;
    }
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
