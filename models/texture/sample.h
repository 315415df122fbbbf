/// The texture unit's two halves, for one warp instruction: addresses (`plan_texture`) and filtering
/// (`filter_texture`).
///
/// Level of detail: lambda = log2 max(|d(u W, v H)/dx|, |d(u W, v H)/dy|), differences within the quad (lane
/// 1 - lane 0, lane 2 - lane
/// 0), so one base a quad; plus bias, clamped, rounded to `lod_bits`. Magnified where lambda <= 0. [VK1.3
/// #textures-scale-factor, #textures-level-of-detail-operation] Linear filtering takes texel coordinates to
/// the nearest 2^-subtexel_bits; the integer part selects texels, the fraction weighs them. Nearest takes the
/// floor of the unrounded coordinate. sRGB texels are decoded before they are filtered. [VK1.3
/// #textures-texel-filtering] A texel beyond the border is a colour that takes no read. A coordinate, bias or
/// level that is not finite counts as 0, for derivatives too; no texel outside the texture is ever read.
#pragma once

#include "models/base/sampler.h"
#include "models/memory/device_memory.h"
#include "models/precision.h"
#include "models/shader/warp.h"
#include "models/texture/ellipse_taps.h"
#include "models/texture/layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

/// A cache line that a request touches.
struct TextureLine {
  std::uint32_t line = 0;     ///< device address / 128
  std::uint32_t sectors = 0;  ///< bits 0..3
};

/// A line of decoded texels, as a cache holds them, and the sectors of the compressed line that they come of.
struct DecodedLine {
  std::uint32_t line = 0;  ///< the same for the same texels; below 2^31
  TextureLine from;
  std::uint32_t blocks = 0;  ///< that it is decoded from
};

/// Addresses and weights of one request; its memory is used again and again, nothing is allocated.
struct TexturePlan {
  static constexpr int kGroups = 4;  ///< lanes in groups of 8
  /// footprints of a group: two levels of 16 samples or of two slices, or those of an ellipse
  static constexpr int kMaxTaps = kMaxEllipseFootprints;
  static constexpr int kMaxTexels = kWarpLanes * kMaxTaps * 4;
  static constexpr int kMaxLines = kMaxTexels * 4;  ///< where the components of a texel lie apart
  static constexpr int kMaxBlocks = kMaxTexels;
  /// of plans without an ellipse: 32 lanes x 2 levels x 16 samples x 4 texels
  static constexpr int kSampledBlocks = kWarpLanes * 2 * 16 * 4;
  /// of plans of one plane without anisotropy: 32 lanes x 2 levels x 4 texels
  static constexpr int kPlainBlocks = kWarpLanes * 2 * 4;

  /// A group's texels in one mip level.
  struct Footprint {
    /// index from the texture's base: (0,0) (1,0) (0,1) (1,1). Of a block format: the place of the block
    /// in `blocks`, times a block's places (`BlockPlaces`), and the texel in it; 0 for what is not read.
    alignas(32) std::array<std::array<std::int32_t, 8>, 4> texel;
    /// weights of the right and lower texels, 0..255 of 256
    alignas(32) std::array<std::int32_t, 8> frac_x, frac_y;
    /// corners beyond the border, bit 8 * corner + lane: the texel is not read
    std::uint32_t border = 0;
    /// corners beyond a corner of a cube, which have no texel: the mean of the other three
    std::uint32_t missing = 0;
  };
  /// [group][finer, coarser level]; of `operation` plans [group][level * taps + tap]
  std::array<std::array<Footprint, kMaxTaps>, kGroups> footprint;
  alignas(32) std::array<float, kWarpLanes> level_weight;  ///< of the coarser level
  /// levels a group reads: 0 (no lane active), 1 or 2
  std::array<std::uint8_t, kGroups> levels{};
  std::array<std::int32_t, kWarpLanes> finer_level;  ///< level a lane reads (the finer of two)
  LaneMask active = 0;
  std::uint64_t base = 0;
  Format format = Format::kR8G8B8A8Unorm;
  BorderColor border = BorderColor::kTransparentBlack;
  std::array<std::uint32_t, 4> border_bits{};
  ComponentMapping components = kSameComponents;
  /// In Williams' layout, log2 of the bytes of a row: texels are indices of their first component. Else 0.
  int plane_row_shift = 0;

  // Of what operation_plan.cpp plans: several footprints a level, and what becomes of their texels.
  bool general = false;
  TextureAsk ask = TextureAsk::kSample;
  ViewKind kind = ViewKind::k2D;
  std::uint8_t component = 0;  ///< that a gather takes
  bool compares = false;
  CompareOp compare = CompareOp::kNever;
  /// footprints of a level: samples along an axis, slices, or those of an ellipse
  std::array<std::uint8_t, kGroups> taps{};
  bool slices = false;   ///< taps are two slices of a volume
  bool weighed = false;  ///< taps are an ellipse's, and each corner of a footprint has its own weight
  std::array<EllipseTaps::Weights, kGroups> weight;   ///< of what is weighed; 0: the texel counts for nothing
  alignas(32) std::array<float, kWarpLanes> samples;  ///< taps that count for the lane
  alignas(32) std::array<LaneFloats, 2> slice_weight;     ///< of the second slice, by level
  alignas(32) LaneFloats reference;                       ///< to compare with
  alignas(32) std::array<LaneFloats, 2> level_of_detail;  ///< what kQueryLod answers

  int line_count = 0;
  std::array<TextureLine, kMaxLines> lines;  ///< distinct, in order of first touch
  /// Of a block format: the distinct blocks that active lanes read, from the texture's base, in order of
  /// first touch.
  int block_count = 0;
  std::array<std::uint32_t, kMaxBlocks> blocks;
  /// Of each: bit i for line i of its decoded texels, of `decoded_line_shift` places, that is read.
  std::array<std::uint8_t, kMaxBlocks> block_lines;
  // Work, for the unit's timing and counters.
  /// quad x level filter operations: two for each of 8 bytes a texel as it is filtered, four for 16
  std::uint32_t bilinear_quads = 0;
  /// texels read by active lanes: 4 (linear) or 1 (nearest) a level, less those beyond the border
  std::uint32_t texels = 0;
  std::uint32_t magnified_lanes = 0, minified_lanes = 0;
};

/// Computes addresses and weights of any request.
void plan_texture(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                  const Precision& precision, TexturePlan& plan);

/// The same for requests that are more than a plane sampled without anisotropy (operation_plan.cpp).
void plan_operation(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                    const Precision& precision, TexturePlan& plan);

/// log2 of the places of a block format's texels that a line of 128 bytes of them decoded has.
[[nodiscard]] int decoded_line_shift(Format format);

/// The distinct lines of 128 bytes of decoded texels that a plan of a block format reads, in order of first
/// touch, to the end of `lines`. Lines are numbered for textures in the first 16 GiB of memory, or 2 GiB
/// where a block decodes to more than eight times its bytes; beyond, it throws `UserError`.
void add_decoded_lines(const TexturePlan& plan, std::vector<DecodedLine>& lines);

/// Reads and filters the texels of a plan. Lanes that are not active receive unspecified finite values.
void filter_texture(const TexturePlan& plan, const DeviceMemory& memory, std::array<LaneFloats, 4>& rgba);

}  // namespace quadrille::models
