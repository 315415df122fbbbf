/// Per-sample operations at the end of the pipeline.
#include "models/reference/output.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/reference/sampling.h"

namespace quadrille::models::reference {
namespace {

using traces::BlendFactor;
using traces::BlendOp;

double clamp_unit(double a) { return a > 0 ? std::min(a, 1.0) : 0.0; }  // NaN: 0

bool is_encoded(traces::Format format, std::size_t channel) {
  return format == traces::Format::kR8G8B8A8Srgb && channel < 3;
}

std::uint32_t encode(traces::Format format, std::size_t channel, double linear) {
  const double clamped = clamp_unit(linear);
  return static_cast<std::uint32_t>(
      std::nearbyint((is_encoded(format, channel) ? linear_to_srgb(clamped) : clamped) * 255.0));
}

double decode(traces::Format format, std::size_t channel, std::uint32_t rgba) {
  const double value = ((rgba >> (8 * channel)) & 0xffu) / 255.0;
  return is_encoded(format, channel) ? srgb_to_linear(value) : value;
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
  for (std::size_t c = 0; c < 4; ++c) src[c] = clamp_unit(source[c]), dst[c] = decode(format, c, before.rgba);
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
    after.rgba = (after.rgba & ~(0xffu << (8 * c))) | encode(format, c, value) << (8 * c);
  }
  return after;
}

StoredColor store_color(traces::Format format, const std::array<double, 4>& linear) {
  StoredColor stored;
  for (std::size_t c = 0; c < 4; ++c) {
    stored.linear[c] = clamp_unit(linear[c]);
    stored.rgba |= encode(format, c, linear[c]) << (8 * c);
  }
  return stored;
}

}  // namespace quadrille::models::reference
