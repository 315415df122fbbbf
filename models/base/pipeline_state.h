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
enum class Topology : std::uint8_t {
  kTriangleList,
  kTriangleStrip,
  kTriangleFan,
  kPointList,
  kLineList,
  kLineStrip
};
/// Is each primitive on its own, so that no special index may end it?
[[nodiscard]] constexpr bool is_list(Topology topology) {
  return topology != Topology::kTriangleStrip && topology != Topology::kTriangleFan &&
         topology != Topology::kLineStrip;
}

/// How triangles are drawn. [VK1.3 #primsrast-polygonmode]
enum class PolygonMode : std::uint8_t { kFill, kLine, kPoint };
/// How lines become pixels. [VK1.3 #primsrast-lines, VK_EXT_line_rasterization]
enum class LineMode : std::uint8_t {
  kBresenham,    ///< the diamond-exit rule; a wide line repeats its pixels across
  kRectangular,  ///< the pixels whose centre is within the rectangle around the line
  kSmooth        ///< the same, and alpha is multiplied by how much of each pixel is covered
};
/// Widths that a line can have, and sizes of points, pixels.
inline constexpr float kMinLineWidth = 1, kMaxLineWidth = 64;
inline constexpr float kMinPointSize = 1, kMaxPointSize = 256;

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
