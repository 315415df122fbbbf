/// Mip chains, filtered in linear light.
///
/// Each level is filtered from the one before, kept in float, so that rounding to 8 bits happens once a level
/// and never accumulates. A texel of level i+1 covers exactly w(i)/w(i+1) texels of level i: two where the
/// width is even, and for odd widths three with polyphase weights, so that a constant stays constant and the
/// mean is kept. [VK1.3 #textures-image-level-size: sizes round down]
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/image/image_io.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

/// Levels of a full chain: down to 1x1.
[[nodiscard]] std::uint32_t full_chain_levels(std::uint32_t width, std::uint32_t height);
/// What texels of eight bits stand for.
struct TexelCoding {
  bool srgb = false;  ///< r, g and b are decoded before and encoded after filtering; alpha is linear always
  /// The chain's r, g and b are multiplied by alpha, in linear light: what is transparent has no colour that
  /// a filter could bring in. The image's own are not.
  bool premultiplied = false;
};
/// All levels of `image`, finest first, tightly packed RGBA8.
[[nodiscard]] std::vector<std::byte> build_mip_chain(const Rgba8Image& image, TexelCoding coding);
/// The same, level by level; only one is held at a time.
void visit_mip_chain(const Rgba8Image& image, TexelCoding coding, const traces::LevelSink& sink);

/// [VK1.3 #data-format-srgb] transfer functions, on 0..1.
[[nodiscard]] double srgb_to_linear(double encoded);
[[nodiscard]] double linear_to_srgb(double linear);

}  // namespace quadrille::scenes
