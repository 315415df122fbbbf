/// Sampler state, as a command stream holds it and the texture unit samples by it. [VK1.3 #samplers]
/// Values are those of trace files and never change.
#pragma once

#include "models/base/pipeline_state.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

enum class Filter : std::uint8_t { kNearest, kLinear };
enum class Wrap : std::uint8_t {
  kRepeat,
  kMirroredRepeat,
  kClampToEdge,
  kClampToBorder,     ///< beyond the image lies the border's colour
  kMirrorClampToEdge  ///< mirrored once, then as kClampToEdge
};
inline constexpr Wrap kLastWrap = Wrap::kMirrorClampToEdge;

/// What lies beyond an image. Of components that its format lacks it is what they always are; ones are
/// integers where the format holds integers. [VK1.3 #textures-texel-replacement]
enum class BorderColor : std::uint8_t {
  kTransparentBlack,
  kOpaqueBlack,
  kOpaqueWhite,
  kOwn  ///< `SamplerState::border_bits`, as near to it as the format comes
};
inline constexpr BorderColor kLastBorder = BorderColor::kOwn;

struct SamplerState {
  Filter mag = Filter::kLinear, min = Filter::kLinear, mip = Filter::kLinear;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  float lod_bias = 0, min_lod = 0, max_lod = 1000;
  BorderColor border = BorderColor::kTransparentBlack;
  Wrap wrap_w = Wrap::kRepeat;  ///< of volumes
  /// Operations that compare: reference `compare` texel, each texel before it is filtered.
  CompareOp compare = CompareOp::kNever;
  /// Samples along the longer axis of a pixel's footprint, at most; 1: the footprint counts as round.
  float max_anisotropy = 1;
  bool seamless = true;  ///< beyond an edge of a cube's face lies the next face; else the face's own edge
  /// Red, green, blue and alpha of a border of its own: bits of floats (linear), or integers.
  std::array<std::uint32_t, 4> border_bits{};
  friend bool operator==(const SamplerState&, const SamplerState&) = default;
};

/// Does it ask for what lies beyond the image?
[[nodiscard]] constexpr bool has_border(const SamplerState& sampler) {
  return sampler.wrap_u == Wrap::kClampToBorder || sampler.wrap_v == Wrap::kClampToBorder;
}
inline constexpr float kMaxAnisotropy = 16.0f;
/// Does it take several samples along an axis? With a nearest filter it does not.
[[nodiscard]] constexpr bool is_anisotropic(const SamplerState& sampler) {
  return sampler.max_anisotropy > 1 && sampler.mag == Filter::kLinear && sampler.min == Filter::kLinear;
}

/// Sampler and shader bias together are limited to this. [VK1.3 limit maxSamplerLodBias]
inline constexpr float kMaxLodBias = 16.0f;

}  // namespace quadrille::models
