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

std::uint32_t bits_of(const ComponentBits& component, std::uint32_t code) {
  return static_cast<std::uint32_t>(std::uint64_t{code} >> component.shift &
                                    ((std::uint64_t{1} << component.bits) - 1));
}

std::uint32_t encode(const ComponentBits& component, double linear) {
  const double clamped = clamp_unit(linear);
  const double encoded = component.numeric == Numeric::kSrgb ? linear_to_srgb(clamped) : clamped;
  return static_cast<std::uint32_t>(std::nearbyint(encoded * most_of(component))) << component.shift;
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

double decode(const ComponentBits& component, std::uint32_t code) {
  const std::uint32_t bits = bits_of(component, code);
  if (component.numeric == Numeric::kFloat) return static_cast<double>(std::bit_cast<float>(bits));
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
  std::array<double, 4> src{}, dst{};
  const FormatInfo& info = format_info(format);
  for (std::size_t c = 0; c < 4; ++c)
    src[c] = clamp_unit(source[c]), dst[c] = decode(info.component[c], before.code);
  StoredColor after = before;
  for (std::size_t c = 0; c < 4; ++c) {
    if ((state.write_mask >> c & 1u) == 0) continue;
    double value = src[c];
    if (state.enable) {
      const bool alpha = c == 3;
      const double source_factor = factor(alpha ? state.src_alpha : state.src_color, c, src, dst);
      const double destination_factor = factor(alpha ? state.dst_alpha : state.dst_color, c, src, dst);
      value = clamp_unit(
          combine(alpha ? state.alpha : state.color, src[c], source_factor, dst[c], destination_factor));
    }
    after.linear[c] = value;
    const ComponentBits& component = info.component[c];
    const std::uint32_t mask = ((1u << component.bits) - 1) << component.shift;
    after.code = (after.code & ~mask) | encode(component, value);
  }
  return after;
}

std::array<double, 4> load_color(traces::Format format, std::uint32_t code) {
  const FormatInfo& info = format_info(format);
  std::array<double, 4> color{0, 0, 0, 1};
  for (std::size_t c = 0; c < info.channels; ++c) color[c] = decode(info.component[c], code);
  return color;
}

std::uint32_t to_bytes(traces::Format format, std::uint32_t code) {
  std::uint32_t bytes = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const ComponentBits& component = format_info(format).component[c];
    const double value = bits_of(component, code) / most_of(component);
    bytes |= static_cast<std::uint32_t>(std::nearbyint(value * 255.0)) << (8 * c);
  }
  return bytes;
}

StoredColor store_color(traces::Format format, const std::array<double, 4>& linear) {
  StoredColor stored;
  for (std::size_t c = 0; c < 4; ++c) {
    stored.linear[c] = clamp_unit(linear[c]);
    stored.code |= encode(format_info(format).component[c], linear[c]);
  }
  return stored;
}

}  // namespace quadrille::models::reference
