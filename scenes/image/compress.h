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
  kBc1,  ///< 8 bytes for 4x4 texels; alpha is 0 or 1
  kBc3   ///< 16 bytes for 4x4 texels; alpha as BC4
};
inline constexpr std::array<std::string_view, 2> kCompressionNames{"bc1", "bc3"};

/// Rows of blocks of `width` x `height` texels of RGBA8, by libsquish's cluster fit.
[[nodiscard]] std::vector<std::byte> compress_texels(std::span<const std::byte> rgba, std::uint32_t width,
                                                     std::uint32_t height, TextureCompression compression);

/// Compresses all planes of RGBA8, in all their levels; those that are packed are compressed when they are
/// unpacked. Others stay as they are. Returns how many it were.
std::size_t compress_textures(traces::CommandStream& stream, TextureCompression compression);

}  // namespace quadrille::scenes
