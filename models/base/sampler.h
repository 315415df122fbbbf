/// Sampler state, as a command stream holds it and the texture unit samples by it. [VK1.3 #samplers]
/// Values are those of trace files and never change.
#pragma once

#include <cstdint>

namespace quadrille::models {

enum class Filter : std::uint8_t { kNearest, kLinear };
enum class Wrap : std::uint8_t { kRepeat, kMirroredRepeat, kClampToEdge };

struct SamplerState {
  Filter mag = Filter::kLinear, min = Filter::kLinear, mip = Filter::kLinear;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  float lod_bias = 0, min_lod = 0, max_lod = 1000;
  friend bool operator==(const SamplerState&, const SamplerState&) = default;
};

/// Sampler and shader bias together are limited to this. [VK1.3 limit maxSamplerLodBias]
inline constexpr float kMaxLodBias = 16.0f;

}  // namespace quadrille::models
