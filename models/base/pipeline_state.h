/// What a graphics pipeline fixes before anything is drawn: its stages, how vertices form triangles, which
/// triangles are culled, how depths are compared and colours blended.
///
/// A command stream holds these values and the models compute by them, so each stands here once. Values are
/// those of trace files and never change; a new one goes to the end of its enumeration.
#pragma once

#include <array>
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

/// Of a pipeline. [VK1.3 limit maxViewports]
inline constexpr std::uint32_t kMaxViewports = 16;

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

/// What becomes of a stored stencil value. [VK1.3 #fragops-stencil]
enum class StencilOp : std::uint8_t {
  kKeep,
  kZero,
  kReplace,
  kIncrementClamp,
  kDecrementClamp,
  kInvert,
  kIncrementWrap,
  kDecrementWrap
};

/// The stencil test of fragments of front-facing or of back-facing triangles. Passes where (reference &
/// compare_mask) `compare` (stored & compare_mask).
struct StencilFace {
  CompareOp compare = CompareOp::kAlways;
  StencilOp fail = StencilOp::kKeep;        ///< the stencil test fails
  StencilOp pass = StencilOp::kKeep;        ///< both tests pass
  StencilOp depth_fail = StencilOp::kKeep;  ///< the stencil test passes and the depth test fails
  std::uint8_t compare_mask = 0xff, write_mask = 0xff, reference = 0;
  [[nodiscard]] constexpr bool keeps_when_hidden() const {
    return write_mask == 0 || (fail == StencilOp::kKeep && depth_fail == StencilOp::kKeep);
  }
  [[nodiscard]] constexpr bool writes() const {
    return write_mask != 0 && (!keeps_when_hidden() || pass != StencilOp::kKeep);
  }
  friend bool operator==(const StencilFace&, const StencilFace&) = default;
};
struct StencilState {
  bool test = false;
  StencilFace front{}, back{};
  friend bool operator==(const StencilState&, const StencilState&) = default;
};

/// Passes where the stored depth is within [least, most]. [VK1.3 #fragops-dbt]
struct DepthBoundsTest {
  bool test = false;
  float least = 0, most = 1;
  friend bool operator==(const DepthBoundsTest&, const DepthBoundsTest&) = default;
};

/// Moves the depths of a triangle by constant * r + slope * (its greatest depth slope), limited to `clamp`
/// where that is not 0; r is what depths of the attachment's format are apart. [VK1.3 #primsrast-depthbias]
struct DepthBias {
  bool enable = false;
  float constant = 0, slope = 0, clamp = 0;
  friend bool operator==(const DepthBias&, const DepthBias&) = default;
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
  kOneMinusDstAlpha,
  kConstantColor,
  kOneMinusConstantColor,
  kConstantAlpha,
  kOneMinusConstantAlpha,
  kSrcAlphaSaturate,
  kSrc1Color,  ///< of the second output at location 0, which only attachment 0 can be blended by
  kOneMinusSrc1Color,
  kSrc1Alpha,
  kOneMinusSrc1Alpha
};
inline constexpr BlendFactor kLastBlendFactor = BlendFactor::kOneMinusSrc1Alpha;
[[nodiscard]] constexpr bool is_second_source(BlendFactor factor) {
  return factor >= BlendFactor::kSrc1Color;
}
enum class BlendOp : std::uint8_t { kAdd, kSubtract, kReverseSubtract, kMin, kMax };

/// Of one colour attachment.
struct BlendState {
  bool enable = false;
  BlendFactor src_color = BlendFactor::kOne, dst_color = BlendFactor::kZero, src_alpha = BlendFactor::kOne,
              dst_alpha = BlendFactor::kZero;
  BlendOp color = BlendOp::kAdd, alpha = BlendOp::kAdd;
  std::uint8_t write_mask = 0xf;  ///< bit 0 red .. bit 3 alpha
  [[nodiscard]] constexpr bool uses_second_source() const {
    return enable && (is_second_source(src_color) || is_second_source(dst_color) ||
                      is_second_source(src_alpha) || is_second_source(dst_alpha));
  }
  friend bool operator==(const BlendState&, const BlendState&) = default;
};

/// What lies behind is seen through: the source, straight or multiplied by its alpha, over the destination.
[[nodiscard]] constexpr bool is_over(const BlendState& state) {
  return state.enable &&
         (state.src_color == BlendFactor::kSrcAlpha || state.src_color == BlendFactor::kOne) &&
         state.dst_color == BlendFactor::kOneMinusSrcAlpha && state.src_alpha == BlendFactor::kOne &&
         state.dst_alpha == BlendFactor::kOneMinusSrcAlpha && state.color == BlendOp::kAdd &&
         state.alpha == BlendOp::kAdd && state.write_mask == 0xf;
}

/// How a pass keeps the fragments of its order-independent draws, which are put over its colours by their
/// depths when it ends (models/rop/transparency.h).
enum class Transparency : std::uint8_t {
  kNone,
  kAbuffer,  ///< all of them, a list a pixel
  kKbuffer   ///< the nearest ones of each sample
};
/// Fragments that a pixel (or a sample, of a k-buffer) may hold.
[[nodiscard]] constexpr int most_layers(Transparency mode) {
  return mode == Transparency::kAbuffer ? 64 : mode == Transparency::kKbuffer ? 8 : 0;
}
struct TransparencyState {
  Transparency mode = Transparency::kNone;
  std::uint8_t layers = 0;  ///< 1..most_layers(mode)
  friend bool operator==(const TransparencyState&, const TransparencyState&) = default;
};

/// Bits of the colour (s) and of what is stored (d). [VK1.3 #framebuffer-logicop]
enum class LogicOp : std::uint8_t {
  kClear,
  kAnd,
  kAndReverse,  ///< s & ~d
  kCopy,
  kAndInverted,  ///< ~s & d
  kNoOp,
  kXor,
  kOr,
  kNor,
  kEquivalent,
  kInvert,
  kOrReverse,  ///< s | ~d
  kCopyInverted,
  kOrInverted,  ///< ~s | d
  kNand,
  kSet
};

/// What the blending of all attachments shares. A logic operation takes the place of blending; attachments of
/// floats and sRGB have none.
struct BlendShared {
  std::array<float, 4> constants{};
  bool logic = false;
  LogicOp logic_op = LogicOp::kCopy;
  friend bool operator==(const BlendShared&, const BlendShared&) = default;
};

}  // namespace quadrille::models
