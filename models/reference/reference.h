/// The double-precision reference renderer: what a command stream must look like, by the rules of Vulkan and
/// nothing of the machine.
///
/// It executes a `traces::CommandStream` one sample at a time with doubles in place of floats: its own SPIR-V
/// interpreter, clipping, coverage, interpolation, texture filtering and blending. It shares no code with
/// models/raster, models/texture, models/rop, models/shader or the shader compiler, so that a mistake has to
/// be made twice to stay unseen. (It reads the command stream's declarations, models/base and nothing else: a
/// documented exception to the tree's table.)
///
/// Mode *given*: positions and precisions are the machine's (its clipped, snapped window triangles; 8-bit
/// level-of-detail fractions and texel weights), all else is exact. What then differs is the machine's
/// rounding or its mistake. Mode *ideal*: nothing is snapped or quantised before the final store.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::models::reference {

enum class Mode : std::uint8_t { kGiven, kIdeal };

/// What an anisotropic filter takes: samples along a pixel's longer difference or along the longer axis of
/// its ellipse, or the texels within the ellipse by their weights.
enum class Anisotropy : std::uint8_t { kLongerDifference, kEllipseAxis, kEllipse };

/// Fractional bits, used in mode *given* only. Values are rounded to nearest, ties up (floor(x * 2^bits +
/// 0.5)).
struct Precision {
  int subpixel_bits = 8;  ///< of `GivenTriangle::x`, `y`
  int subtexel_bits = 8;  ///< of a texel coordinate, so of the bilinear weights
  int lod_bits = 8;       ///< of the level of detail, so of the weight between two mip levels
  Anisotropy anisotropy = Anisotropy::kLongerDifference;
};

/// A triangle, line or point in window space as the machine rasterised it (after clipping and snapping;
/// culled triangles may be left in, they are culled again here). A line has two corners, a point one; the
/// others are not looked at. The list holds them in draw order: all triangles of draw 0 first, each draw's in
/// the order in which they are to be drawn.
struct GivenTriangle {
  std::uint32_t draw = 0;       ///< number of the Draw command in the stream, from 0
  std::uint32_t instance = 0;   ///< from 0, without `first_instance`
  std::uint32_t primitive = 0;  ///< within its instance, from 0
  std::array<std::int64_t, 3> x{},
      /// framebuffer coordinates, fixed point with `subpixel_bits`; pixel (i, j) has its centre at (i + 0.5,
      /// j + 0.5)
      y{};
  std::array<double, 3> z{};      ///< depth after the viewport transform
  std::array<double, 3> inv_w{};  ///< 1 / clip w
  /// (b1, b2) of each corner within the original triangle, in clip space: corner = (1 - b1 - b2) v0 + b1 v1 +
  /// b2 v2. An unclipped triangle has (0,0) (1,0) (0,1), a line (0,0) (1,0). v0, v1, v2 are in Vulkan's
  /// order: strip i, i + 1 + i % 2, i + 2 - i % 2; fan i + 1, i + 2, 0. [VK1.3 #drawing-primitive-topologies]
  std::array<std::array<double, 2>, 3> barycentric{};
  double point_size = 1;  ///< pixels
  bool front = true;      ///< of the triangle whose edge or corner it is
};

struct PixelRect {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

struct Options {
  Mode mode = Mode::kIdeal;
  Precision precision;
  std::vector<GivenTriangle> given;  ///< mode *given* only
  /// render only these pixels, for speed; all others keep the clear values
  std::optional<PixelRect> region;
  int threads = 2;  ///< host threads; the result does not depend on them
};

inline constexpr std::uint64_t kNoTriangle = ~std::uint64_t{0};

/// The target of the stream's last render pass. All arrays are row-major, row 0 at the top.
struct Result {
  std::uint32_t width = 0, height = 0;
  /// 8 bits a component: red in bits 0..7, alpha in bits 24..31 (sRGB-encoded where the format is); as stored
  /// in formats of 8 bits, rounded from others
  std::vector<std::uint32_t> color;
  /// 4 a pixel: linear, after blending and before quantisation, of the last write; the clear colour where
  /// none
  std::vector<double> color_linear;
  std::vector<double> depth;  ///< mode *given*: a float32's value; of several samples, the first one's
  /// draw << 32 | primitive (within its instance) of the last surviving colour write, or `kNoTriangle`
  std::vector<std::uint64_t> triangle_id;
  /// smallest |z_new - z_old| at any depth test of the pixel, in units of the last place of a float32: tells
  /// ties
  std::vector<float> depth_margin;
  /// smallest |a - b| of any comparison that decided on a discard at the pixel (infinity: none)
  std::vector<float> alpha_margin;
};

/// Renders the stream. Throws `UserError` for a shader outside the supported subset (naming the shader and
/// the instruction), for a loop that does not end, and for given triangles that name a draw or primitive the
/// stream does not have.
[[nodiscard]] Result render(const traces::CommandStream& stream, const Options& options);

}  // namespace quadrille::models::reference
