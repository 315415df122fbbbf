/// What a graphics pipeline fixes before anything is drawn: its stages, how vertices form triangles, which
/// triangles are culled, how depths are compared and colours blended.
///
/// A command stream holds these values and the models compute by them, so each stands here once. Values are
/// those of trace files and never change; a new one goes to the end of its enumeration.
#pragma once

#include <cstdint>

namespace quadrille::models {

enum class ShaderStage : std::uint8_t { kVertex, kFragment };

/// [VK1.3 #drawing-primitive-topologies]
enum class Topology : std::uint8_t { kTriangleList, kTriangleStrip, kTriangleFan };

/// [VK1.3 #primsrast-polygons-basic]
enum class CullMode : std::uint8_t { kNone, kFront, kBack };
/// By the signed area in framebuffer coordinates, y down.
enum class FrontFace : std::uint8_t { kCounterClockwise, kClockwise };

/// [VK1.3 #fragops-depth]
enum class CompareOp : std::uint8_t {
  kNever,
  kLess,
  kEqual,
  kLessOrEqual,
  kGreater,
  kNotEqual,
  kGreaterOrEqual,
  kAlways
};

/// [VK1.3 #framebuffer-blending]
enum class BlendFactor : std::uint8_t {
  kZero,
  kOne,
  kSrcColor,
  kOneMinusSrcColor,
  kDstColor,
  kOneMinusDstColor,
  kSrcAlpha,
  kOneMinusSrcAlpha,
  kDstAlpha,
  kOneMinusDstAlpha
};
enum class BlendOp : std::uint8_t { kAdd, kSubtract, kReverseSubtract, kMin, kMax };

/// Of one colour attachment.
struct BlendState {
  bool enable = false;
  BlendFactor src_color = BlendFactor::kOne, dst_color = BlendFactor::kZero, src_alpha = BlendFactor::kOne,
              dst_alpha = BlendFactor::kZero;
  BlendOp color = BlendOp::kAdd, alpha = BlendOp::kAdd;
  std::uint8_t write_mask = 0xf;  ///< bit 0 red .. bit 3 alpha
  friend bool operator==(const BlendState&, const BlendState&) = default;
};

}  // namespace quadrille::models
