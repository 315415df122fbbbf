/// Compresses the textures of a stream as a game's tools would, so that what it saves of bandwidth can be
/// weighed against what it costs in the picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::scenes {

enum class TextureCompression : std::uint8_t {
  kBc1,      ///< 8 bytes for 4x4 texels; alpha is 0 or 1
  kBc3,      ///< 16 bytes for 4x4 texels; alpha as BC4
  kAstc4x4,  ///< 16 bytes for so many texels
  kAstc5x4,
  kAstc5x5,
  kAstc6x5,
  kAstc6x6,
  kAstc8x5,
  kAstc8x6,
  kAstc8x8,
  kAstc10x5,
  kAstc10x6,
  kAstc10x8,
  kAstc10x10,
  kAstc12x10,
  kAstc12x12
};
/// By the value of `TextureCompression`; `astc` has blocks of 4x4.
inline constexpr std::array<std::string_view, 16> kCompressionNames{
    "bc1",     "bc3",     "astc",     "astc5x4",  "astc5x5",  "astc6x5",   "astc6x6",   "astc8x5",
    "astc8x6", "astc8x8", "astc10x5", "astc10x6", "astc10x8", "astc10x10", "astc12x10", "astc12x12"};

/// Rows of blocks of `width` x `height` texels of RGBA8: BC by libsquish's cluster fit, ASTC by libastcenc at
/// its medium effort.
[[nodiscard]] std::vector<std::byte> compress_texels(std::span<const std::byte> rgba, std::uint32_t width,
                                                     std::uint32_t height, TextureCompression compression);

/// Compresses all planes of RGBA8, in all their levels; those that are packed are compressed when they are
/// unpacked. Others stay as they are. Returns how many it were.
std::size_t compress_textures(traces::CommandStream& stream, TextureCompression compression);

}  // namespace quadrille::scenes
